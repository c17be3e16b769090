"""How many axes a joint moves about, told from its rotations alone."""

import numpy as np

from kinesphere.data import Array
from kinesphere.geometry.rotations import mean_rotation, rotation_log

ONE_AXIS_SHARE = 0.05
"""A hinge's second-widest rotation has less than this share of the widest one's variance."""
ONE_AXIS_RATIO = 0.2
"""Least over second-least singular value of SARA's equations: below it the limbs share a line."""
MIN_RANGE = np.deg2rad(10.0)
"""rad, rms rotation about the widest axis below which nothing is said."""


def count_axes(rotations: Array) -> int | None:
    """Return 1 for a hinge, 2 for anything freer, None where the motion is too small to tell.

    A hinge turns about one direction (eigenvalues of the rotation vectors' covariance) *and* leaves
    a whole line at rest (SARA [1]_).

    Parameters
    ----------
    rotations : (n_frames, 3, 3)
        ``parent_from_child``; frames with NaN take no part.

    References
    ----------
    .. [1] Ehrig et al. (2007), J. Biomech. 40(10), 2150-2157, doi:10.1016/j.jbiomech.2006.10.026.
    """
    r = rotations[np.isfinite(rotations).all(axis=(1, 2))]
    if len(r) < 10:
        return None
    turns = rotation_log(mean_rotation(r).T @ r)
    spread = np.linalg.eigvalsh(np.cov(turns.T))[::-1]
    if np.sqrt(spread[0]) < MIN_RANGE:
        return None
    lines = np.concatenate([np.broadcast_to(np.eye(3), r.shape), -r], axis=2)
    s = np.linalg.svd(lines.reshape(-1, 6), compute_uv=False)
    one = spread[1] < ONE_AXIS_SHARE * spread[0] and s[5] < ONE_AXIS_RATIO * s[4]
    return 1 if one else 2
