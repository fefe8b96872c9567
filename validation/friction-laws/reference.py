"""The reference values of this folder, apart from stridor. Needs numpy and scipy.  python3 reference.py"""
import numpy as np
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

N, M, K = 10.0, 2.0, 2000.0


def exponential(v):
    return 0.3 + 0.25 * np.exp(-2 * v)


def stribeck(v, exponent=2):
    return 0.4 + 0.2 * np.exp(-((v / 0.25) ** exponent))


def hyperbolic(v):
    return 0.7 / (1 + 3 * v)


def slopes(x, y):
    """Fritsch and Carlson (1980): mean of the secants, flat at extrema, shortened to the circle of radius 3."""
    d = np.diff(y) / np.diff(x)
    m = np.concatenate([[d[0]], (d[:-1] + d[1:]) / 2, [d[-1]]])
    for k in range(1, len(y) - 1):
        if d[k - 1] * d[k] <= 0:
            m[k] = 0
    for k in range(len(d)):
        a, b = m[k] / d[k], m[k + 1] / d[k]
        if np.hypot(a, b) > 3:
            m[k], m[k + 1] = 3 * a * d[k] / np.hypot(a, b), 3 * b * d[k] / np.hypot(a, b)
    return m


def hermite(x, y, v):
    m = slopes(x, y)
    k = np.searchsorted(x, v) - 1
    h = x[k + 1] - x[k]
    s = (v - x[k]) / h
    return (
        (1 + 2 * s) * (1 - s) ** 2 * y[k] + s * (1 - s) ** 2 * h * m[k]
        + s**2 * (3 - 2 * s) * y[k + 1] - s**2 * (1 - s) * h * m[k + 1]
    )


def table(v, p=N):
    x = np.array([0, 0.1, 0.5, 1])
    rows = np.array([[0.60, 0.55, 0.40, 0.36], [0.50, 0.48, 0.34, 0.30]])
    low, high = (hermite(x, y, v) for y in rows)
    return low + (p - 5) / 15 * (high - low)


def slope(law, v, h=1e-5):
    return (8 * (law(v + h) - law(v - h)) - law(v + 2 * h) + law(v - 2 * h)) / (12 * h)


for name, law in [("exponential", exponential), ("stribeck", stribeck),
                  ("stribeck, exponent 1", lambda v: stribeck(v, 1)), ("hyperbolic", hyperbolic), ("table", table)]:
    print(f"{name}: force {law(0.3) * N:.12f} N, growth rate {-slope(law, 0.3) * N / (2 * M):.9f} 1/s")
print(f"hyperbolic at 0.05 m/s: force {hyperbolic(0.05) * N:.12f} N, growth rate {-slope(hyperbolic, 0.05) * N / (2 * M):.9f} 1/s")
print(f"table at the pressure of 20 N: {20 * table(0.3, 20):.12f} N; at 0.5 m/s: {N * table(0.5):.12f} N")

delta = brentq(lambda d: 1e4 * d + 5e10 * d**3 - N, 0, 1, xtol=1e-18)
tangent = 1e4 + 3 * 5e10 * delta**2
print(f"cubic: penetration {delta:.15e} m, mode {np.sqrt(tangent / M) / (2 * np.pi):.12f} Hz")
print(f"load: approach {N / 3e3 + N / 1e3:.15e} m")


def across(t, state):
    z, v = state
    return [v, (3 * min(t / 0.2, 1) - z - 5 * v / np.hypot(v, 0.1)) / M]


tight = dict(method="Radau", rtol=1e-12, atol=1e-14)
first = solve_ivp(across, (0, 0.2), [0, 0], **tight)
second = solve_ivp(across, (0.2, 1), first.y[:, -1], dense_output=True, **tight)
z, v = second.y[:, -1]
fastest = second.sol(np.linspace(0.2, 1, 100001))[1].max()
print(f"oblique: at 1 s z {z:.9f} m, velocity {v:.9f} m/s, friction along the belt {5 * 0.1 / np.hypot(v, 0.1):.9f} N; "
      f"fastest {fastest:.9f} m/s")


def bristles(t, state):
    """Bristles bent by s carry k s + c s' = F, |F| = mu N, and slip, v - s', goes along F: F is along k s + c v."""
    z, v, s = state[0], state[1], state[2:]
    stretched = 1e5 * s + 200 * np.array([0.1, -v])
    friction = 5 * stretched / np.hypot(*stretched)
    force = 3 * min(t / 0.2, 1) - z + friction[1]
    return [v, force / M, *(friction - 1e5 * s) / 200]


first = solve_ivp(bristles, (0, 0.2), [0, 0, 5e-5, 0], **tight)
second = solve_ivp(bristles, (0.2, 1), first.y[:, -1], dense_output=True, **tight)
z, v = second.y[:2, -1]
print(f"with bristles: at 1 s z {z:.9f} m, velocity {v:.9f} m/s; "
      f"fastest {second.sol(np.linspace(0.2, 1, 100001))[1].max():.9f} m/s")
