"""The map of benches/run: a thousand complex eigenvalue analyses of the rig over friction and speed, at full order."""
import os
import re

from in_time import summary_of, took
from runs import best_of

JOBS = {"map": ("map", 100_000)}
# The reference rig, generated, so that it is as fine as is asked.
MESH = """[mesh.rig]
disc_size = "1.2 mm"
slider_size = "3.4 mm"
"""
MAP = """
[map.friction_and_speed]
parameters = ["contact.rim.friction.mu0", "contact.rim.sliding_velocity"]
from = [0.1, "0.05 m/s"]
to = [0.8, "2 m/s"]
points = [40, 25]
"""


def once(root, stridor, threads):
    text = (root / "validation/rig/case.toml").read_text()
    before = os.times()
    summary = summary_of(stridor, "sweep", re.sub(r"\[mesh\]\n(.+\n)+", MESH, text, count=1) + MAP, threads)
    after = os.times()
    if not summary:
        return None
    phases = {phase["phase"]: phase["wall_s"] for phase in summary["timings"]}
    found = summary["maps"][0]
    return {"dofs": summary["model"]["dofs"], "phases": phases, "seconds": phases["sweeps and maps"],
            "cpu": sum(after[2:4]) - sum(before[2:4]), "points": found["answered"], "dimension": found["method"]["dimension"],
            "error": max(sample["eigenvalue_error"] for sample in found["full_order_sample"]),
            "checked": len(found["full_order_sample"])}


def run_job(name, arguments, root, stridor):
    runs = best_of(name, ["stridor"], arguments, lambda _, threads: once(root, stridor, threads), took)
    return {"name": name, "kind": "map", "runs": runs, "missing": []}


def tables(jobs):
    """The maps as Markdown."""
    lines = []
    for job in (job for job in jobs if job["runs"].get("stridor")):
        lines += ["", "## A map over friction and speed at full order", ""]
        for t, run in job["runs"]["stridor"].items():
            single = run["phases"]["complex eigenvalues"] + run["phases"]["real modes of the whole"]
            lines.append(f"{run['points']:,} points, {run['dofs']:,} degrees of freedom, {t} thread{'s' * (t > 1)}: "
                         f"{run['seconds']:.1f} s ({run['cpu']:.1f} s of CPU time in all, the analysis before it included); a single "
                         f"analysis takes {single:.1f} s. Reduced to {run['dimension']} coordinates; the largest estimated error of an "
                         f"eigenvalue at {run['checked']} points measured on the full order: {run['error']:.0e}.\n")
    return "\n".join(lines)
