"""The boxes of these cases by dense matrices, with and without mass of the incompatible displacements of 8-node hexahedra."""
import itertools

import numpy as np

CORNERS = [(-1, -1, -1), (1, -1, -1), (1, 1, -1), (-1, 1, -1), (-1, -1, 1), (1, -1, 1), (1, 1, 1), (-1, 1, 1)]


def gauss(n):
    x, w = np.polynomial.legendre.leggauss(n)
    return [(np.array(at), np.prod(of)) for at, of in zip(itertools.product(x, repeat=3), itertools.product(w, repeat=3))]


def element(size, modulus, ratio, density, points, moving):
    """K and M of a brick; its mass is integrated at points^3, of the incompatible displacements, too, where they are `moving`."""
    lame, shear = modulus * ratio / (1 + ratio) / (1 - 2 * ratio), modulus / 2 / (1 + ratio)
    elasticity = np.diag([2 * shear] * 3 + [shear] * 3)
    elasticity[:3, :3] += lame
    scale, volume = np.array(size) / 2, np.prod(size) / 8

    def shapes(at):
        factors = 1 + np.array(CORNERS) * at
        inner = [1 - at[k] ** 2 for k in range(3)]
        slopes = [np.array(CORNERS)[:, k] * np.prod(np.delete(factors, k, 1), 1) / 8 for k in range(3)]
        gradients = np.vstack([np.transpose(slopes), np.diag(-2 * at)]) / scale
        return np.concatenate([np.prod(factors, 1) / 8, inner]), gradients

    k, m = np.zeros((33, 33)), np.zeros((33, 33))
    for at, weight in gauss(2):
        strain = np.hstack([[[x, 0, 0], [0, y, 0], [0, 0, z], [y, x, 0], [0, z, y], [z, 0, x]] for x, y, z in shapes(at)[1]])
        k += weight * volume * strain.T @ elasticity @ strain
    for at, weight in gauss(points):
        shape = shapes(at)[0]
        shape[8:] *= moving
        m += weight * volume * density * np.kron(np.outer(shape, shape), np.eye(3))
    condense = np.vstack([np.eye(24), -np.linalg.solve(k[24:, 24:], k[24:, :24])])
    return condense.T @ k @ condense, condense.T @ m @ condense


def frequencies(lengths, cells, points, moving):
    """Of steel, held at x = 0 [Hz]."""
    size = [length / n for length, n in zip(lengths, cells)]
    own = element(size, 209e3, 0.3, 7.85e-9, points, moving)
    grid = [range(n + 1) for n in cells]
    number = {at: k for k, at in enumerate(itertools.product(*grid))}
    whole = np.zeros((2, 3 * len(number), 3 * len(number)))
    for cell in itertools.product(*(range(n) for n in cells)):
        nodes = [number[tuple(c + (s > 0) for c, s in zip(cell, corner))] for corner in CORNERS]
        dofs = [3 * node + k for node in nodes for k in range(3)]
        for matrix, part in zip(whole, own):
            matrix[np.ix_(dofs, dofs)] += part
    free = [3 * k + c for at, k in number.items() if at[0] for c in range(3)]
    stiffness, mass = (matrix[np.ix_(free, free)] for matrix in whole)
    half = np.linalg.inv(np.linalg.cholesky(mass))
    return np.sqrt(np.linalg.eigvalsh(half @ stiffness @ half.T)[:10]) / 2 / np.pi


for moving, points in ((0, 3), (1, 2)):
    print("with" if moving else "without", *(f"{f:.7g}" for f in frequencies((300, 30, 1), (15, 1, 1), points, moving)))
