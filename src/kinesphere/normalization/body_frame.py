"""The body's own axes in single frames: x anterior, y superior, z to the right.

Two ways: from the pairs of shoulders and hips, or from the plane closest to all joints
(Sar Dessai et al. 2006, section 3).
"""

import numpy as np

from kinesphere.data import Array
from kinesphere.geometry.planes import fit_planes, smallest_rectangles
from kinesphere.normalization.vectors import unit

TURNED_ROUND = np.diag([-1.0, 1.0, -1.0])
"""Front and back, hence left and right, exchanged: multiply from the right."""

_ACROSS = 0.94  # share of up along the plane's normal from which the body lies, not stands


def lateral_frames(to_right: Array, upward: Array, *, lean: bool = False) -> Array:
    """Return body frames from a direction across the body and one along it.

    Both tell how far the body leans sideways, and disagree. By default the lateral axis is kept;
    with ``lean`` each counts by what an error of the same size at every joint does to it, which is
    the least-squares fit of a body with equal sides: the trunk is longer than it is wide, and a
    raised shoulder tilts the line between both but not the trunk's.

    Parameters
    ----------
    to_right : (n, 3) m
        From left to right: the sum over the pairs, so wide pairs count more.
    upward : (n, 3) m
        From the hips to the shoulders, or the world's up.
    lean
        Whether ``upward`` is such a line between joints of the body.

    Returns
    -------
    (n, 3, 3)
        ``world_from_body``; NaN where a direction is NaN or both are parallel.
    """
    z = unit(to_right)
    sideways = (upward * z).sum(axis=-1, keepdims=True)
    y = unit(upward - sideways * z)
    if lean:
        tall = (upward * upward).sum(axis=-1, keepdims=True)
        wide = (to_right * to_right).sum(axis=-1, keepdims=True) / 4  # half of it on each side
        along = (upward * y).sum(axis=-1, keepdims=True)
        turn = tall / (tall + wide) * np.arctan2(sideways, along)
        y, z = np.cos(turn) * y + np.sin(turn) * z, np.cos(turn) * z - np.sin(turn) * y
    return np.stack([np.cross(y, z), y, z + 0.0 * y], axis=-1)  # NaN in one is NaN in all


def plane_frames(joints: Array, vertical: Array, trunk: Array) -> Array:
    """Return body frames whose front may yet be their back.

    The frontal plane is the best plane through the joints; the transverse plane's normal is the
    projection of up into it, which is what minimizes the angle between the two (paper, section 3).
    Where the plane lies level, the longer side of the smallest rectangle around the joints takes
    the place of up, with the head's end on top as far as the trunk is known.

    Parameters
    ----------
    joints : (n, n_joints, 3) m
        NaN is left out; at least three are needed.
    vertical : (n, 3)
        Unit vectors: up, or along a trunk that does not stand.
    trunk : (n, 3) m
        From the bottom of the trunk to its top; NaN where unknown.
    """
    centres, axes, _ = fit_planes(joints)
    normal = axes[:, :, 2]
    across = (normal * vertical).sum(axis=1, keepdims=True)
    y = vertical - across * normal
    level = np.abs(across[:, 0]) > _ACROSS
    if level.any():
        basis = axes[level][:, :, :2]
        flat = np.einsum("fjk,fki->fji", joints[level] - centres[level][:, None], basis)
        y[level] = np.einsum("fki,fi->fk", basis, smallest_rectangles(flat)[2])
    y = unit(y)
    y = np.where((y * trunk).sum(axis=1, keepdims=True) < 0, -y, y)
    return np.stack([normal, y, np.cross(normal, y)], axis=-1)


def face_the_same_way(frames: Array, sides: Array) -> Array:
    """Turn frames round so that all agree on their front.

    Parameters
    ----------
    frames : (n, 3, 3)
        ``root_from_body``, the front of each either way round.
    sides : (n, 3)
        A direction to the right in the same coordinates; NaN where no name tells.

    Returns
    -------
    (n, 3, 3)
        On the right side of the names where they tell; else on the side of the direction in which
        most of the fronts lie, whichever that is.
    """
    agree = (frames[:, :, 2] * sides).sum(axis=1)
    fronts = frames[:, :, 0]
    known = np.isfinite(fronts).all(axis=1)
    common = np.linalg.eigh(fronts[known].T @ fronts[known])[1][:, -1]
    told = np.isfinite(agree) & known
    if told.any():
        # the names settle the common front once; a frame they do not reach follows it
        common = common * np.sign(np.sum(np.sign(agree[told]) * (fronts[told] @ common)) or 1.0)
    agree = np.where(np.isfinite(agree), agree, fronts @ common)
    return np.where((agree < 0)[:, None, None], frames @ TURNED_ROUND, frames)
