"""Three angles about coordinate axes, exact at the singularity and continuous over time."""

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


def euler_angles(rotations: Array, order: str) -> Array:
    """Return angles with ``R = R_order[0](a) R_order[1](b) R_order[2](c)``.

    The third angle is read after the first two have been undone, so the product reproduces the
    rotation to rounding even where first and third axis coincide (b = ±90°).

    Parameters
    ----------
    rotations : (..., 3, 3)
        NaN stays NaN.
    order
        Three different letters of ``xyz``.

    Returns
    -------
    (..., 3) rad
        a and c in (−π, π], b in [−π/2, π/2].
    """
    i, j, k = ("xyz".index(letter) for letter in order)
    sign = 1.0 if (j - i) % 3 == 1 else -1.0  # an odd order mirrors every angle of an even one
    at = np.ix_([i, j, k], [i, j, k])
    r = rotations[..., at[0], at[1]]
    a = np.arctan2(-r[..., 1, 2], r[..., 2, 2])
    b = np.arctan2(r[..., 0, 2], np.hypot(r[..., 1, 2], r[..., 2, 2]))
    s, c = np.sin(a), np.cos(a)
    third = np.arctan2(
        c * r[..., 1, 0] + s * r[..., 2, 0],
        c * r[..., 1, 1] + s * r[..., 2, 1],
    )
    return sign * np.stack([a, b, third], axis=-1)


def swing_angles(rotations: Array) -> Array:
    """Return angles with ``R = R_y(a) R_x(b) R_y(c)``, b from 0 down to −π.

    As `euler_angles`, the third is read after the others have been undone. Where b is 0 the first
    and third axis coincide; a is then 0.

    Parameters
    ----------
    rotations : (..., 3, 3)
        NaN stays NaN.

    Returns
    -------
    (..., 3) rad
        a and c in (−π, π].
    """
    r = rotations
    aside = np.hypot(r[..., 0, 1], r[..., 2, 1])
    a = np.where(aside == 0, 0.0, np.arctan2(-r[..., 0, 1], -r[..., 2, 1]))
    b = -np.arctan2(aside, r[..., 1, 1])
    s, c = np.sin(a), np.cos(a)
    third = np.arctan2(
        c * r[..., 0, 2] - s * r[..., 2, 2],
        c * r[..., 0, 0] - s * r[..., 2, 0],
    )
    return np.stack([a, b, third], axis=-1)


def continuous_angles(angles: Array) -> Array:
    """Return equal rotations whose angles jump as little as they can from frame to frame.

    Each rotation has two triples, (a, b, c) and (a + π, π − b, c + π), each up to whole turns. The
    two lie a fixed step apart, so whether a frame changes sides shows in its own step alone.

    Parameters
    ----------
    angles : (n_frames, 3) rad
        As ``euler_angles`` gives them; no NaN.

    Returns
    -------
    (n_frames, 3) rad
        No longer bounded.
    """
    other = np.stack([angles[:, 0] + np.pi, np.pi - angles[:, 1], angles[:, 2] + np.pi], axis=1)
    stay = np.abs(_wrapped(angles[1:] - angles[:-1])).sum(axis=1)
    change = np.abs(_wrapped(other[1:] - angles[:-1])).sum(axis=1)
    on_other = np.concatenate([[False], np.logical_xor.accumulate(change < stay)])
    return np.unwrap(np.where(on_other[:, None], other, angles), axis=0)


def _wrapped(differences: Array) -> Array:
    turned: Array = (differences + np.pi) % (2 * np.pi) - np.pi
    return turned
