"""Closed forms of the chain and of the least squares: the reference values of reference.toml (numpy, scipy)."""
import numpy as np
from scipy.optimize import least_squares

STIFFNESS, MASS, DEVIATION, EXPECTED = 1e4, 1.0, 0.004, 0.03
FACTORS = np.array([1.012, 1.009, 1.014, 1.005])
hz = 2 * np.sqrt(STIFFNESS / MASS) * np.sin((2 * np.arange(1, 5) - 1) * np.pi / 18) / (2 * np.pi)
measured = np.round(hz * FACTORS, 5)
print("measured =", measured.tolist())

print("\nAll springs and all masses: ln f = ln f0 + (x_k - x_m)/2 with x = ln of a value over that of the case.")
apart = np.log(measured / hz)
mean, n = apart.mean(), len(hz)
print("chi2", np.sum((apart - mean) ** 2) / DEVIATION**2)
print("errors [%]", 100 * (np.exp(mean - apart) - 1))
others = (apart.sum() - apart) / (n - 1)
print("predicted from the others [%]", 100 * (np.exp(others - apart) - 1))
# In units of half of the bounds, ln 2, every row of the sensitivity is (-1, 1) ln 2/(2 s).
print("largest singular value", np.sqrt(2 * n) * np.log(2) / (2 * DEVIATION))

print("\nThe mass known to 3 %: ln k = 2 mean + ln m, and the variances add.")
deviation = np.hypot(2 * DEVIATION / np.sqrt(n), EXPECTED)
found = np.exp(2 * mean) * STIFFNESS
print("stiffness", found, "deviation", found * deviation, "correlation", EXPECTED / deviation)
print("95 %", found * np.exp(-1.959963985 * deviation), found * np.exp(1.959963985 * deviation))

print("\nThe ground spring and all masses: eigenvalues of the chain by numpy, fitted by scipy.")


def chain(ground, mass):
    matrix = np.diag([ground, 0.0, 0.0, 0.0])
    for i in range(3):
        matrix[i : i + 2, i : i + 2] += STIFFNESS * np.array([[1, -1], [-1, 1]])
    return np.sqrt(np.linalg.eigvalsh(matrix / mass)) / (2 * np.pi)


def residuals(x):
    return np.log(chain(STIFFNESS * np.exp(x[1]), MASS * np.exp(x[0])) / measured) / DEVIATION


fit = least_squares(residuals, [0.0, 0.0], jac="3-point", xtol=1e-15, ftol=1e-15, gtol=1e-15)
step = 1e-5
sides = [[residuals(fit.x + sign * step * np.eye(2)[j]) for sign in (1, -1)] for j in (0, 1)]
jacobian = np.array([(up - down) / (2 * step) for up, down in sides]).T
covariance = np.linalg.inv(jacobian.T @ jacobian)
values = np.array([MASS, STIFFNESS]) * np.exp(fit.x)
singular = np.linalg.svd(np.log(2) * jacobian, compute_uv=False)
print("mass, stiffness", values, "deviations", values * np.sqrt(np.diag(covariance)))
print("correlation", covariance[0, 1] / np.sqrt(covariance[0, 0] * covariance[1, 1]))
print("chi2", 2 * fit.cost, "singular values", singular, "condition", singular[0] / singular[1])
# Student's t with two degrees of freedom leaves 5 % outside 4.302653.
half = 4.302652730 * np.sqrt(fit.cost) * np.sqrt(np.diag(covariance))
print("scaled 95 %", values * np.exp(-half), values * np.exp(half), "P(chi2)", np.exp(-fit.cost))
