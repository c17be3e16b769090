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
        False where nothing tells a direction: with one axis some azimuth of the cone serves, as
        when a limb turns on and on; with two that are one, the centre of gravity.
    """
    heights = np.nan_to_num(heights)
    if len(axes) == 1:
        axis, h = axes[0], float(np.clip(heights[0], -1, 1))
        told = gravity if long_axis is None else long_axis
        sideways = told - (told @ axis) * axis
        unique = float(np.linalg.norm(sideways)) >= 1e-3
        if not unique:  # any azimuth is as good, but the rest must be on the cone
            sideways = np.eye(3)[np.abs(axis).argmin()]
            sideways -= (sideways @ axis) * axis
        return h * axis + np.sqrt(1 - h * h) * sideways / np.linalg.norm(sideways), unique
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

    A one-axis joint's samples are first turned about its axis to the target's azimuth, so that a
    knee never seen straight still has a straight zero. Moving samples serve where fewer than
    five slow ones are near; where even those are missing, the nearest is turned onto the target.

    Parameters
    ----------
    rotations, positions : (n, 3, 3), (n, 3)
        Without NaN, at least one.
    slow : (n,)
    axes : (n_axes, 3)
    target : (3,)
    s
        Radius of the neighbourhood.
    """
    apart = _angle_between(positions, target)
    if len(axes) == 1:
        return _one_axis_rest(rotations, positions, slow, axes[0], target, s)
    near = np.asarray(apart <= np.deg2rad(s.radius))
    for chosen in (near & slow, near):
        if chosen.sum() >= FEWEST:
            return mean_rotation(rotations[chosen])
    nearest = int(apart.argmin())
    return np.asarray(rotation_between(positions[nearest], target) @ rotations[nearest])


def _one_axis_rest(
    rotations: Array, positions: Array, slow: Mask, axis: Array, target: Array, s: RestSettings
) -> Array:
    """Turn the samples nearest in azimuth about the axis, average them, tilt onto the cone."""
    azimuth = np.arctan2(
        np.cross(positions, target) @ axis,
        positions @ target - (positions @ axis) * (target @ axis),
    )
    usable = slow if slow.sum() >= FEWEST else np.ones(len(positions), dtype=bool)
    nearest = np.abs(azimuth[usable]).min()
    chosen = usable & (np.abs(azimuth) <= nearest + np.deg2rad(s.radius))
    turned = rotation_about(axis, azimuth[chosen])
    rest = mean_rotation(turned @ rotations[chosen])
    directions = (turned @ positions[chosen][..., None])[..., 0].mean(axis=0)
    direction = directions / np.linalg.norm(directions)
    return np.asarray(rotation_between(direction, target) @ rest)


def _angle_between(points: Array, direction: Array) -> Array:
    """Return the angles to a direction in rad, (n, 3) → (n,)."""
    across = np.linalg.norm(np.cross(points, direction), axis=-1)
    return np.asarray(np.arctan2(across, points @ direction))


def paper_rest(rotations: Array, positions: Array, target: Array) -> Array:
    """Return the orientation of the one sample nearest to the target, (3, 3), as the paper does."""
    return np.asarray(rotations[int(np.argmax(positions @ target))])
