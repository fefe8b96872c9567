"""Friction of a block that follows the belt and the load, and the sticking of a block on a belt from rest, apart from stridor. Needs
numpy and scipy.  python3 courses.py
"""
import numpy as np
from scipy.integrate import quad, solve_ivp

mu = lambda v: 0.3 + 0.25 * np.exp(-2 * abs(v))
ramp = lambda t, start, duration: start + (1 - start) * min(t / duration, 1)
for t in (0.2, 0.5, 0.7):
    print(f"ramps, {t} s: N {20 * ramp(t, 0.5, 0.6):.9f}, friction {mu(0.5 * ramp(t, 0.2, 0.8)) * 20 * ramp(t, 0.5, 0.6):.9f} N")
for t in (0.2, 0.45, 0.8):
    v, n = 0.5 * np.interp(t, [0, 0.4, 1], [1, 0.25, 2]), 20 * np.interp(t, [0, 0.5, 1], [1, 0.25, 1.5])
    print(f"tables, {t} s: N {n:.9f}, friction {mu(v) * n:.9f} N")
for t in (1 / 8, 3 / 8, 0.04):
    v = 0.5 * np.cos(4 * np.pi * t + np.pi / 2)
    print(f"to and fro, {t:.3f} s: friction {np.sign(v) * mu(v) * 20:.9f} N")

power = {
    "ramps": lambda t: mu(0.5 * ramp(t, 0.2, 0.8)) * 20 * ramp(t, 0.5, 0.6) * 0.5 * ramp(t, 0.2, 0.8),
    "tables": lambda t: mu(v := 0.5 * np.interp(t, [0, 0.4, 1], [1, 0.25, 2])) * v * 20 * np.interp(t, [0, 0.5, 1], [1, 0.25, 1.5]),
    "to and fro": lambda t: mu(v := 0.5 * abs(np.sin(4 * np.pi * t))) * 20 * v,
}
for name, at in power.items():
    heat = quad(at, 0, 1, points=[0.25, 0.4, 0.5, 0.6, 0.75, 0.8], epsabs=1e-12)[0]
    print(f"{name}: heat in 1 s {heat:.9f} J")

# m = k = N = 1, friction 1/(1 + 3|w|) towards the belt of 0.2 m/s, w the velocity against it. Sticking, x grows with the belt to 1.
V, tight = 0.2, dict(method="DOP853", rtol=1e-12, atol=1e-13)
t, x, v, sticks, slips = 0.0, 0.0, 0.0, [], []
while t < 60:
    caught = lambda t, y: y[1] - V
    caught.terminal, caught.direction = True, 1
    # It begins to slip with w = 0: a push of nothing starts it off.
    run = solve_ivp(lambda t, y: [y[1], 1 / (1 + 3 * abs(V - y[1])) - y[0]], (t, t + 60), [x, v], events=caught, **tight)
    t, (x, v) = run.t_events[0][0], run.y_events[0][0]
    sticks.append(t)
    t, x, v = t + (1 - x) / V, 1.0, V - 1e-9
    slips.append(t)
print("sticks:", *(f"{s:.6f}" for s in sticks if s < 60))
print("slips:", *(f"{s:.6f}" for s in slips if s < 60))
print(f"place at 60 s: {1 - V * (next(s for s in slips if s > 60) - 60):.9f} m")
