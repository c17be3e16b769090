"""The time offset between frames: by how far aligned limbs lag behind their own turning."""

from dataclasses import replace

import numpy as np

from kinesphere.comparison.alignment import fit_limb, fit_world
from kinesphere.comparison.offset import TimeOffset
from kinesphere.comparison.sides import Side, sampled
from kinesphere.comparison.timing import find_offset, overlap_of
from kinesphere.data import Array
from kinesphere.errors import BadSetting, DegenerateMotion
from kinesphere.geometry.rotations import rotation_log
from kinesphere.geometry.vectors import lengths

_ROUNDS = 4
_SETTLED = 1e-3  # of a frame
_WHOLE = 0.05  # of a frame: an offset this near to whole frames is one, and nothing is interpolated
_MOST_FRAMES = 3000
_FAR = np.deg2rad(30.0)  # apart: a leap, not a lag
_FARTHEST = 1.0  # frame that one round may move


def time_offset(
    first: Side, second: Side, names: list[str], given: float | None, *, shared: bool
) -> TimeOffset:
    """Return the offset: as given, else 0 of what shares a clock, else as it is found.

    Parameters
    ----------
    names
        Joints that both have.
    given
        s, or None.
    shared
        Whether frame k of one is frame k of the other.

    Raises
    ------
    BadSetting
        If the given one is not finite.
    DegenerateMotion
        As `find_offset` does.
    """
    if given is not None:
        if not np.isfinite(given):
            raise BadSetting(f"offset is {given} s; a finite number of seconds was expected")
        return TimeOffset(float(given), np.nan, overlap_of(first, second, given), given=True)
    if shared:
        return TimeOffset(0.0, np.nan, overlap_of(first, second, 0.0), given=False, shared=True)
    return refined(find_offset(first, second), first, second, names)


def refined(offset: TimeOffset, first: Side, second: Side, names: list[str]) -> TimeOffset:
    """Return the offset at which limbs neither lag nor lead, to hundredths of a frame.

    Where one side is read a moment too early, each of its limbs is turned back by that moment's
    share of the angular velocity. The moment is fitted to all limbs at all times by least squares
    (Gauss-Newton), worlds and limb frames being aligned anew each round. Noise of the velocities
    does not pull: they come from the frames before and after, never from the one compared.

    Parameters
    ----------
    names
        Joints that both have.
    """
    if not np.isfinite(offset.correlation):
        return offset
    frame = 1.0 / min(first.motion.rate, second.motion.rate)
    seconds = offset.seconds
    for _ in range(_ROUNDS):
        lag = _lag(first, second, seconds, names)
        if lag is None:
            return offset
        seconds += float(np.clip(lag, -_FARTHEST * frame, _FARTHEST * frame))
        if abs(lag) < _SETTLED * frame:
            break
    if abs(seconds - offset.seconds) > 2 * frame:  # something else than a lag was fitted
        return offset
    fastest = max(first.motion.rate, second.motion.rate)
    if abs(seconds * fastest - round(seconds * fastest)) < _WHOLE:
        seconds = round(seconds * fastest) / fastest
    return replace(offset, seconds=seconds, overlap=overlap_of(first, second, seconds))


def common_times(first: Side, second: Side, offset: float) -> Array:
    """Return the frames of the slower side that the other covers, (n,) s on the first's clock.

    Raises
    ------
    DegenerateMotion
        If there is none.
    """
    slow, late = (first, 0.0) if first.motion.rate <= second.motion.rate else (second, offset)
    times = slow.motion.times - late
    slack = 1e-6 / max(first.motion.rate, second.motion.rate)
    inside = (times >= max(0.0, -offset) - slack) & (
        times <= min(first.duration, second.duration - offset) + slack
    )
    if not inside.any():
        raise DegenerateMotion(
            f"with an offset of {offset:+.3f} s the two have no moment in common: the first lasts "
            f"{first.duration:.3f} s, the second {second.duration:.3f} s"
        )
    return times[inside]


def joint_centres(side: Side, names: list[str]) -> Array:
    """Return the centres of some joints in the world, (n_frames, n_joints, 3) m."""
    columns = [side.motion.skeleton.joint_names.index(name) for name in names]
    return side.motion.joint_centres()[:, columns]


def _lag(first: Side, second: Side, offset: float, names: list[str]) -> float | None:
    """Return by how many s the offset is too small; None where nothing tells."""
    times = common_times(first, second, offset)
    if len(times) < 3:
        return None
    step = 1.0 / min(first.motion.rate, second.motion.rate)
    shown = slice(1, -1, max(1, len(times) // _MOST_FRAMES))
    inner = times[shown]
    a, b = sampled(first, inner), sampled(second, inner + offset)
    before, after = sampled(first, inner - step), sampled(first, inner + step)
    world = fit_world(joint_centres(a, names), joint_centres(b, names))
    moved = b.motion.rotations if world is None else world.rotation @ b.motion.rotations
    with_lag = of_turning = 0.0
    for i, name in enumerate(first.skeleton.limb_names):
        if name not in second.skeleton.limb_names:
            continue
        theirs = moved[:, second.skeleton.limb_names.index(name)]
        mine = a.motion.rotations[:, i]
        fit = fit_limb(name, name, mine, theirs)
        if fit is None:
            continue
        apart = rotation_log(np.swapaxes(mine, -1, -2) @ theirs @ fit.rotation)
        turn = np.swapaxes(before.motion.rotations[:, i], -1, -2) @ after.motion.rotations[:, i]
        velocity = rotation_log(turn) / (2 * step)
        with np.errstate(invalid="ignore"):
            known = (lengths(apart) < _FAR) & np.isfinite(velocity).all(axis=1)
        with_lag -= float((velocity[known] * apart[known]).sum())
        of_turning += float((velocity[known] ** 2).sum())
    return with_lag / of_turning if of_turning > 0 else None
