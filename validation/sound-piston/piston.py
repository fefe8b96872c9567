"""Closed forms of the piston: the reference values of reference.toml (numpy, scipy)."""
import numpy as np
from scipy.special import j1

RADIUS, AMPLITUDE, MASS = 0.1, 1e-6, 1 + 0.001 * 1e-3 * np.pi * 0.1**2


def a_weighting(hz):
    """IEC 61672-1, annex E, in dB."""
    poles = 20.598997, 107.65265, 737.86223, 12194.217

    def response(f):
        f1, f2, f3, f4 = poles
        return f4**2 * f**4 / ((f**2 + f1**2) * np.sqrt((f**2 + f2**2) * (f**2 + f3**2)) * (f**2 + f4**2))

    return 20 * np.log10(response(hz) / response(1000.0))


def piston(stiffness, density=1.204, speed=343.0):
    omega = np.sqrt(stiffness / MASS)
    k, velocity = omega / speed, omega * AMPLITUDE
    ka = k * RADIUS
    side = 0.5 * density * speed * np.pi * RADIUS**2 * velocity**2 * (1 - 2 * j1(2 * ka) / (2 * ka))
    power = 2 * side

    def level(amplitude):
        return 20 * np.log10(amplitude / np.sqrt(2) / 20e-6)

    near, far, angle = 0.15, 5.0, np.radians(30)
    axis = 2 * density * speed * velocity * abs(np.sin(0.5 * k * (np.hypot(near, RADIUS) - near)))
    x = ka * np.sin(angle)
    off = density * omega * velocity * RADIUS**2 / (2 * far) * abs(2 * j1(x) / x)
    hz = omega / (2 * np.pi)
    weight = a_weighting(hz)
    mean = np.sqrt(2 * density * speed * power / (4 * np.pi))
    print(f"ka = {ka:.6f}, {hz:.4f} Hz, A-weighting {weight:.4f} dB")
    print(f"  power {power:.7e} W, {10 * np.log10(power / 1e-12):.4f} dB, {10 * np.log10(power / 1e-12) + weight:.4f} dB(A)")
    print(f"  mean at 1 m {level(mean):.4f} dB")
    print(f"  axis at 0.15 m {level(axis):.4f} dB, {level(axis) + weight:.4f} dB(A)")
    print(f"  5 m, 30 degrees off the axis {level(off):.4f} dB")


piston(2.941225e6)
piston(1.0588410e8)
piston(1.0588410e8, density=2.408, speed=686.0)
