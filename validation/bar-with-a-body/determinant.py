"""Natural frequencies of this folder's bar with a body or springs at its tip, apart from stridor: the zeros of the
determinant of the exact dynamic stiffness at the tip (Euler-Bernoulli bending in two planes, stretch and twist as waves), counted
by Wittrick and Williams (Q. J. Mech. Appl. Math. 24 (1971) 263). Needs numpy.  python3 determinant.py
"""
import numpy as np

E, NU, RHO, L, A = 200e9, 0.3, 7850.0, 0.5, 200e-6
I1, I2, J = 20e-3 * 10e-3**3 / 12, 10e-3 * 20e-3**3 / 12, 4574e-12
G = E / 2 / (1 + NU)


def bending(omega, inertia):
    """Stiffness of (w, w') at the tip of the clamped bar, and its modes below omega with the tip held."""
    k = (omega**2 * RHO * A / (E * inertia)) ** 0.25
    x = k * L
    c, s, ch, sh = np.cos(x), np.sin(x), np.cosh(x), np.sinh(x)
    matrix = np.array([[k**3 * (c * sh + s * ch), -k**2 * s * sh], [-k**2 * s * sh, k * (s * ch - c * sh)]])
    i = int(x / np.pi)
    held = i - (1 - (-1) ** i * np.sign(1 - c * ch)) / 2
    return E * inertia * matrix / (1 - c * ch), int(held)


def wave(omega, stiffness, inertia):
    k = omega * np.sqrt(inertia / stiffness)
    return stiffness * k / np.tan(k * L), int(k * L / np.pi)


def count(omega, mass, spring):
    """Natural frequencies below omega."""
    d = np.zeros((6, 6))
    d[0, 0], n0 = wave(omega, E * A, RHO * A)
    d[3, 3], n3 = wave(omega, G * J, RHO * (I1 + I2))
    in_y, ny = bending(omega, I1)
    in_z, nz = bending(omega, I2)
    d[np.ix_([1, 5], [1, 5])] = in_y
    turned = np.diag([1.0, -1.0])
    d[np.ix_([2, 4], [2, 4])] = turned @ in_z @ turned
    return n0 + n3 + ny + nz + int(np.sum(np.linalg.eigvalsh(d + spring - omega**2 * mass) < 0))


def frequencies(mass, spring=np.zeros((6, 6)), number=6):
    found = []
    for k in range(1, number + 1):
        low, high = 1e-3, 2e5
        for _ in range(200):
            middle = (low + high) / 2
            if count(middle, mass, spring) >= k:
                high = middle
            else:
                low = middle
        found.append(middle / (2 * np.pi))
    return found


def body(m, inertia, arm):
    """Mass matrix on the tip of a body whose centre stands at `arm` from it: u + r x arm moves, r turns."""
    x, y, z = arm
    follow = np.eye(6)
    follow[:3, 3:] = [[0, z, -y], [-z, 0, x], [y, -x, 0]]
    return follow.T @ np.diag([m] * 3 + inertia) @ follow


spring = np.zeros((6, 6))
spring[1:3, 1:3] = 50e3 * np.outer([0.6, 0.8], [0.6, 0.8])
spring[3:, 3:] = 300.0 * np.outer([1, 2, -2], [1, 2, -2]) / 9
for name, found in [
    ("bar", frequencies(np.zeros((6, 6)))),
    ("body", frequencies(body(0.3, [1e-4, 3e-4, 5e-4], [0, 0, 0]))),
    ("arm", frequencies(body(0.3, [1e-4, 3e-4, 5e-4], [40e-3, 30e-3, -20e-3]))),
    ("springs", frequencies(np.zeros((6, 6)), spring)),
]:
    print(f"{name:8}", *(f"{f:.7f}" for f in found))
# Part of the mass that moves with the first mode: (int phi)^2/int phi^2 over l, phi = cosh - cos - s (sinh - sin).
x = 1.8751040687119611
s = (np.cosh(x) + np.cos(x)) / (np.sinh(x) + np.sin(x))
print(f"effective mass of the first mode {(2 * s / x) ** 2 * RHO * A * L:.9f} kg")
