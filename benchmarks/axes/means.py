"""Means of axes, plain and such that outlying ones hardly move them."""

import numpy as np

from benchmarks.axes.generator import Array

FREEDOM = 4.0  # of the t distribution
ROUNDS = 100


def plain_mean(axes: Array) -> Array:
    """Return the direction of the sum of unit axes, (n, 3) of one sense → (3,)."""
    return _unit(axes.sum(axis=0))


def resisting_mean(axes: Array) -> Array:
    """Return the mean of unit axes as if from a t distribution across it, (n, 3) → (3,).

    The spread is estimated with it (Lange, Little & Taylor 1989,
    doi:10.1080/01621459.1989.10478852), with n − 1 for n. Of two axes it is the plain mean.
    """
    weights = np.ones(len(axes))
    for _ in range(ROUNDS):
        mean = _unit(weights @ axes)
        off = ((axes - np.outer(axes @ mean, mean)) ** 2).sum(axis=1)
        variance = float(weights @ off) / (2 * max(len(axes) - 1, 1))
        weights = (FREEDOM + 2) / (FREEDOM + off / max(variance, 1e-300))
    return mean


def spatial_median(axes: Array) -> Array:
    """Return the direction with the least sum of distances to unit axes, (n, 3) → (3,).

    By Weiszfeld's iteration.
    """
    mean = plain_mean(axes)
    for _ in range(ROUNDS):
        far = np.linalg.norm(axes - np.outer(axes @ mean, mean), axis=1)
        mean = _unit((axes / np.maximum(far, 1e-9)[:, None]).sum(axis=0))
    return mean


MEANS = {
    "mean of the bends": plain_mean,
    "mean that resists": resisting_mean,
    "spatial median": spatial_median,
}


def _unit(vector: Array) -> Array:
    return np.asarray(vector / np.linalg.norm(vector))
