"""Modes of the annular plate of this folder, clamped inside and free outside, by Kirchhoff theory, apart from stridor. Needs numpy and
scipy.  python3 bessel.py

W = A J_n(kr) + B Y_n(kr) + C I_n(kr) + D K_n(kr); W = W' = 0 at b, no moment and no shear force at a.
"""
import numpy as np
from scipy.optimize import brentq
from scipy.special import iv, ivp, jv, jvp, kv, kvp, yv, yvp

E, NU, RHO, H, A, B = 210e9, 0.3, 7850.0, 1e-3, 75e-3, 22.5e-3
WAVES = np.sqrt(E * H**2 / 12 / (1 - NU**2) / RHO)
KINDS = [(jv, jvp, -1), (yv, yvp, -1), (iv, ivp, 1), (kv, kvp, 1)]


def conditions(n, k, z, zp, sign):
    """On one solution, with r in units of a: its curvature is sign k^2 W - W'/r + n^2 W/r^2."""
    w = lambda r: z(n, k * r)
    slope = lambda r: k * zp(n, k * r)
    curvature = sign * k * k * w(1) - slope(1) + n * n * w(1)
    moment = curvature + NU * (slope(1) - n * n * w(1))
    shear = sign * k * k * slope(1) - (1 - NU) * n * n * (slope(1) - w(1))
    return [w(B / A), slope(B / A), moment, shear]


def determinant(k, n):
    m = np.array([conditions(n, k, *kind) for kind in KINDS]).T
    return np.linalg.det(m / np.abs(m).max(axis=0))


def modes(below):
    found = []
    for n in range(25):
        grid = np.arange(0.3, A * np.sqrt(2 * np.pi * below / WAVES) + 0.02, 0.02)
        values = [determinant(k, n) for k in grid]
        roots = [brentq(determinant, p, q, (n,), xtol=1e-13) for p, q, u, v in zip(grid, grid[1:], values, values[1:]) if u * v < 0]
        found += [((k / A) ** 2 * WAVES / 2 / np.pi, n, circle) for circle, k in enumerate(roots)]
    return sorted(f for f in found if f[0] < below)


number = 0
for hz, n, circles in modes(4000.0):
    twins = 2 if n else 1
    number += twins
    print(f"{hz:12.6f} Hz: {n} diameters, {circles} circles, modes up to {number}")
