"""The whole command beside CalculiX: 50 lowest modes of the ring of 10-node tetrahedra, from the mesh to the frequencies."""
import json
import os
import re
import shutil
import subprocess
import tempfile
import time
from pathlib import Path

from runs import best_of

PEERS = Path(__file__).resolve().parent
# name: kind and degrees of freedom.
JOBS = {"whole-30000": ("whole", 30_000), "whole-100000": ("whole", 100_000)}
COUNT = 50
# Gmsh's places of the nodes of C3D10: the last two edges change places.
ORDER = [0, 1, 2, 3, 4, 5, 6, 7, 9, 8]
DECK = """*MATERIAL, NAME=STEEL
*ELASTIC
210e9, 0.3
*DENSITY
7850
*SOLID SECTION, ELSET=RING, MATERIAL=STEEL
*BOUNDARY
BORE, 1, 3
*STEP
*FREQUENCY
{count}
*END STEP
"""


def deck(mesh, path):
    """The mesh of models.py as an input file of CalculiX."""
    lines = mesh.read_text().splitlines()
    nodes, elements = (lines.index(f"${name}") for name in ("Nodes", "Elements"))
    cells = [[int(word) for word in line.split()] for line in lines[elements + 2: lines.index("$EndElements")]]
    bore = sorted({node for cell in cells if cell[1] == 9 for node in cell[5:]})
    with open(path, "w") as file:
        file.write("*NODE, NSET=ALL\n")
        # Numbers of more than 20 characters are refused there.
        for number, *place in (line.split() for line in lines[nodes + 2: lines.index("$EndNodes")]):
            file.write(", ".join([number, *(f"{float(x):.12e}" for x in place)]) + "\n")
        file.write("*ELEMENT, TYPE=C3D10, ELSET=RING\n")
        for cell in (cell for cell in cells if cell[1] == 11):
            file.write(", ".join(str(number) for number in [cell[0], *(cell[5 + k] for k in ORDER)]) + "\n")
        file.write("*NSET, NSET=BORE\n")
        file.writelines(f"{node},\n" for node in bore)
        file.write(DECK.format(count=COUNT))


def timed(command, folder, threads):
    limits = {name: str(threads) for name in ("OMP_NUM_THREADS", "CCX_NPROC_EQUATION_SOLVER", "CCX_NPROC_STIFFNESS")}
    before, started = os.times(), time.perf_counter()
    done = subprocess.run(command, cwd=folder, env={**os.environ, **limits}, capture_output=True, text=True)
    wall, after = time.perf_counter() - started, os.times()
    if done.returncode:
        print(f"  failed: {(done.stderr.strip() or done.stdout.strip()).splitlines()[-1:]}")
        return None
    return {"wall": wall, "cpu": sum(after[2:4]) - sum(before[2:4])}


def once(program, threads, stridor, mesh):
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        shutil.copy(mesh, folder / "ring.msh")
        if program == "stridor":
            (folder / "case.toml").write_text(f"{mesh.with_suffix('.toml').read_text()}[modes.lowest]\ncount = {COUNT}\n")
            total = timed([stridor, "run", "case.toml", "--out", "out", "--threads", str(threads), "--quiet"], folder, threads)
            if total is None:
                return None
            summary = json.loads((folder / "out/summary.json").read_text())
            found, dofs = [mode["frequency_hz"] for mode in summary["modes"]], summary["model"]["dofs"]
        else:
            deck(mesh, folder / "ring.inp")
            total = timed(["ccx", "-i", "ring"], folder, threads)
            if total is None:
                return None
            text = (folder / "ring.dat").read_text()
            rows = re.findall(r"^ +\d+ +(\S+) +(\S+) +(\S+) +(\S+) *$", text[text.index("E I G E N"):], re.M)
            found, dofs = [float(row[2]) for row in rows[:COUNT]], None
        return {"total": total, "frequencies": found, "dofs": dofs}


# Where the packages of models.py are.
MAKE = """import sys
sys.path.insert(0, sys.argv[1])
import models
models.ring_mesh(sys.argv[2] + ".msh", float(sys.argv[3]))
open(sys.argv[2] + ".toml", "w").write(models.SOLID)
"""


def run_job(name, arguments, stridor):
    mesh = arguments.work / "models" / f"{name}.msh"
    mesh.parent.mkdir(parents=True, exist_ok=True)
    if not mesh.exists():
        python = arguments.work / "venv/bin/python"
        subprocess.run([python, "-c", MAKE, PEERS, mesh.with_suffix(""), str(JOBS[name][1])], check=True)
    programs = ["stridor", *(["ccx"] if shutil.which("ccx") else [])]
    runs = best_of(name, programs, arguments, lambda program, threads: once(program, threads, stridor, mesh),
                   lambda run, threads: run["total"]["cpu" if threads == 1 else "wall"])
    return {"name": name, "kind": "whole", "runs": runs, "missing": [] if "ccx" in programs else ["ccx"]}


def apart(runs):
    """The largest relative difference of the frequencies of both."""
    own, other = (next(iter(runs[program].values()))["frequencies"] for program in ("stridor", "ccx"))
    return max(abs(a / b - 1) for a, b in zip(own, other, strict=True))


def tables(jobs):
    """Both commands as Markdown."""
    lines = []
    for job in (job for job in jobs if all(job["runs"].get(program) for program in ("stridor", "ccx"))):
        own, other = job["runs"]["stridor"], job["runs"]["ccx"]
        dofs = next(iter(own.values()))["dofs"]
        lines += ["", f"## The whole command beside CalculiX: {COUNT} lowest real modes of solids, {dofs:,} degrees of freedom", ""]
        for t, run in own.items():
            measure, word = ("cpu", "CPU") if t == 1 else ("wall", "wall")
            a, b = run["total"][measure], other[t]["total"][measure]
            lines.append(f"{t} thread{'s' * (t > 1)}: {a:.1f} s of {word} time beside {b:.1f} s, {b / a:.1f} ×.\n")
        lines.append(f"From the mesh to the frequencies, results and report included; frequencies apart by {apart(job['runs']):.0e}.")
    return "\n".join(lines)
