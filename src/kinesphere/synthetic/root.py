"""Where the root goes: the way over the floor, the tilt, and the height that feet ask for."""

import numpy as np

from kinesphere.data import Array, Motion
from kinesphere.geometry.rotations import rotation_about
from kinesphere.synthetic.actor import Actor
from kinesphere.synthetic.movement import Course, smooth_noise

_PACE = 0.8  # m/s, of walking
_ROAM_M = 1.5  # radius of the way walked in free motion
_SWAY_M = 0.004  # standard deviation of the root's sway while calibrating
_FLOOR_M = 0.01  # over this height the support passes smoothly from one foot to the other


def way_over_floor(rng: np.random.Generator, course: Course, times: Array) -> tuple[Array, Array]:
    """Draw where the actor looks and its way over the floor.

    It walks the way it looks, along a bent loop that leads back to its start, so that it stays in
    the room however long it walks.

    Returns
    -------
    heading : (n_frames,) rad about y
    way : (n_frames, 2) m along x and z, from where it stood
    """
    steps = np.diff(times, prepend=times[0]) * _PACE * course.walking
    u = np.cumsum(steps) / _ROAM_M
    side, start, bend, phase = rng.uniform([-1, -np.pi, 0.2, -np.pi], [1, np.pi, 0.6, np.pi])
    # a full turn and two waves: the integral of the direction over 2π is zero
    heading = start + np.sign(side) * (u + bend * np.sin(2 * u + phase))
    way = np.cumsum(steps[:, None] * np.stack([np.cos(heading), -np.sin(heading)], 1), axis=0)
    return np.asarray(heading), np.asarray(way)


def root_rotations(rng: np.random.Generator, heading: Array, course: Course, times: Array) -> Array:
    """Draw a tilt to the heading that is sway while calibrating and play in free motion."""
    tilt = np.deg2rad(0.2 + 5 * course.free)[:, None] * smooth_noise(rng, times, (2,), 0.1, 0.4)
    x, y, z = np.eye(3)
    return np.asarray(
        rotation_about(y, heading) @ rotation_about(x, tilt[:, 0]) @ rotation_about(z, tilt[:, 1])
    )


def root_positions(
    rng: np.random.Generator,
    way: Array,
    actor: Actor,
    hovering: Motion,
    course: Course,
    times: Array,
) -> Array:
    """Let the root follow its way, at the height that keeps the lowest foot on the floor."""
    positions = np.empty((len(times), 3))
    sway = _SWAY_M * smooth_noise(rng, times, (2,), 0.1, 0.5)
    positions[:, [0, 2]] = rng.uniform(-1, 1, 2) + way + sway
    feet = [hovering.skeleton.limb_names.index(name) for name in actor.plan.stands_on]
    if not feet:
        positions[:, 1] = 1.0 + 0.2 * course.free * smooth_noise(rng, times, (), 0.05, 0.2)
        return positions
    ends = np.array(
        [limb.length / 2 * limb.long_axis for limb in (hovering.skeleton.limbs[i] for i in feet)]
    )
    heights = (
        hovering.origins[:, feet, 1] + ((hovering.rotations[:, feet] @ ends[..., None])[..., 1, 0])
    )
    deep = heights.min(axis=1)
    softly = np.exp(-(heights - deep[:, None]) / _FLOOR_M).sum(axis=1)
    lowest = deep - _FLOOR_M * np.log(softly / len(feet))
    positions[:, 1] = actor.plan.sole * actor.size - lowest
    return positions
