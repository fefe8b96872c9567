"""Modes of an annulus, clamped at r = b and free at r = a, in Kirchhoff's theory (numpy, scipy).

w = [A Jn(kr) + B Yn(kr) + C In(kr) + D Kn(kr)] cos n(t - t0), of modal mass 1.
"""
import numpy as np
from scipy.optimize import brentq
from scipy.special import iv, ivp, jv, jvp, kv, kvp, yv, yvp

FAMILIES = ((jv, jvp, -1), (yv, yvp, -1), (iv, ivp, 1), (kv, kvp, 1))


class Annulus:
    def __init__(self, outer, inner, thickness, modulus=210e9, ratio=0.3, density=7850.0):
        self.a, self.b, self.ratio, self.mass = outer, inner, ratio, density * thickness
        # omega = wave k^2
        self.wave = np.sqrt(modulus * thickness**2 / (12 * density * (1 - ratio**2)))

    def column(self, family, n, k):
        """Deflection and slope at b, moment and shear force at a; the Laplacian of a family is sign k^2 times itself."""
        f, fp, sign = family
        w, w1 = f(n, k * self.a), k * fp(n, k * self.a)
        moment = sign * k**2 * w - (1 - self.ratio) * (w1 / self.a - n**2 * w / self.a**2)
        shear = sign * k**2 * w1 - (1 - self.ratio) * n**2 / self.a**2 * (w1 - w / self.a)
        return np.array([f(n, k * self.b), k * fp(n, k * self.b), moment, shear])

    def system(self, n, k):
        """Columns and rows of the size of one, and the sizes of the columns."""
        columns = [self.column(family, n, k) for family in FAMILIES]
        matrix = np.array([c / np.abs(c).max() for c in columns]).T
        return matrix / np.abs(matrix).max(axis=1, keepdims=True), [np.abs(c).max() for c in columns]

    def modes(self, top):
        """All up to a frequency, in order; each with n > 0 stands for two."""
        found = []
        for n in range(60):
            k = np.linspace(5.0, np.sqrt(2 * np.pi * top / self.wave), 1500)
            k = k[k > 0.6 * n / self.a]
            d = [np.linalg.det(self.system(n, x)[0]) for x in k]
            signs = [i for i in range(len(k) - 1) if d[i] * d[i + 1] < 0]
            found += [Mode(self, n, brentq(lambda x: np.linalg.det(self.system(n, x)[0]), k[i], k[i + 1], xtol=1e-12)) for i in signs]
            if not signs:
                break
        return sorted(found, key=lambda mode: mode.hz)


class Mode:
    def __init__(self, plate, n, k):
        self.n, self.k, self.hz = n, k, plate.wave * k**2 / (2 * np.pi)
        matrix, sizes = plate.system(n, k)
        self.part = np.linalg.svd(matrix)[2][-1] / sizes
        x, weight = np.polynomial.legendre.leggauss(200)
        r = 0.5 * (plate.a + plate.b) + 0.5 * (plate.a - plate.b) * x
        square = np.sum(weight * 0.5 * (plate.a - plate.b) * r * self.radial(r)[0] ** 2) * np.pi * (2 if n == 0 else 1)
        self.part /= np.sqrt(plate.mass * square)

    def radial(self, r):
        """R and dR/dr."""
        each = [(f(self.n, self.k * r), self.k * fp(self.n, self.k * r)) for f, fp, _ in FAMILIES]
        return sum(p * e[0] for p, e in zip(self.part, each)), sum(p * e[1] for p, e in zip(self.part, each))

    def motion(self, r, t, height, turn):
        """Motion along x, y, z of the mesh of points that stand `height` above the middle of the plate."""
        value, slope = self.radial(r)
        w, along = value * np.cos(self.n * (t - turn)), slope * np.cos(self.n * (t - turn))
        around = -self.n / r * value * np.sin(self.n * (t - turn))
        radial, tangent = np.array([0 * t, np.sin(t), -np.cos(t)]), np.array([0 * t, np.cos(t), np.sin(t)])
        return (np.array([w, 0 * w, 0 * w]) - height * (along * radial + around * tangent)).T


def receptance(modes, damping, hz, force, motion):
    """Between two places (r, t), along the normal, by superposition."""
    omega, total = 2 * np.pi * hz, np.zeros(len(hz), complex)
    for one in modes:
        own = 2 * np.pi * one.hz
        product = one.radial(force[0])[0] * one.radial(motion[0])[0] * np.cos(one.n * (force[1] - motion[1]))
        total += product / (own**2 - omega**2 + 2j * damping * own * omega)
    return total
