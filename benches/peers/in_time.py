"""The jobs in time of benches/run: a nonlinear step of stridor beside the linear step of its peers, and one second of squeal."""
import json
import os
import subprocess
import sys
import tempfile
from pathlib import Path

from runs import answers, best_of

PEERS = Path(__file__).resolve().parent
# name: kind and degrees of freedom.
JOBS = {f"step-{dofs}": ("step", dofs) for dofs in (5_000, 20_000, 50_000, 200_000, 500_000)}
JOBS["reduced"] = ("reduced", 0)
PROGRAMS = {"step": ["stridor", "pardiso", "cholmod"], "reduced": ["stridor"]}
# The rig of validation/rig in time, where its friction must be smooth: the squeal grows until the slip turns round.
SMOOTH = ('alpha = "1 s/m" }', 'alpha = "1 s/m", regularisation = "1 mm/s" }')
REDUCED = """
[transient]
duration = "1 s"
time_step = "10 us"
scheme = "hht"
model = "reduced"
# The first steps of the full model beside it are not what is timed.
compare_steps = 0
[transient.disturbance]
mode_near = "1668 Hz"
amplitude = "1 nm"
[transient.probe.rim]
at = [0, 0, "-70 mm"]
direction = [1, 0, 0]
"""


def environment(threads):
    limits = {name: str(threads) for name in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS")}
    return {**os.environ, **limits, "MKL_DYNAMIC": "FALSE"}


def step(program, threads, work, bench, folder, dofs):
    """One run over some blocks of steps; the least mean of a block counts."""
    blocks = ["--block", str(max(10, min(2000, 4_000_000 // dofs))), "--blocks", "5"]
    command = [bench, folder / "case.toml", "--threads", str(threads)]
    if program != "stridor":
        command = [work / "venv/bin/python", PEERS / "step.py", folder, "--solver", program]
    found = answers([*command, *blocks], environment(threads))
    return found and found[-1]


def reduced(root, stridor, threads):
    """Wall seconds of the phases of the rig's case with [transient] added, and of the run in time of a hundred steps, which is
    nearly all reduction."""
    whole, short = (run_rig(root, stridor, threads, duration) for duration in ("1 s", "1 ms"))
    if not whole or not short:
        return None
    phases = {phase["phase"]: phase["wall_s"] for phase in whole["timings"]}
    prepared = next(phase["wall_s"] for phase in short["timings"] if phase["phase"] == "transient")
    found = whole["transient"]
    return {"program": "stridor", "dofs": whole["model"]["dofs"], "phases": phases, "seconds": phases["transient"],
            "prepared": prepared, "shapes": sum(found["reduced"].values()), "points": whole["model"]["contact_points"],
            "steps": found["steps"], "energy_residual": found["worst_energy_residual"]}


def run_rig(root, stridor, threads, duration):
    """The summary of a run."""
    text = (root / "validation/rig/case.toml").read_text().replace("../../meshes", str(root / "meshes")).replace(*SMOOTH)
    return summary_of(stridor, "transient", text + REDUCED.replace("1 s", duration), threads)


def summary_of(stridor, command, text, threads):
    """The summary of a subcommand on a case, or None with the reason on stderr."""
    with tempfile.TemporaryDirectory() as folder:
        case, out = Path(folder) / "case.toml", Path(folder) / "out"
        case.write_text(text)
        line = [stridor, command, case, "--out", out, "--quiet", "--threads", str(threads)]
        done = subprocess.run(line, capture_output=True, text=True, env=environment(threads))
        if done.returncode:
            print(f"  failed: {done.stderr.strip()}", file=sys.stderr)
            return None
        return json.loads((out / "summary.json").read_text())


def took(result, threads):
    """CPU milliseconds of a step at one thread, which another load on the machine hardly moves, else those of the clock; the
    seconds of the rig."""
    return result["step_ms"]["cpu" if threads == 1 else "wall"] if "step_ms" in result else result["seconds"]


def run_job(name, arguments, root, stridor, bench, model):
    """The best of the repeats; ours and the peers' runs take turns."""
    kind, dofs = JOBS[name]
    folder = model(arguments.work, stridor, kind, dofs) if kind == "step" else None

    def once(program, threads):
        return (step(program, threads, arguments.work, bench, folder, dofs) if kind == "step"
                else reduced(root, stridor, threads))

    runs = best_of(name, PROGRAMS[kind], arguments, once, took)
    return {"name": name, "kind": kind, "runs": {program: by for program, by in runs.items() if by},
            "missing": [program for program, by in runs.items() if not by]}


def tables(jobs, threads):
    """All jobs in time as Markdown."""
    steps = [job for job in jobs if job["kind"] == "step" and "stridor" in job["runs"]]
    lines = []
    if steps:
        wall = [f"{'CPU ms, 1 thread' if t == 1 else f'wall ms, {t} threads'} | stridor ÷ it" for t in threads]
        lines += ["## One implicit step, Δt = 10 µs", "",
                  "stridor: nonlinear, with sliding contact at ten points that open and close, and its balance of energy. The others: "
                  "a linear Newmark step with the same matrices, factorised once.", "",
                  "| degrees of freedom | program | " + " | ".join(wall) + " | prepared, CPU s | Newton | energy residual | peak MiB (before) |",
                  "|" + "---|" * (2 * len(threads) + 6)]
        for job in steps:
            for program, by in job["runs"].items():
                first = next(iter(by.values()))
                cells = []
                for t in threads:
                    own = job["runs"]["stridor"].get(t)
                    cells += [f"{took(by[t], t):.2f}" if t in by else "–",
                              f"{took(own, t) / took(by[t], t):.2f}" if t in by and own else "–"]
                more = [f"{first['newton']:.1f}", f"{first['energy_residual']:.0e}"] if program == "stridor" else ["–", "–"]
                lines.append(f"| {first['dofs']:,} | {first['program']} | " + " | ".join(cells) +
                             f" | {first['prepare_s']['cpu']:.2f} | " + " | ".join(more) +
                             f" | {first['peak_mib']:.0f} ({first['before_mib']:.0f}) |")
        sizes = [(job["runs"]["stridor"][1]["dofs"], took(job["runs"]["stridor"][1], 1)) for job in steps
                 if 1 in job["runs"]["stridor"]]
        if len(sizes) > 1:
            lines += ["", growth(sizes)]
    for job in (job for job in jobs if job["kind"] == "reduced" and "stridor" in job["runs"]):
        lines += ["", "## One second of squeal of the reduced rig, Δt = 10 µs", ""]
        for t, run in job["runs"]["stridor"].items():
            rest = sum(run["phases"].values()) - run["seconds"]
            lines.append(f"{run['steps']:,} steps of {run['shapes']} shapes and {run['points']} contact points (from {run['dofs']:,} degrees "
                         f"of freedom): {run['seconds']:.2f} s at {t} thread{'s' * (t > 1)}, checkpoints, record and spectra included, of which "
                         f"{run['prepared']:.2f} s are for the reduction; "
                         f"{rest:.1f} s before it for modes and complex eigenvalues. Energy residual {run['energy_residual']:.0e}.\n")
    return "\n".join(lines)


def growth(sizes):
    from math import log
    sizes.sort()
    (n, t), (m, u) = sizes[0], sizes[-1]
    power = log(u / t) / log(m / n)
    steps = ", ".join(f"{dofs:,}: {took:.2f} ms" for dofs, took in sizes)
    return f"stridor's step at one thread: {steps}. From {n:,} to {m:,} it grows like dof^{power:.2f}."


def summary(jobs, threads):
    """One row a size: stridor's step beside that of the fastest peer."""
    steps = [job for job in jobs if job["kind"] == "step" and len(job["runs"]) > 1]
    if not steps:
        return ""
    lines = ["| nonlinear step with ten contact points beside a peer's linear one | " + " | ".join(
        f"stridor, {'CPU ms, 1 thread' if t == 1 else f'wall ms, {t} threads'} | fastest peer | ratio" for t in threads) + " |",
        "|" + "---|" * (3 * len(threads) + 1)]
    for job in steps:
        cells = []
        for t in threads:
            times = {program: took(by[t], t) for program, by in job["runs"].items() if t in by}
            own = times.pop("stridor", None)
            best = min(times, key=times.get) if times else None
            cells += ([f"{own:.1f}", f"{times[best]:.1f} ({job['runs'][best][t]['program']})", f"{times[best] / own:.2f} ×"]
                      if own and best else ["–", "–", "–"])
        lines.append(f"| {next(iter(job['runs']['stridor'].values()))['dofs']:,} dof | " + " | ".join(cells) + " |")
    return "\n".join(lines)
