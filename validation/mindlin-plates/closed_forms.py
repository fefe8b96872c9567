"""Reference values of thick plates (numpy, scipy): a supported square by three-dimensional elasticity, a clamped disc by Mindlin's theory."""
import numpy as np
from scipy.optimize import brentq
from scipy.special import iv, jv

E, NU, RHO = 210e9, 0.3, 7850.0
G, LONG = E / 2 / (1 + NU), np.sqrt(E * (1 - NU) / ((1 + NU) * (1 - 2 * NU) * RHO))
KAPPA = 5 / (6 - NU)


def lamb(h, k):
    """omega of the lowest antisymmetric Lamb wave."""
    shear = np.sqrt(G / RHO)

    def dispersion(omega):
        p, q = np.sqrt(k**2 - (omega / LONG) ** 2), np.sqrt(k**2 - (omega / shear) ** 2)
        return (q**2 + k**2) ** 2 * np.tanh(p * h / 2) - 4 * k**2 * p * q * np.tanh(q * h / 2)

    return brentq(dispersion, 0.05 * shear * k, 0.9999 * shear * k, xtol=1e-9, rtol=1e-14)


def determinant(h, a, n, omega):
    """Edge conditions w = beta_r = beta_t = 0 of Mindlin's circular plate (Mindlin & Deresiewicz 1954)."""
    rigidity, rotary = E * h**3 / 12 / (1 - NU**2), RHO * h**3 / 12
    b = omega**2 * (rotary + RHO * rigidity / (KAPPA * G))
    c = omega**2 * (RHO / (KAPPA * G) * rotary * omega**2 - RHO * h)
    root = np.sqrt(b * b - 4 * rigidity * c)
    squares = [(b + root) / 2 / rigidity, (b - root) / 2 / rigidity]
    squares.append((rotary * omega**2 - KAPPA * G * h) * 2 / rigidity / (1 - NU))
    columns = []
    for i, k2 in enumerate(squares):
        k = np.sqrt(abs(k2))
        f, after = (jv(n, k * a), -jv(n + 1, k * a)) if k2 > 0 else (iv(n, k * a), iv(n + 1, k * a))
        slope = n / a * f + k * after
        if i < 2:
            s = RHO * omega**2 / (KAPPA * G * k2) - 1
            column = np.array([f, s * slope, -s * n / a * f])
        else:
            column = np.array([0, n / a * f, -slope])
        columns.append(column / (abs(f) if k2 < 0 else 1))
    matrix = np.array(columns).T
    return np.linalg.det(matrix[:2, :2] if n == 0 else matrix)


print("supported square, edge 100 mm, h 10 mm and 20 mm: Hz")
for h in (0.01, 0.02):
    waves = sorted(np.pi / 0.1 * np.hypot(m, n) for m in range(1, 5) for n in range(1, 5))
    print([round(lamb(h, k) / 2 / np.pi, 2) for k in waves[:6]])
print("clamped disc, radius 75 mm, h 15 mm: Hz")
grid = np.linspace(1e3, 30e3, 600) * 2 * np.pi
for n in range(3):
    values = [determinant(0.015, 0.075, n, omega) for omega in grid]
    roots = [
        brentq(lambda x: determinant(0.015, 0.075, n, x), x, y) / 2 / np.pi
        for x, y, u, v in zip(grid, grid[1:], values, values[1:])
        if u * v < 0
    ]
    print(n, np.round(roots, 2))
