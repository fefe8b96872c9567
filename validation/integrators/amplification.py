"""What the integrators make of an oscillator of 1 Hz in steps of 0.1 s, apart from stridor: the eigenvalues of the amplification
matrix of (u, dt v, dt^2 a). Needs numpy.  python3 amplification.py

M a_{n+1-am} + K u_{n+1-af} = 0 with X_{n+1-a} = (1 - a) X_{n+1} + a X_n and Newmark's formulas for u and v.
"""
import numpy as np

TAU = 2 * np.pi


def hht(alpha):
    return 0.0, -alpha, (1 - alpha) ** 2 / 4, 0.5 - alpha


def generalised_alpha(rho):
    am, af = (2 * rho - 1) / (rho + 1), rho / (rho + 1)
    return am, af, (1 + af - am) ** 2 / 4, 0.5 + af - am


def amplification(scheme, big):
    am, af, beta, gamma = scheme
    left = np.array([[(1 - af) * big**2, 0, 1 - am], [1, 0, -beta], [0, 1, -gamma]])
    right = np.array([[-af * big**2, 0, -am], [1, 1, 0.5 - beta], [0, 1, 1 - gamma]])
    return np.linalg.solve(left, right)


def principal(scheme, dt):
    values = np.linalg.eigvals(amplification(scheme, TAU * dt))
    z = max((v for v in values if v.imag > 0), key=abs)
    return np.log(z) / dt


for name, scheme in [
    ("newmark", hht(0.0)), ("hht -0.05", hht(-0.05)), ("hht -0.3", hht(-0.3)),
    ("generalised alpha 0.9", generalised_alpha(0.9)), ("generalised alpha 0.5", generalised_alpha(0.5)),
]:
    lam = principal(scheme, 0.1)
    print(f"{name}: {lam.imag / TAU:.12f} Hz, growth rate {lam.real:.12f} 1/s")


def pushed(scheme, steps=200, dt=0.1):
    """u [m] at the end and the energies [J] of 1 kg from rest under sin(pi (t - 0.05)/0.4) N: gained, by the push, by the scheme."""
    am, af, beta, gamma = scheme
    k, u, v, a, spent = TAU**2, 0.0, 0.0, 0.0, 0.0
    force = lambda t: np.sin(np.pi * (t - 0.05) / 0.4) if 0.05 < t < 0.45 else 0.0
    for n in range(steps):
        f0, f1 = force(n * dt), force((n + 1) * dt)
        predicted = u + dt * v + dt**2 * (0.5 - beta) * a
        load = (1 - af) * f1 + af * f0 - k * ((1 - af) * predicted + af * u) - am * a
        a1 = load / (1 - am + (1 - af) * k * beta * dt**2)
        u1 = predicted + dt**2 * beta * a1
        v += dt * ((1 - gamma) * a + gamma * a1)
        spent += (u1 - u) * (f0 + f1) / 2
        u, a = u1, a1
    gained = v**2 / 2 + k * u**2 / 2
    return u, gained, spent, gained - spent


for name, scheme in [("hht -0.05", hht(-0.05)), ("hht -0.3", hht(-0.3)), ("generalised alpha 0.5", generalised_alpha(0.5)),
                     ("generalised alpha 0", generalised_alpha(0.0))]:
    print(f"{name}, pushed: u {{:.12e}} m; energy gained {{:.12e}}, by the push {{:.12e}}, by the scheme {{:.12e}} J".format(*pushed(scheme)))

for parts in (8, 32):
    print(f"newmark, steps split into {parts}: {principal(hht(0.0), 0.1 / parts).imag / TAU:.12f} Hz")
