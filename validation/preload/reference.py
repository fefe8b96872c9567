"""Natural frequencies of bars under an axial force, apart from stridor. Needs numpy and scipy.  python3 reference.py

On two hinges f_n = n^2 f_1 sqrt(1 + P/(n^2 P_cr)), pulled by P > 0. Clamped at one end, where the force keeps its direction,
EI w'''' - P w'' = rho A w^2 w with w = w' = 0 and w'' = 0, EI w''' - P w' = 0 at the ends.
"""
import numpy as np
from scipy.optimize import brentq

E, NU, RHO, L, A = 200e9, 0.3, 7850.0, 0.5, 200e-6
WEAK, STRONG = 20e-3 * 10e-3**3 / 12, 10e-3 * 20e-3**3 / 12


def hinged(n, p, rigidity, mass, length):
    buckling = np.pi**2 * rigidity / length**2
    return n**2 * np.pi / 2 / length**2 * np.sqrt(rigidity / mass) * np.sqrt(1 + p / (n**2 * buckling))


def free_end(omega, p, inertia):
    """Both conditions at the free end on the two solutions that are clamped at the other."""
    h = p / (2 * E * inertia)
    root = np.sqrt(h * h + RHO * A * omega**2 / (E * inertia))
    a, b = np.sqrt(root + h), np.sqrt(root - h)
    ca, sa, cb, sb = np.cosh(a * L), np.sinh(a * L), np.cos(b * L), np.sin(b * L)
    second = [a * a * ca + b * b * cb, a * a * sa + a * b * sb]
    third = [a**3 * sa - b**3 * sb, a**3 * ca + a * b * b * cb]
    first = [a * sa + b * sb, a * ca - a * cb]
    shear = [t - 2 * h * f for t, f in zip(third, first)]
    return second[0] * shear[1] - second[1] * shear[0]


def cantilever(p, inertia, number=2):
    omega = np.linspace(1.0, 4000.0, 4000)
    values = [free_end(w, p, inertia) for w in omega]
    pairs = zip(omega, omega[1:], values, values[1:])
    found = [brentq(free_end, w0, w1, (p, inertia), xtol=1e-12, rtol=1e-14) for w0, w1, v0, v1 in pairs if v0 * v1 < 0]
    return [w / 2 / np.pi for w in found[:number]]


plane = np.pi**2 * E * WEAK / L**2
print(f"buckling: hinged {plane:.6f} N, clamped {plane / 4:.6f} N")
for p in (8000.0, -8000.0):
    weak = [hinged(n, p, E * WEAK, RHO * A, L) for n in (1, 2)]
    strong = [hinged(n, p, E * STRONG, RHO * A, L) for n in (1, 2)]
    print(f"hinged, {p} N:", *(f"{f:.7f}" for f in sorted(weak + strong)))
for p in (2500.0, -2500.0):
    print(f"clamped, {p} N:", *(f"{f:.7f}" for f in sorted(cantilever(p, WEAK) + cantilever(p, STRONG))))
rigidity = E * 2e-3**3 / 12 / (1 - NU**2)
print(f"strip: buckling {np.pi**2 * rigidity / 0.4**2 * 5e-3:.6f} N")
for p in (0.0, 30.0, -30.0):
    print(f"strip, {p} N:", *(f"{hinged(n, p / 5e-3, rigidity, RHO * 2e-3, 0.4):.7f}" for n in (1, 2, 3)))
print(f"hinged, -20000 N: growth rate {2 * np.pi * abs(hinged(1, -20000.0 + 0j, E * WEAK, RHO * A, L)):.9f} 1/s")
