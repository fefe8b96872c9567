"""The reference values of this folder, apart from stridor. Needs numpy.  python3 reference.py"""
import numpy as np

E, RHO, L, A, I = 200e9, 7850.0, 0.5, 200e-6, 20e-3 * 10e-3**3 / 12
TAU = 2 * np.pi
ROOTS = [1.8751040687119611, 4.6940911329741745]


def show(name, lam):
    print(f"{name}: {lam.imag / TAU:.9f} Hz, growth rate {lam.real:.9f} 1/s, damping ratio {-lam.real / abs(lam):.12f}")


def viscous(omega, c):
    return complex(-c / 2, np.sqrt(omega**2 - c**2 / 4))


# Bending in y: roots 1 and 2; in z at twice the frequency.
weak = [(x / L) ** 2 * np.sqrt(E * I / (RHO * A)) for x in ROOTS]
for name, omega in [("first bending in y", weak[0]), ("first bending in z", 2 * weak[0]), ("second bending in y", weak[1])]:
    show(f"Rayleigh, {name}", viscous(omega, 8 + 40e-6 * omega**2))
    show(f"modal, {name}", viscous(omega, 2 * omega * (0.05 if name.startswith("second") else 0.02)))
    show(f"loss factor, {name}", 1j * omega * np.sqrt(1 + 0.08j))


def tip(lam, c=30.0):
    """Determinant of the bar's dynamic stiffness at its tip, with a dashpot."""
    k = np.sqrt(np.sqrt(-(lam**2) * RHO * A / (E * I) + 0j))
    x = k * L
    co, s, ch, sh = np.cos(x), np.sin(x), np.cosh(x), np.sinh(x)
    d = E * I / (1 - co * ch)
    return (d * k**3 * (co * sh + s * ch) + lam * c) * d * k * (s * ch - co * sh) - (d * k**2 * s * sh) ** 2


def secant(f, a, b):
    while abs(a - b) > 1e-13 * abs(a) and f(a) != f(b):
        a, b = a - f(a) * (a - b) / (f(a) - f(b)), a
    return a


# The search begins from the first order: -c phi^2/2 with phi^2 = 4/(rho A l) at the tip.
for name, omega in zip(["first", "second"], weak):
    start = complex(-30 * 4 / (RHO * A * L) / 2, omega)
    show(f"dashpot, {name} bending in y", secant(tip, start, start * 1.001))

slope = -2 * 0.25 * np.exp(-0.6)
mu = 0.3 + 0.25 * np.exp(-0.6)
print(f"falling friction {-slope * 10 / 4:.12f} 1/s, transverse friction {-mu * 10 / (4 * 0.3):.12f} 1/s")
squares = np.linalg.eigvals(np.array([[1.5 + 0.5, -0.5 + 0.7], [-0.5, 0.5 + 1.0]]))
show("flutter", max((1j * np.sqrt(w) for w in squares), key=lambda z: z.real))
show("contact dashpot", viscous(np.sqrt(1e5 / 2), 40 / 2))
show("dashpot and falling friction", viscous(np.sqrt(1e3), 3 / 2 + slope * 10 / 2))


# Flutter with dashpots of 0.06 along and 0.01 N s/m across; the shares from phi^H Q(lambda) phi = 0 with phi^H phi = 1.
damping, structure = np.diag([0.06, 0.01]), np.array([[2.0, -0.5], [-0.5, 1.5]])
coupling = np.array([[0.0, 0.7], [0.0, 0.0]])
companion = np.block([[np.zeros((2, 2)), np.eye(2)], [-structure - coupling, -damping]])
values, vectors = np.linalg.eig(companion)
for k in np.argsort(values.imag):
    if values[k].imag > 0:
        phi = vectors[:2, k] / np.linalg.norm(vectors[:2, k])
        show("flutter with dashpots", values[k])
        print(f"    of it damping {-(phi.conj() @ damping @ phi).real / 2:.12f}, "
              f"mode coupling {-(phi.conj() @ coupling @ phi).imag / 2 / values[k].imag:.12f} 1/s")
