"""Natural frequencies of free solids of steel (numpy, scipy): a sphere and cylinders between smooth planes from the zeros of determinants
of exact solutions, free cylinders by Rayleigh and Ritz with polynomials."""
import numpy as np
from scipy.optimize import brentq
from scipy.special import jv, kvp, iv, ivp, jvp, kv, spherical_jn, yv, yvp

E, NU, RHO = 210e9, 0.3, 7850.0
G = E / 2 / (1 + NU)
LAME = E * NU / ((1 + NU) * (1 - 2 * NU))
SHEAR, PRESSURE = np.sqrt(G / RHO), np.sqrt((LAME + 2 * G) / RHO)


def zeros(function, grid, without=()):
    """Zeros between the points of a grid; the next to those of `without` are left out."""
    grid = np.sort(np.concatenate([grid, *([x * (1 - 1e-7), x * (1 + 1e-7)] for x in without if x > 0)]))
    spans = [(a, b) for a, b in zip(grid, grid[1:]) if not any(a < x < b for x in without)]
    return [brentq(function, a, b, xtol=1e-12, rtol=1e-14) for a, b in spans if function(a) * function(b) < 0]


def sphere(radius, below):
    """(frequency [Hz], kind, n): each counts 2 n + 1 times (H. Lamb, Proc. London Math. Soc. 13 (1882) 189; A. C. Eringen and E. S. Suhubi,
    Elastodynamics II (1975), section 8.14)."""
    grid = np.linspace(0.05, 2 * np.pi * below * radius / SHEAR, 1000)
    found = []
    for n in range(9):
        j = spherical_jn

        def torsional(x, n=n):
            return (n - 1) * j(n, x) - x * j(n + 1, x)

        def spheroidal(x, n=n):
            y = x * SHEAR / PRESSURE
            t11 = (n * n - n - x * x / 2) * j(n, y) + 2 * y * j(n + 1, y)
            if n == 0:
                return t11
            t13 = n * (n + 1) * ((n - 1) * j(n, x) - x * j(n + 1, x))
            t41 = (n - 1) * j(n, y) - y * j(n + 1, y)
            t43 = (n * n - 1 - x * x / 2) * j(n, x) + x * j(n + 1, x)
            return t11 * t43 - t13 * t41

        found += [(x * SHEAR / radius / 2 / np.pi, "spheroidal", n) for x in zeros(spheroidal, grid)]
        if n > 0:
            found += [(x * SHEAR / radius / 2 / np.pi, "torsional", n) for x in zeros(torsional, grid)]
    return sorted(found)


def radial(kind, n, k2, r):
    """A solution of Bessel's equation with k2 the square of the wavenumber, and its first two derivatives by r."""
    k = np.sqrt(abs(k2))
    if k2 > 0:
        f, fp = (jv, jvp) if kind == 0 else (yv, yvp)
    else:
        f, fp = (iv, ivp) if kind == 0 else (kv, kvp)
    value, slope = f(n, k * r), k * fp(n, k * r, 1)
    return value, slope, (n * n / r**2 - k2) * value - slope / r


def planes(inner, outer, n, k, omega):
    """Determinant of the free curved surfaces of a (hollow) cylinder for waves cos n theta, cos k z (D. C. Gazis, J. Acoust. Soc. Am. 31 (1959)
    568): u = grad phi + curl (psi e_z) + curl curl (chi e_z) without stress at the radii."""
    p2, q2 = (omega / PRESSURE) ** 2 - k * k, (omega / SHEAR) ** 2 - k * k
    rows = []
    for r in [outer] if inner == 0 else [inner, outer]:
        columns = []
        for kind in [0] if inner == 0 else [0, 1]:
            f, d, dd = radial(kind, n, p2, r)
            # phi = f cos n theta cos kz
            columns.append([2 * G * dd - LAME * (omega / PRESSURE) ** 2 * f, -2 * G * n * (d / r - f / r**2), -2 * G * k * d])
            f, d, dd = radial(kind, n, q2, r)
            # psi = f sin n theta cos kz: u_r = n f / r, u_theta = -f'
            columns.append([2 * G * n * (d / r - f / r**2), G * (-n * n * f / r**2 - dd + d / r), -G * k * n * f / r])
            # chi = f cos n theta sin kz: u_r = k f', u_theta = -k n f / r, u_z = q2 f (times cos, sin, cos and cos kz, cos kz, sin kz)
            columns.append([2 * G * k * dd, -2 * G * k * n * (d / r - f / r**2), G * (q2 - k * k) * d])
        rows.append(np.array(columns).T)
    matrix = np.concatenate(rows)
    matrix /= np.abs(matrix).max(axis=0)
    if n == 0:
        # Torsion is apart.
        keep = [i for i in range(len(matrix)) if i % 3 != 1]
        if k == 0:
            keep = [i for i in keep if i % 3 == 0]
        matrix = matrix[np.ix_(keep, keep)]
    elif k == 0:
        keep = [i for i in range(len(matrix)) if i % 3 != 2]
        matrix = matrix[np.ix_(keep, keep)]
    return np.linalg.det(matrix)


def cylinder_between_planes(inner, outer, length, below):
    """(frequency [Hz], n, half waves along z): counts twice where n > 0. Without the modes of u_z alone, which such planes hold for k = 0."""
    grid = 2 * np.pi * np.linspace(below / 1000, below, 1000)
    found = []
    for n in range(7):
        for m in range(4):
            k = m * np.pi / length
            # Where a radial wavenumber is zero the columns change their sign.
            omegas = zeros(lambda w: planes(inner, outer, n, k, w), grid, (k * PRESSURE, k * SHEAR))
            found += [(w / 2 / np.pi, n, m) for w in omegas]
            if n == 0 and m > 0:
                found.append((k * SHEAR / 2 / np.pi, "torsion", m))
    return sorted((f for f in found if f[0] < below), key=lambda f: f[0])


def ritz(inner, outer, length, n, degree, torsion=False, material=(E, NU, RHO), along_z=None):
    """Natural frequencies [Hz] of a free cylinder with cos n theta: polynomials of r and z, the regular ones where there is no hole; of a degree
    of its own along z where one is given."""
    degree_z = along_z or degree
    young, nu, rho = material
    shear, lame = young / 2 / (1 + nu), young * nu / ((1 + nu) * (1 - 2 * nu))
    gauss = np.polynomial.legendre.leggauss
    x, wr = gauss(degree + 8)
    r, wr = (inner + outer) / 2 + (outer - inner) / 2 * x, wr * (outer - inner) / 2
    z, wz = (length / 2 * v for v in gauss(degree_z + 8))
    r, z, weight = np.repeat(r, len(z)), np.tile(z, len(r)), np.outer(wr, wz).ravel()
    weight = weight * r
    legendre = np.polynomial.legendre.Legendre.basis
    along = [legendre(i)(2 * z / length) for i in range(degree_z + 1)]
    slopes = [legendre(i).deriv()(2 * z / length) * 2 / length if i else 0 * z for i in range(degree_z + 1)]

    def across(power):
        """Functions of r and their derivatives."""
        if inner == 0:
            s, ds = 2 * (r / outer) ** 2 - 1, 4 * r / outer**2
            base, dbase = (r / outer) ** power, power * r ** max(power - 1, 0) / outer**power
            for i in range(degree // 2 + 1):
                p, dp = legendre(i)(s), legendre(i).deriv()(s) * ds if i else 0 * r
                yield base * p, dbase * p + base * dp
        else:
            s = (2 * r - inner - outer) / (outer - inner)
            for i in range(degree + 1):
                yield legendre(i)(s), legendre(i).deriv()(s) * 2 / (outer - inner) if i else 0 * r

    basis = []
    for f, df in across(n + 1):
        shapes = [(0, 1, 0)] if torsion else ([(1, 0, 0)] if n == 0 else [(1, 1, 0)])
        basis += [(shape, f, df) for shape in shapes]
    if n > 0:
        basis += [((1, -1, 0), f, df) for f, df in across(n - 1)]
    if not torsion:
        basis += [((0, 0, 1), f, df) for f, df in across(n)]
    strains, motions = [], []
    for (a, b, c), f, df in basis:
        for g, dg in zip(along, slopes):
            # u_r = a f g cos, u_theta = b f g sin, u_z = c f g cos.
            strains.append([a * df * g, (n * b + a) * f * g / r, c * f * dg, (-n * a - b) * f * g / r + b * df * g,
                            b * f * dg - n * c * f * g / r, c * df * g + a * f * dg])
            motions.append([a * f * g, b * f * g, c * f * g])
    strains, motions = np.array(strains), np.array(motions)
    d = np.zeros((6, 6))
    d[:3, :3] = lame + 2 * shear * np.eye(3)
    d[3:, 3:] = shear * np.eye(3)
    scaled = strains * np.sqrt(weight)
    stressed = np.einsum("ij,bjp->bip", d, scaled).reshape(len(scaled), -1)
    stiffness = stressed @ scaled.reshape(len(scaled), -1).T
    moved = (motions * np.sqrt(weight)).reshape(len(motions), -1)
    mass = rho * moved @ moved.T
    scale, vectors = np.linalg.eigh(mass)
    keep = scale > 1e-12 * scale[-1]
    half = vectors[:, keep] / np.sqrt(scale[keep])
    values = np.linalg.eigvalsh(half.T @ stiffness @ half)
    return np.sqrt(np.maximum(values, 0)) / 2 / np.pi


def free_cylinder(inner, outer, length, below, degree):
    found = []
    for n in range(9):
        for torsion in [False, True] if n == 0 else [False]:
            modes = ritz(inner, outer, length, n, degree, torsion)
            found += [(f, "torsion" if torsion else n) for f in modes if 1.0 < f < below]
    return sorted(found, key=lambda f: f[0])


if __name__ == "__main__":
    def show(title, modes):
        print(title)
        for f, *what in modes:
            print(f"  {f:.6f}", *what)

    show("sphere, radius 50 mm", sphere(0.05, 48e3))
    show("cylinder between smooth planes, radius 25 mm, length 60 mm", cylinder_between_planes(0, 0.025, 0.06, 50e3))
    show("ring between smooth planes, radii 30 and 50 mm, height 30 mm", cylinder_between_planes(0.03, 0.05, 0.03, 42e3))
    for degree in (12, 16):
        show(f"free cylinder, degree {degree}", free_cylinder(0, 0.025, 0.06, 50e3, degree))
        show(f"free ring, degree {degree}", free_cylinder(0.03, 0.05, 0.03, 30e3, degree))
