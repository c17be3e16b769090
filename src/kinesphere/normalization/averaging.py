"""A mean of rotations that a few bad ones do not move."""

from collections.abc import Callable

import numpy as np

from kinesphere.data import Array
from kinesphere.geometry.poses import relative_rotations
from kinesphere.geometry.rotations import nearest_rotation, rotation_exp, rotation_log
from kinesphere.geometry.vectors import lengths

_ROUNDS = 30
_FREEDOM = 5.0  # of the t distribution: nearly a mean where errors are normal
_MEDIAN = 1.538  # of the length of a normal vector in space, in its standard deviations
_FLOOR = 1e-3  # rad; below this distance every rotation counts alike, so a mean is found at all


def robust_mean_rotations(rotations: Array) -> Array:
    """Return a mean of each column of rotations that outliers do not move.

    The geodesic median (Weiszfeld's iteration on SO(3): Hartley, Aftab & Trumpf 2011,
    doi:10.1109/CVPR.2011.5995745) from the chordal mean, and from there the likeliest centre of a
    t distribution as wide as the median finds it: of normal errors a median wastes 15 % of what
    they tell.
    Turning all rotations from the left or from the right turns the result with them.

    Parameters
    ----------
    rotations : (n, n_columns, 3, 3)
        NaN entries are left out.

    Returns
    -------
    (n_columns, 3, 3)
        NaN where a column has none.
    """
    known = np.asarray(np.isfinite(rotations).all(axis=(2, 3)))
    some = known.any(axis=0)
    means = np.full(rotations.shape[1:], np.nan)
    if not some.any():
        return means
    known, rotations = known[:, some], np.where(known[..., None, None], rotations, np.eye(3))
    rotations = rotations[:, some]
    mean = nearest_rotation((rotations * known[..., None, None]).sum(axis=0))
    mean, apart = _settle(mean, rotations, lambda d: known / np.maximum(d, _FLOOR))
    middle = np.nanmedian(np.where(known, apart, np.nan), axis=0)
    width = _FREEDOM * np.maximum(middle / _MEDIAN, _FLOOR) ** 2
    mean, _ = _settle(mean, rotations, lambda d: known / (1 + d**2 / width))
    means[some] = nearest_rotation(mean)
    return means


def _settle(mean: Array, rotations: Array, weigh: Callable[[Array], Array]) -> tuple[Array, Array]:
    """Return the mean that its own weights keep, (n_columns, 3, 3), and all distances from it."""
    for _ in range(_ROUNDS):
        away = rotation_log(relative_rotations(mean, rotations))
        apart = lengths(away)
        weights = weigh(apart)
        step = (weights[..., None] * away).sum(axis=0) / weights.sum(axis=0)[:, None]
        mean = mean @ rotation_exp(step)
        if np.abs(step).max() < 1e-12:
            break
    return mean, apart
