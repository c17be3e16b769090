"""The rest orientation: where all angles of a joint are zero (paper section 4.3)."""

import numpy as np

from kinesphere.data import Array, Mask
from kinesphere.geometry.rotations import mean_rotation, rotation_about, rotation_between
from kinesphere.parameterization.settings import RestSettings

FEWEST = 5  # samples that make a mean


def rest_target(
    axes: Array, heights: Array, gravity: Array, long_axis: Array | None
) -> tuple[Array, bool]:
    """Return the limb direction that belongs to rest.

    With two axes it is where the two movements' circles meet on the joint sphere, on the side
    of the samples' centre of gravity. The paper intersects planes through the joint; those are
    these circles where the limb is perpendicular to its axes. With one axis it is on the
    median cone, at the azimuth of the centre of gravity or of ``long_axis``.

    Parameters
    ----------
    axes : (n_axes, 3)
    heights : (n_axes,)
        Cosine of the cone about each axis; NaN counts as 0, a great circle.
    gravity : (3,)
        Centre of gravity of the samples.
    long_axis : (3,), optional
        Direction of the limb when aligned with its parent; the zero of a one-axis joint.

    Returns
    -------
    direction : (3,)
        Unit vector.
    unique
        False where the direction had to be taken from the centre of gravity alone.
    """
    heights = np.nan_to_num(heights)
    if len(axes) == 1:
        axis = axes[0]
        sideways = (gravity if long_axis is None else long_axis) @ (
            np.eye(3) - np.outer(axis, axis)
        )
        if (length := float(np.linalg.norm(sideways))) < 1e-3:
            return gravity / max(float(np.linalg.norm(gravity)), 1e-12), False
        h = float(np.clip(heights[0], -1, 1))
        return h * axis + np.sqrt(1 - h * h) * sideways / length, True
    a1, a2 = axes[-2:]
    k = float(a1 @ a2)
    normal = np.cross(a1, a2)
    nu = float(normal @ normal)
    if nu < 1e-6:
        return gravity / max(float(np.linalg.norm(gravity)), 1e-12), False
    h1, h2 = heights[-2:]
    alpha, beta = (h1 - k * h2) / nu, (h2 - k * h1) / nu
    gamma = np.sqrt(max(0.0, (1 - alpha**2 - beta**2 - 2 * alpha * beta * k) / nu))
    if gravity @ normal < 0:
        gamma = -gamma
    x = alpha * a1 + beta * a2 + gamma * normal
    return np.asarray(x / np.linalg.norm(x)), True


def robust_rest(
    rotations: Array, positions: Array, slow: Mask, axes: Array, target: Array, s: RestSettings
) -> Array:
    """Return the mean orientation of slow samples around the target, (3, 3).

    Moving samples serve where fewer than five slow ones are near; where even those are missing,
    the nearest sample is turned onto the target, about the axis for a one-axis joint.

    Parameters
    ----------
    rotations, positions : (n, 3, 3), (n, 3)
        NaN where unseen.
    slow : (n,)
    axes : (n_axes, 3)
    target : (3,)
    s
        Radius of the neighbourhood.
    """
    apart = np.arccos(np.clip(positions @ target, -1, 1))
    near = np.asarray(apart <= np.deg2rad(s.radius))
    for chosen in (near & slow, near):
        if chosen.sum() >= FEWEST:
            return mean_rotation(rotations[chosen])
    nearest = int(np.nanargmin(apart))
    rest = rotations[nearest]
    if len(axes) == 1:
        axis, p = axes[0], positions[nearest]
        angle = np.arctan2(np.cross(p, target) @ axis, p @ target - (p @ axis) * (target @ axis))
        rest = rotation_about(axis, angle) @ rest
        turned = rotation_about(axis, angle) @ p
        return np.asarray(rotation_between(turned, target) @ rest)
    return np.asarray(rotation_between(positions[nearest], target) @ rest)


def paper_rest(rotations: Array, positions: Array, target: Array) -> Array:
    """Return the orientation of the one sample nearest to the target, (3, 3), as the paper does."""
    return np.asarray(rotations[int(np.nanargmax(positions @ target))])
