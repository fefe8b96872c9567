"""Closed form of FV42 and Rayleigh-Ritz values of FV41 [Hz] (numpy, scipy)."""
import sys

import numpy as np
from scipy.optimize import brentq

sys.path.append("../free-solids")
from exact import ritz


def breathing(inner, outer, material, below):
    """Radial vibration of a hollow sphere: u = phi', phi = (A sin kr + B cos kr) / r, k = omega / c_p, with sigma_r = 0 at both radii."""
    young, nu, rho = material
    shear, lame = young / 2 / (1 + nu), young * nu / ((1 + nu) * (1 - 2 * nu))
    speed = np.sqrt((lame + 2 * shear) / rho)

    def determinant(omega):
        k, rows = omega / speed, []
        for r in (inner, outer):
            row = []
            for f, slope in ((np.sin(k * r), np.cos(k * r)), (np.cos(k * r), -np.sin(k * r))):
                phi, u = f / (k * r), slope / r - f / (k * r * r)
                # phi'' = -k^2 phi - 2 u / r
                row.append(-lame * k * k * phi + 2 * shear * (-k * k * phi - 2 * u / r))
            rows.append(row)
        return np.linalg.det(np.array(rows) / shear / k**2)

    grid = 2 * np.pi * np.linspace(1, below, 2000)
    values = [determinant(x) for x in grid]
    return [brentq(determinant, a, b, rtol=1e-14) / 2 / np.pi for a, b, u, v in zip(grid, grid[1:], values, values[1:]) if u * v < 0]


if __name__ == "__main__":
    nafems = (200e9, 0.3, 8000.0)
    print("FV41", np.round(ritz(1.8, 2.2, 10.0, 0, 20, material=nafems)[:6], 4))
    print("FV42", np.round(breathing(1.8, 6.0, nafems, 3000), 4))
    print("hollow sphere of steel, radii 30 and 50 mm", breathing(0.03, 0.05, (210e9, 0.3, 7850.0), 60e3))
