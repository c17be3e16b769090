"""A mean of rotations that a few bad ones do not move."""

import numpy as np

from kinesphere.data import Array
from kinesphere.geometry.rotations import nearest_rotation, rotation_exp, rotation_log
from kinesphere.geometry.vectors import lengths

_ROUNDS = 30
_FLOOR = 1e-3  # rad; below this distance every rotation counts alike, so a mean is found at all


def robust_mean_rotations(rotations: Array) -> Array:
    """Return the geodesic median of each column of rotations.

    Weiszfeld's iteration on SO(3) (Hartley, Aftab & Trumpf 2011, doi:10.1109/CVPR.2011.5995745)
    from the chordal mean. Turning all rotations from the left or from the right turns the result
    with them.

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
    for _ in range(_ROUNDS):
        away = rotation_log(np.swapaxes(mean, -1, -2) @ rotations)
        weights = known / np.maximum(lengths(away), _FLOOR)
        step = (weights[..., None] * away).sum(axis=0) / weights.sum(axis=0)[:, None]
        mean = mean @ rotation_exp(step)
        if np.abs(step).max() < 1e-12:
            break
    means[some] = nearest_rotation(mean)
    return means
