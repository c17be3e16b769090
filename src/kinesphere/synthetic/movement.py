"""Time courses of the angles: standing, calibration movements one after another, free motion."""

from dataclasses import dataclass

import numpy as np

from kinesphere.data import Array, Mask
from kinesphere.synthetic.actor import Actor
from kinesphere.synthetic.plan import BodyPlan, without_side

STANDING_S = 3.0
"""s of the default position at the start of a calibration."""
_REST_SHARE = 0.15  # of a calibration slot
_REACH = (0.8, 0.98)  # how much of its range a calibration movement uses
_ONE_SIDED_DEG = 15.0  # a range that starts above −15 deg is moved through to one side only
_BLEND_S = 1.5
_N_WAVES = 5
_TWIST = 3  # column of the twist among a joint's four angles


@dataclass(frozen=True, eq=False)
class Course:
    """What every joint does over time."""

    angles: Array
    """(n_frames, n_joints, 4) rad about axis 1, 2, 3, then twist; NaN where there is no axis."""
    moving: Mask
    """(n_frames, n_joints, 3) True while the limb makes its movement about that axis."""
    free: Array
    """(n_frames,) 0 while calibrating, 1 in free motion, smooth between."""
    walking: Array
    """(n_frames,) 1 while walking, 0 while standing or reaching about, smooth between."""


def angle_courses(
    rng: np.random.Generator,
    actor: Actor,
    times: Array,
    *,
    calibration_s: float,
    repetitions: int,
    sway_deg: float,
) -> Course:
    """Draw the time course of every angle, all within the actor's limits.

    Parameters
    ----------
    times : (n_frames,) s
    calibration_s
        s, from the start; what follows is free motion.
    repetitions
        How often each movement is made.
    sway_deg
        deg, standard deviation of the slow sway of every angle while calibrating.
    """
    low, high = actor.limits[..., 0], actor.limits[..., 1]
    angles = np.zeros((len(times), *low.shape))
    moving = np.zeros((len(times), len(low), 3), dtype=np.bool_)
    for slot in calibration_slots(actor.plan, calibration_s):
        for joint in slot.joints:
            _calibrate(rng, actor, slot, joint, times, repetitions, angles, moving)
    free = smooth_step((times - calibration_s) / _BLEND_S)
    early = free < 1
    sway = np.deg2rad(sway_deg) * smooth_noise(rng, times[early], low.shape, 0.1, 0.6)
    angles[early] += sway * (1 - free)[early, None, None]
    late = free > 0
    walking = np.zeros(len(times))
    if late.any():
        freely, share = _free_courses(rng, actor, times[late])
        walking[late] = share * free[late]
        angles[late] += freely * free[late, None, None]
        moving[late] = np.isfinite(low[:, :_TWIST])
    angles = np.clip(angles, low, high)  # NaN limits make NaN angles: an axis that is not there
    return Course(angles, moving, free, walking)


@dataclass(frozen=True)
class Slot:
    """One movement of the calibration and when it takes place."""

    joints: tuple[int, ...]
    axis: int
    start_s: float
    end_s: float


def calibration_slots(plan: BodyPlan, calibration_s: float) -> tuple[Slot, ...]:
    """Return which joints move about which axis when: axis 1, rest, axis 2, rest, next joint."""
    joints = {limb.joint: j for j, limb in enumerate(plan.limbs[1:])}
    groups: dict[str, list[int]] = {}
    for name, j in joints.items():
        kind = without_side(name)
        groups.setdefault(kind if kind in plan.together else name, []).append(j)
    turns = [
        (tuple(group), axis)
        for group in groups.values()
        for axis in range(len(plan.limbs[group[0] + 1].movements))
    ]
    standing = min(STANDING_S, calibration_s / 2)
    length = (calibration_s - standing) / max(len(turns), 1)
    return tuple(
        Slot(group, axis, standing + i * length, standing + (i + 1 - _REST_SHARE) * length)
        for i, (group, axis) in enumerate(turns)
    )


def _calibrate(
    rng: np.random.Generator,
    actor: Actor,
    slot: Slot,
    joint: int,
    times: Array,
    repetitions: int,
    angles: Array,
    moving: Mask,
) -> None:
    """Add a calibration movement to ``angles`` and mark it in ``moving``, both in place."""
    low, high = actor.limits[joint, slot.axis]
    ends = [high] if np.rad2deg(low) > -_ONE_SIDED_DEG else [high, low]
    goals = [0.0]
    for _ in range(repetitions):
        goals += [end * rng.uniform(*_REACH) for end in ends]
        goals += [0.0] if len(ends) == 1 else []
    goals += [] if goals[-1] == 0 else [0.0]
    now = (times >= slot.start_s) & (times < slot.end_s)
    # far strokes take longer, so that all have a like speed
    lengths = np.sqrt(np.abs(np.diff(goals)))
    knots = slot.start_s + (slot.end_s - slot.start_s) * np.r_[0, np.cumsum(lengths)] / sum(lengths)
    at = np.searchsorted(knots, times[now], side="right") - 1
    share = smooth_step((times[now] - knots[at]) / np.diff(knots)[at])
    angles[now, joint, slot.axis] += np.array(goals)[at] + share * np.diff(goals)[at]
    moving[now, joint, slot.axis] = True


def _free_courses(rng: np.random.Generator, actor: Actor, times: Array) -> tuple[Array, Array]:
    """Draw walking and reaching in turns, (n_frames, n_joints, 4) rad; (n_frames,) which it is."""
    low, high = actor.limits[..., 0], actor.limits[..., 1]
    waves = smooth_noise(rng, times, low.shape, 0.05, 0.45)
    reaching = (low + high) / 2 + (high - low) / 2 * np.sin(waves)
    gait = np.zeros((*low.shape, 3))
    for j, limb in enumerate(actor.plan.limbs[1:]):
        for k, movement in enumerate(limb.movements):
            gait[j, k] = movement.gait
    mean, amplitude, lead = np.deg2rad(gait[..., 0]), np.deg2rad(gait[..., 1]), gait[..., 2]
    cycles = rng.uniform(0.7, 1.0) * times + 0.3 * smooth_noise(rng, times, (), 0.02, 0.1)
    walking = mean + amplitude * np.sin(2 * np.pi * (cycles[:, None, None] + lead))
    share = 0.5 + 0.5 * np.sin(2 * smooth_noise(rng, times, (), 0.02, 0.08))
    weight = share[:, None, None]
    return np.asarray(weight * walking + (1 - weight) * reaching), np.asarray(share)


def smooth_step(x: Array) -> Array:
    """Return the course of a minimum-jerk movement, 0 before ``x = 0`` and 1 after ``x = 1``.

    Flash & Hogan (1985), J. Neurosci. 5(7), 1688–1703, equation 3.
    """
    x = np.clip(x, 0, 1)
    return np.asarray(x**3 * (10 - 15 * x + 6 * x**2))


def smooth_noise(
    rng: np.random.Generator, times: Array, shape: tuple[int, ...], low_hz: float, high_hz: float
) -> Array:
    """Draw noise of unit variance whose band is limited, (n_frames, *shape), as sums of sines."""
    noise = np.zeros((len(times), *shape))
    clock = times.reshape(-1, *(1 for _ in shape))
    for _ in range(_N_WAVES):
        frequency = rng.uniform(low_hz, high_hz, shape)
        phase = rng.uniform(0, 2 * np.pi, shape)
        noise += np.sin(2 * np.pi * frequency * clock + phase)
    return np.asarray(noise * np.sqrt(2 / _N_WAVES))
