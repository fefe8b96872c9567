"""Where Kirchhoff's plate is 1 % above three-dimensional elasticity: sizes of the plates, reference values (numpy, scipy)."""
import numpy as np
from scipy.optimize import brentq

E, NU, RHO, H = 210e9, 0.3, 7850.0, 0.01
LONG = np.sqrt(E * (1 - NU) / ((1 + NU) * (1 - 2 * NU) * RHO))
SHEAR = np.sqrt(E / (2 * (1 + NU) * RHO))


def lamb(k):
    """omega of the lowest antisymmetric Lamb wave."""

    def dispersion(omega):
        p, q = np.sqrt(k**2 - (omega / LONG) ** 2), np.sqrt(k**2 - (omega / SHEAR) ** 2)
        return (q**2 + k**2) ** 2 * np.tanh(p * H / 2) - 4 * k**2 * p * q * np.tanh(q * H / 2)

    return brentq(dispersion, 0.3 * kirchhoff(k, False), 0.9999 * SHEAR * k, xtol=1e-9, rtol=1e-14)


def kirchhoff(k, rotary):
    stiffness = E * H**3 / 12 / (1 - NU**2)
    return k**2 * np.sqrt(stiffness / (RHO * (H + (H**3 * k**2 / 12 if rotary else 0))))


for rotary in (False, True):
    k = brentq(lambda k: kirchhoff(k, rotary) / lamb(k) - 1.01, 1.0, 200.0)
    hz = [omega / (2 * np.pi) for omega in (kirchhoff(k, rotary), lamb(k))]
    # Mode (1, 1) of a supported square of this edge has the wavenumber k.
    print(f"rotary inertia {rotary}: kh = {k * H:.5f}, edge {1e3 * np.sqrt(2) * np.pi / k:.6f} mm")
    print(f"  Kirchhoff {hz[0]:.4f} Hz, three-dimensional elasticity {hz[1]:.5f} Hz")
