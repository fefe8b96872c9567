"""Measures the pairs of several programs in one way, and compares their eigenvalues.

`check.py MODEL JOB NEAREST BELOW RUN...` prints for each run (an .npz with `values` and `vectors`)

* backward: ‖r‖ / ((|λ|²‖M‖ + |λ|‖C‖ + ‖K‖) ‖x‖) in the 1-norm of the matrices, r = (λ²M + λC + K) x,
* ahead: ‖P(σ)⁻¹ r‖ / ‖x‖ at the shift σ, about the error of the vector, which says more on fine meshes,
* pairs: how many are left when conjugates are counted once, below BELOW Hz where that is not 0,
* apart: the largest relative difference of an eigenvalue from that of the first run.
"""
import json
import sys
from pathlib import Path

import numpy as np
import scipy.sparse.linalg as sla

from common import matrices
from pardiso import Pardiso


def main(model, job, nearest, below, runs):
    real = job == "real"
    if real:
        m, k = matrices(model, "mk")
        factor = Pardiso(k, "definite")
        residual = lambda value, x: k @ x - value * (m @ x)
        size = lambda value: sla.norm(k, 1) + abs(value) * sla.norm(m, 1)
    else:
        m, c, k = matrices(model, "mck")
        shift = 2j * np.pi * nearest
        factor = Pardiso((shift * shift * m + shift * c + k).tocsr(), "general")
        norms = [sla.norm(a, 1) for a in (k, c, m)]
        residual = lambda value, x: value * (value * (m @ x) + c @ x) + k @ x
        size = lambda value: sum(norm * abs(value) ** power for power, norm in enumerate(norms))
    first = None
    for run in runs:
        stored = np.load(run)
        values, vectors = stored["values"], stored["vectors"]
        backward = ahead = 0.0
        for value, x in zip(values, vectors.T):
            x = x.real if real else x.astype(complex)
            r, length = residual(value, x), np.linalg.norm(x)
            backward = max(backward, np.linalg.norm(r) / (size(value) * length))
            ahead = max(ahead, np.linalg.norm(factor.solve(r)) / length)
        if not real:
            # Of a conjugate pair one is enough; which one a program gives is its own choice.
            values = np.where(values.imag < 0, values.conj(), values)
            order = np.argsort(values.imag)
            values = values[order[np.r_[True, abs(np.diff(values[order])) > 1e-7 * abs(values[order][1:])]]]
            if below:
                values = values[values.imag < 2 * np.pi * below]
        first = values if first is None else first
        # The farthest pair may differ where two are equally near: all but it must agree.
        apart = sorted(min(abs(first - value)) / abs(value) for value in values)
        print(json.dumps({"run": Path(run).stem, "pairs": len(values), "given": vectors.shape[1], "backward": backward, "ahead": ahead,
                          "apart": apart[-1], "apart_but_one": apart[-2] if len(apart) > 1 else apart[-1],
                          "farthest_hz": float(np.sqrt(abs(values).max()) if real else abs(values).max()) / 2 / np.pi}))


if __name__ == "__main__":
    main(Path(sys.argv[1]), sys.argv[2], *map(float, sys.argv[3:5]), sys.argv[5:])
