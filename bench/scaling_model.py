"""T(N, p) = a N / p + [p > 1] (b A + c + d log2 p): time of a step of N grains on p workers [s].

a is work, which is shared; b is paid for the ghosts on the faces of a slice, whose area A does not shrink with p (slices
are cut along x only); c and d log2 p are messages and the sum over all workers. All terms cost time, so the fit is by
least squares over non-negative coefficients, relative to the measured time. Terms that the points cannot tell apart are
shared out by the smallest norm and said to be undetermined.
"""
import itertools

import numpy as np

NAMES = ("a: work of a grain", "b: ghosts of a grain of face", "c: messages", "d: a doubling of workers")


def terms(grains, workers, face):
    several = 1.0 if workers > 1 else 0.0
    return np.array([grains / workers, several * face, several, several * np.log2(workers)])


def fit(points):
    """points: (grains, workers, grains in a cross-section, seconds a step). Returns coefficients and which are known."""
    rows = np.array([terms(n, p, f) / t for n, p, f, t in points])
    rows[:, rows.max(axis=0) == 0] = 0
    target = np.ones(len(rows))
    best, best_misfit = np.zeros(4), np.inf
    for size in range(1, 5):
        for chosen in itertools.combinations(range(4), size):
            found = np.zeros(4)
            found[list(chosen)] = np.linalg.lstsq(rows[:, chosen], target, rcond=1e-10)[0]
            misfit = np.linalg.norm(rows @ found - target)
            if (found >= 0).all() and misfit < best_misfit - 1e-9:
                best, best_misfit = found, misfit
    known = np.linalg.matrix_rank(rows / np.maximum(np.linalg.norm(rows, axis=0), 1e-300), tol=1e-3)
    return best, int(known), best_misfit / np.sqrt(len(rows))


def time_of_a_step(coefficients, grains, workers, face):
    return float(terms(grains, workers, face) @ coefficients)


def efficiency(coefficients, grains, workers, face):
    alone = time_of_a_step(coefficients, grains, 1, face)
    return alone / (workers * time_of_a_step(coefficients, grains, workers, face))


def largest_efficient(coefficients, grains, face, wanted=0.5, most=1 << 20):
    """Largest power of two of workers at which the efficiency is at least `wanted`."""
    workers = 1
    while workers < most and efficiency(coefficients, grains, 2 * workers, face) >= wanted:
        workers *= 2
    return workers
