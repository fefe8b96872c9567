"""The reference values of this folder, apart from stridor. Needs numpy.  python3 reference.py"""
import numpy as np

TAU = 2 * np.pi
m, k, c = 2.0, 1973.9208802178716, 6.283185307179586
zeta = c / 2 / np.sqrt(k * m)
print(f"largest receptance {1 / (2 * zeta * np.sqrt(1 - zeta**2) * k):.12e} m/N at {5 * np.sqrt(1 - 2 * zeta**2):.9f} Hz")
print(f"largest mobility {1 / c:.12e} m/(N s) at 5 Hz")
print(f"largest accelerance {1 / (2 * zeta * np.sqrt(1 - zeta**2) * m):.12e} m/(N s^2) at {5 / np.sqrt(1 - 2 * zeta**2):.9f} Hz")

E, RHO, L, A = 200e9 * (1 + 0.02j), 7850.0, 0.5, 200e-6
WEAK, STRONG = 20e-3 * 10e-3**3 / 12, 10e-3 * 20e-3**3 / 12


def series(x, y, hz, terms=200000):
    """Receptance of the bar on two hinges, by its modes."""
    n = np.arange(1, terms + 1)
    square = (n * np.pi / L) ** 4 * E * WEAK / (RHO * A)
    return 2 / (RHO * A * L) * np.sum(np.sin(n * np.pi * x / L) * np.sin(n * np.pi * y / L) / (square - (TAU * hz) ** 2))


print(f"hinged, 125 to 350 mm at 150 Hz: {abs(series(0.125, 0.35, 150)):.12e} m/N")
for n in (1, 2, 3):
    print(f"hinged, mode {n}: {n**2 * np.pi / 2 / L**2 * np.sqrt(E.real * WEAK / (RHO * A)):.9f} Hz")
line = np.linspace(90, 93, 30001)
print(f"hinged, largest receptance at the middle: {max(abs(series(0.25, 0.25, f, 500)) for f in line):.12e} m/N")


def tip(hz, inertia):
    """Dynamic stiffness of the clamped bar's tip, which may turn freely."""
    k = ((TAU * hz) ** 2 * RHO * A / (E * inertia)) ** 0.25
    x = k * L
    co, s, ch, sh = np.cos(x), np.sin(x), np.cosh(x), np.sinh(x)
    d = E * inertia / (1 - co * ch)
    ww, wt, tt = d * k**3 * (co * sh + s * ch), -d * k**2 * s * sh, d * k * (s * ch - co * sh)
    return ww - wt * wt / tt


hz, kn, load = 100.0, 50e3, 10.0
mu, slope = 0.3 + 0.25 * np.exp(-1), -0.5 * np.exp(-1)
along, into = tip(hz, WEAK), tip(hz, STRONG)
# N = load - kn z pulls the tip along the belt by mu(V - y') N.
matrix = np.array([[along + 1j * TAU * hz * slope * load, mu * kn], [0, into + kn]])
h = np.linalg.inv(matrix)
print(f"sliding at 100 Hz: along by along {abs(h[0, 0]):.12e}, along by into {abs(h[0, 1]):.12e}, "
      f"into by into {abs(h[1, 1]):.12e} m/N; open {1 / abs(into):.12e} m/N")
