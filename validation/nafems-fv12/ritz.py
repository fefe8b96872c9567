"""Frequencies of a thin square plate by Rayleigh-Ritz, apart from stridor: the reference of this folder and of nafems-fv16.

w(x, y) = sum of c_ij P_i(x) P_j(y) with Legendre polynomials on [-1, 1]^2; for the cantilever (1 + x)^2 times that. Free edges
are natural conditions of the energies
    U = D/2 int (w_xx + w_yy)^2 - 2 (1 - nu) (w_xx w_yy - w_xy^2),    T = rho h/2 int w_t^2,
so that the frequencies converge from above. Needs numpy and scipy.  python3 ritz.py
"""
import numpy as np
from numpy.polynomial import legendre, polynomial
from scipy.linalg import eigh

E, NU, RHO, H, A = 200e9, 0.3, 8000.0, 0.05, 10.0
DEGREE = 17


def functions(factor, points):
    """Values, first and second derivatives of factor(x) P_i(x), i = 0 ... DEGREE, scaled to norm 1."""
    tables = []
    for i in range(DEGREE + 1):
        p = polynomial.polymul(factor, legendre.leg2poly(np.eye(i + 1)[i]))
        norm = np.sqrt(2.0 / (2 * i + 1))
        tables.append([polynomial.polyval(points, polynomial.polyder(p, d)) / norm for d in range(3)])
    return np.array(tables).transpose(1, 0, 2)


def frequencies(along, count):
    x, weights = legendre.leggauss(2 * DEGREE + 8)
    f, g = functions(along, x), functions([1.0], x)
    product = lambda a, b: (a * weights) @ b.T
    m = {(d, e): product(f[d], f[e]) for d in range(3) for e in range(3)}
    n = {(d, e): product(g[d], g[e]) for d in range(3) for e in range(3)}
    stiffness = (
        np.kron(m[2, 2], n[0, 0]) + np.kron(m[0, 0], n[2, 2])
        + NU * (np.kron(m[2, 0], n[0, 2]) + np.kron(m[0, 2], n[2, 0]))
        + 2 * (1 - NU) * np.kron(m[1, 1], n[1, 1])
    )
    mass = np.kron(m[0, 0], n[0, 0])
    values = eigh(stiffness, mass, eigvals_only=True, subset_by_index=[0, count - 1])
    bending = E * H**3 / (12 * (1 - NU**2))
    half = A / 2
    return np.sqrt(np.maximum(values, 0) * bending / (RHO * H) / half**4) / (2 * np.pi)


print("free:      ", *(f"{f:.5f}" for f in frequencies([1.0], 12)[3:]))
print("cantilever:", *(f"{f:.5f}" for f in frequencies([1.0, 2.0, 1.0], 7)))
