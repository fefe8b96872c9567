"""The same draws, counted apart from the program: the reference values of reference.toml (numpy)."""
import itertools

import numpy as np

LEVELS = np.array([100.0, 118.0, 150.0, 171.0, 205.0, 260.0])
REACH = 0.2


def two_and_a_scale():
    """In closed form: ln of the ratio of two draws has the density of a triangle; a pair of levels is met as well as by the
    data where it is within e of that of the pair."""
    measured = np.array([131.0, 200.2])
    own = min(abs(np.log(measured[0] / measured[1]) - np.log(LEVELS[i] / LEVELS[j])) for i, j in itertools.permutations(range(6), 2))
    length = np.log(measured[1] / measured[0])
    ends = sorted((np.log(LEVELS[i] / LEVELS[j]) - own, np.log(LEVELS[i] / LEVELS[j]) + own) for i, j in itertools.permutations(range(6), 2))

    def below(d):
        """Share of draws with a smaller logarithm of the ratio."""
        d = np.clip(d, -length, length)
        return 0.5 + (d * length - np.sign(d) * d**2 / 2) / length**2

    share, reached = 0.0, -np.inf
    for low, high in ends:
        low = max(low, reached)
        if high > low:
            share += below(high) - below(low)
            reached = high
    print(f"two frequencies, one scale: largest error {100 * np.expm1(own / 2):.6f} %, chi2 {own**2 / (2 * 0.01**2):.7f}, share {share:.6f}")


def three_and_two_numbers(blocks=8, block=250_000):
    """By brute force: every assignment, least squares inside the bounds by trying every set of bounds that hold."""
    measured, deviation = np.array([98.5, 167.0, 210.0]), np.array([0.004, 0.01, 0.006])
    # The scale, flat between its bounds, and the stiffness of the springs of levels 2 and 5, known to 10 %: ln f moves with
    # x in these units.
    half = 0.5 * np.log(1.05 / 0.95)
    slope = np.zeros((6, 2))
    slope[:, 0], slope[[1, 4], 1] = half, 0.5 * 0.1
    lower, upper = np.array([np.log(0.95) / half, np.log(0.8) / 0.1]), np.array([np.log(1.05) / half, np.log(1.25) / 0.1])
    low = np.log(LEVELS) + np.minimum(slope * lower, slope * upper).sum(axis=1) - np.log1p(REACH)
    high = np.log(LEVELS) + np.maximum(slope * lower, slope * upper).sum(axis=1) + np.log1p(REACH)

    def least(targets, chosen):
        """The least chi2 for each row of targets, and where."""
        rows = np.vstack([slope[list(chosen)] / deviation[:, None], [0.0, 1.0]])
        right = np.hstack([(targets - np.log(LEVELS[list(chosen)])) / deviation, np.zeros((len(targets), 1))])
        best, where = np.full(len(targets), np.inf), np.zeros((len(targets), 2))
        for state in itertools.product((None, 0, 1), repeat=2):
            x = np.zeros((len(targets), 2))
            free = [j for j in (0, 1) if state[j] is None]
            for j in (0, 1):
                if state[j] is not None:
                    x[:, j] = (lower, upper)[state[j]][j]
            if free:
                x[:, free] = np.linalg.lstsq(rows[:, free], (right - x @ rows.T).T, rcond=None)[0].T
            inside = np.all((x >= lower - 1e-12) & (x <= upper + 1e-12), axis=1)
            chi2 = np.where(inside, np.sum((right - x @ rows.T) ** 2, axis=1), np.inf)
            better = chi2 < best
            best[better], where[better] = chi2[better], x[better]
        return best, where

    def best(targets):
        plausible = (low <= targets[:, :, None]) & (targets[:, :, None] <= high)
        count = np.zeros(len(targets), dtype=int)
        chi2, error = np.full(len(targets), np.inf), np.full(len(targets), np.inf)
        for chosen in itertools.permutations(range(6), 3):
            may = np.all([plausible[:, i, k] for i, k in enumerate(chosen)], axis=0)
            count += may
            if not may.any():
                continue
            own, where = least(targets[may], chosen)
            away = np.log(LEVELS[list(chosen)]) + where @ slope[list(chosen)].T - targets[may]
            rows = np.flatnonzero(may)
            better = own < chi2[rows]
            chi2[rows[better]] = own[better]
            error[rows[better]] = np.abs(np.expm1(away[better])).max(axis=1)
        return chi2, error, count

    (chi2,), (error,), (count,) = best(np.log(measured)[None, :])
    ends = np.log(measured.min()), np.log(measured.max())
    random, draws, by_error, by_chi2 = np.random.default_rng(1), blocks * block, 0, 0
    for _ in range(blocks):
        drawn = best(random.uniform(*ends, size=(block, 3)))
        by_error += np.sum(drawn[1] <= error)
        by_chi2 += np.sum(drawn[0] <= chi2)
    for name, share in (("error", by_error / draws), ("chi2", by_chi2 / draws)):
        print(f"three frequencies, two numbers: by {name} {share:.5f} +- {np.sqrt(share * (1 - share) / draws):.5f}")
    print(f"  chi2 {chi2:.7f}, largest error {100 * error:.6f} %, plausible assignments {count}")


two_and_a_scale()
three_and_two_numbers()
