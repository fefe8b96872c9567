"""A linear implicit step with a prefactored matrix: `step.py MODEL --solver pardiso|cholmod [--block STEPS] [--blocks N]`.

Newmark's β = ¼, γ = ½ for M ü + C u̇ + K u = f: two products, one solution, the new motion. The same Δt and matrices as
stridor's step, without its contact.
"""
import argparse
import json
import os
import time
from pathlib import Path

import numpy as np

from common import matrices, peak

WARM, BETA, GAMMA = 10, 0.25, 0.5


def factorised(matrix, solver):
    """Its name and x ↦ A⁻¹x."""
    if solver == "pardiso":
        from pardiso import Pardiso
        return "PARDISO", Pardiso(matrix, "definite").solve
    from sksparse.cholmod import cholesky
    return "CHOLMOD", cholesky(matrix.tocsc(), mode="supernodal").solve_A


def clock():
    """CPU and wall seconds."""
    return np.array([time.process_time(), time.perf_counter()])


def main(args):
    m, c, k = matrices(args.model, "mck")
    before, began = peak(), clock()
    dt = args.step
    by_u = np.array([1 / BETA, dt / BETA, (0.5 / BETA - 1) * dt * dt]) / dt**2
    by_v = np.array([GAMMA / BETA / dt, GAMMA / BETA - 1, dt * (0.5 * GAMMA / BETA - 1)])
    name, solve = factorised((k + by_v[0] * c + by_u[0] * m).tocsr(), args.solver)
    prepared = clock() - began
    n = m.shape[0]
    force = np.zeros(n)
    force[::3] = 1e-3
    u, v, a = np.zeros((3, n))
    ends = []
    for step in range(WARM + args.block * args.blocks):
        rhs = force + m @ (by_u[0] * u + by_u[1] * v + by_u[2] * a) + c @ (by_v[0] * u + by_v[1] * v + by_v[2] * a)
        new = solve(rhs)
        acceleration = by_u[0] * (new - u) - by_u[1] * v - by_u[2] * a
        v = v + dt * ((1 - GAMMA) * a + GAMMA * acceleration)
        u, a = new, acceleration
        if step + 1 >= WARM and (step + 1 - WARM) % args.block == 0:
            ends.append(clock())
    least = np.diff(ends, axis=0).min(axis=0) / args.block * 1e3
    began = clock()
    for _ in range(args.block):
        solve(rhs)
    alone = (clock() - began) / args.block * 1e3
    both = lambda times: {"cpu": float(times[0]), "wall": float(times[1])}
    print(json.dumps({"program": name, "dofs": n, "nonzeros": k.nnz, "prepare_s": both(prepared), "step_ms": both(least),
                      "solve_ms": both(alone), "peak_mib": peak(), "before_mib": before,
                      "threads": int(os.environ.get("OMP_NUM_THREADS", 0)), "largest": float(abs(u).max())}))


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("model", type=Path)
    parser.add_argument("--solver", default="pardiso")
    parser.add_argument("--step", type=float, default=1e-5)
    parser.add_argument("--block", type=int, default=20)
    parser.add_argument("--blocks", type=int, default=5)
    main(parser.parse_args())
