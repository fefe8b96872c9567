"""What the peers share: the matrices, the clock, the result."""
import argparse
import json
import os
import resource
import time
from pathlib import Path

import numpy as np
import scipy.sparse as sp


def arguments(description):
    """MODEL is a folder with m.npz, k.npz and, for complex pairs, c.npz; the pairs go to FILE (.npz)."""
    parser = argparse.ArgumentParser(description=description)
    parser.add_argument("model", type=Path)
    parser.add_argument("--count", type=int, default=50)
    parser.add_argument("--nearest", type=float, default=2000.0, help="Hz")
    parser.add_argument("--solver", default="pardiso")
    parser.add_argument("--tolerance", type=float, default=1e-9)
    parser.add_argument("--out", type=Path, required=True)
    return parser


def matrices(model, names):
    return [sp.load_npz(model / f"{name}.npz").tocsr() for name in names]


class Clock:
    """CPU seconds of all threads and wall seconds, phase by phase."""

    def __init__(self):
        self.phases, self.start = [], self.now()
        self.last = self.start
        self.before = peak()

    @staticmethod
    def now():
        return time.process_time(), time.perf_counter()

    def lap(self, name):
        now = self.now()
        self.phases.append({"name": name, "cpu": now[0] - self.last[0], "wall": now[1] - self.last[1]})
        self.last = now

    def finish(self, args, program, matrix, values, vectors, **more):
        total = {"cpu": self.last[0] - self.start[0], "wall": self.last[1] - self.start[1]}
        memory = peak()
        np.savez(args.out, values=values, vectors=vectors)
        print(json.dumps({
            "program": program, "dofs": matrix.shape[0], "nonzeros": matrix.nnz, "total": total,
            "phases": self.phases, "peak_mib": memory, "before_mib": self.before,
            "threads": int(os.environ.get("OMP_NUM_THREADS", 0)), **more}))


def peak():
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024
