"""Writes the matrices of this case, and prints what dense algebra says of them: the reference values of reference.toml.

A chain of masses with springs to the next, the third and the seventh neighbour, stiffness-proportional damping, and a friction-like
coupling in a few rows, which no transposition returns. Random numbers are those of a linear congruential generator, so that they
are the same everywhere.
"""
import numpy as np

N, FACTOR, BAND = 40, 0.8, 600
state = 12345


def uniform():
    """The next number in [0, 1) (Park and Miller's minimal standard generator)."""
    global state
    state = 16807 * state % 2147483647
    return state / 2147483647


M, C, K, F = (np.zeros((N, N)) for _ in range(4))
for i in range(N):
    M[i, i] = 0.8 + 0.4 * uniform()
    K[i, i] += 2e5 * (1 + uniform())
    for j in (i + 1, i + 3, i + 7):
        if j < N:
            spring = 1e6 * (1 + uniform())
            for matrix, value in ((K, spring), (C, 1e-6 * spring)):
                matrix[i, i] += value
                matrix[j, j] += value
                matrix[i, j] -= value
                matrix[j, i] -= value
# Pairs of neighbours of which one pushes the other and is not pushed back.
for i in range(2, N - 1, 5):
    push = 1.2e6 * (0.5 + uniform())
    F[i, i + 1] += push
    F[i + 1, i] -= push


def write(name, matrix):
    rows, columns = np.nonzero(matrix)
    with open(name, "w") as file:
        print("%%MatrixMarket matrix coordinate real general", file=file)
        print(N, N, len(rows), file=file)
        for i, j in sorted(zip(rows, columns), key=lambda ij: (ij[1], ij[0])):
            print(i + 1, j + 1, repr(float(matrix[i, j])), file=file)


def eigenvalues(factor):
    """All lambda of lambda^2 M + lambda C + K + factor F, scaled so that the companion matrix is balanced."""
    s = 1e3
    inverse = np.linalg.inv(M)
    zero, one = np.zeros((N, N)), np.eye(N)
    companion = np.block([[zero, one], [-inverse @ (K + factor * F) / s**2, -inverse @ C / s]])
    return s * np.linalg.eigvals(companion)


def unstable(factor):
    """Those in the band that grow: sigma > 1e-5 of the angular frequency where the band ends, as the certificate has it."""
    values = eigenvalues(factor)
    top = 2 * np.pi * BAND
    return values[(values.real > 1e-5 * top) & (abs(values.imag) < top)]


def grows(factor):
    """Whether sigma > 1e-6 |lambda| for any."""
    values = eigenvalues(factor)
    return (values.real > 1e-6 * abs(values)).any()


for name, matrix in (("m.mtx", M), ("c.mtx", C), ("k.mtx", K), ("f.mtx", F)):
    write(name, matrix)
for factor in (0.4, FACTOR, 1.6):
    values, grown = eigenvalues(factor), unstable(factor)
    inside = np.count_nonzero((values.imag > 0) & (values.imag < 2 * np.pi * BAND))
    print(f"factor {factor}: {len(grown)} of the eigenvalues grow, conjugates included; {inside} modes in the band")
    fastest = grown[np.argmax(grown.real)]
    print(f"  fastest: {fastest.real:.12f} 1/s at {abs(fastest.imag) / (2 * np.pi):.12f} Hz")
values = eigenvalues(FACTOR)
target = 2j * np.pi * 400
nearest = sorted(values[np.argsort(abs(values - target))][:5], key=lambda z: z.imag)
print("nearest to 400 Hz:", ", ".join(f"{z.imag / (2 * np.pi):.9f} Hz" for z in nearest))
low, high = 0.0, FACTOR
while high - low > 1e-13:
    middle = (low + high) / 2
    low, high = (low, middle) if grows(middle) else (middle, high)
print(f"first growth at factor {high:.12f}")
