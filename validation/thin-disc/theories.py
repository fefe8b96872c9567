"""Natural frequencies [Hz] of a free disc of steel, radius 100 mm, by Kirchhoff's theory, by Mindlin's (both in Bessel functions) and by
three-dimensional elasticity (Rayleigh-Ritz with polynomials, ../free-solids/exact.py); numpy, scipy."""
import sys

import numpy as np
from scipy.optimize import brentq
from scipy.special import iv, ivp, jv, jvp

sys.path.append("../free-solids")
from exact import E, G, NU, RHO, ritz

RADIUS, KAPPA = 0.1, 5 / (6 - NU)
RIGIDITY = E / 12 / (1 - NU**2)


def zeros(function, grid):
    values = [function(x) for x in grid]
    return [brentq(function, a, b, rtol=1e-13) for a, b, u, v in zip(grid, grid[1:], values, values[1:]) if u * v < 0]


def kirchhoff(h, n, count):
    """Without bending moment and effective shear at the edge, with x = k R."""
    def determinant(x):
        columns = []
        for f, fp, sign in ((jv, jvp, -1), (iv, ivp, 1)):
            w, d = f(n, x), x * fp(n, x)
            moment = sign * x * x * w - (1 - NU) * (d - n * n * w)
            shear = sign * x * x * d + (1 - NU) * n * n * (w - d)
            columns.append(np.array([moment, shear]) / abs(f(n, x) if sign > 0 else 1))
        return np.linalg.det(np.array(columns).T)

    found = zeros(determinant, np.linspace(0.5, 12, 3000))[:count]
    return [(x / RADIUS) ** 2 * h * np.sqrt(RIGIDITY / RHO) / 2 / np.pi for x in found]


def mindlin(h, n, count):
    """Without moments and shear force at the edge (R. D. Mindlin and H. Deresiewicz, J. Appl. Phys. 25 (1954) 1329), rotary inertia."""
    d, rotary, shear, r = RIGIDITY * h**3, RHO * h**3 / 12, KAPPA * G * h, RADIUS

    def determinant(omega):
        b = omega**2 * (rotary + RHO * h * d / shear)
        c = omega**2 * (RHO * h * rotary * omega**2 / shear - RHO * h)
        root = np.sqrt(b * b - 4 * d * c)
        columns = []
        for i, k2 in enumerate([(b + root) / 2 / d, (b - root) / 2 / d, (rotary * omega**2 - shear) * 2 / d / (1 - NU)]):
            k = np.sqrt(abs(k2))
            f, fp = (jv, jvp) if k2 > 0 else (iv, ivp)
            w, slope = f(n, k * r), k * fp(n, k * r)
            second = (n * n / r**2 - k2) * w - slope / r
            if i < 2:
                # beta = s grad w
                s = RHO * h * omega**2 / (shear * k2) - 1
                moment = s * (second + NU * (slope / r - n * n * w / r**2))
                twist = s * 2 * n * (w / r**2 - slope / r)
                force = (1 + s) * slope
            else:
                # beta_r = n f / r cos, beta_theta = -f' sin
                moment = (1 - NU) * n * (slope / r - w / r**2)
                twist = -n * n * w / r**2 - second + slope / r
                force = n * w / r
            columns.append(np.array([moment, twist, force]) / (abs(w) if k2 < 0 else 1))
        matrix = np.array(columns).T
        return np.linalg.det(matrix if n > 0 else matrix[np.ix_([0, 2], [0, 1])])

    top = 1.1 * kirchhoff(h, n, count)[-1]
    return [w / 2 / np.pi for w in zeros(determinant, 2 * np.pi * np.linspace(top / 2000, top, 2000))[:count]]


def elasticity(h, n, count, degree=40):
    """Of the modes of the disc those that bend: the lowest antisymmetric ones lie beside Mindlin's."""
    found = ritz(0, RADIUS, h, n, degree, along_z=7)
    return [min(found, key=lambda f: abs(f - m)) for m in mindlin(h, n, count)]


if __name__ == "__main__":
    for part in (0.2, 0.1, 0.05, 0.025):
        h = part * RADIUS
        print(f"h/R = {part}")
        for n, count in ((2, 1), (0, 1), (3, 1), (1, 1), (4, 1)):
            for k, m, e in zip(kirchhoff(h, n, count), mindlin(h, n, count), elasticity(h, n, count)):
                print(f"  n = {n}: Kirchhoff {k:.3f}, Mindlin {m:.3f}, elasticity {e:.3f}; above elasticity {k / e - 1:.2e} {m / e - 1:.2e}")
