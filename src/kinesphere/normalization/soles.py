"""How a foot's line lies to its sole, from when the foot rests flat on the floor."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from kinesphere.data import Array, Mask, PoseFlag
from kinesphere.geometry.poses import place
from kinesphere.geometry.vectors import lengths
from kinesphere.normalization.samples import UP, Samples

STEEP = np.deg2rad(45.0)
"""rad of pitch from which a foot has no lateral axis to be turned about."""
_SHARE = 0.1  # of the samples, the slowest, in which a foot rests if it ever does
_SLOW = 0.08  # spans of the body a second from which on a foot does not rest: 0.15 m/s
_LOW = 0.015  # spans of the body above the toes' lowest level within which they are on the floor
_LOWEST = 0.05  # quantile of the toes' height that is their lowest level
_SCATTER = np.deg2rad(5.0)
"""rad of the pitch at rest, in the mean over frames, from which on it tells nothing."""
_STEEPER = np.deg2rad(15.0)
"""rad from which on a line runs down too steeply to be a sole's: with a heel it lies at 0 to 9° on
a flat foot, and so markers about the middle of a foot may lie that are all it has, to 13°."""
_LEVEL = 0.05  # spans of the body above its lowest end within which an end stands where that does
_HANGS = 0.5  # least share of down in a shank whose foot stands: knees on the floor lay it level


@dataclass(frozen=True)
class Rest:
    """A foot at rest on the floor."""

    pitch: float
    """rad, of its line against the horizontal, up is positive: what separates line and sole."""
    scatter: float
    """rad, mean absolute deviation from it."""
    n_frames: int

    @property
    def tells(self) -> bool:
        """Whether the foot rests flat somewhere, and alike wherever it rests."""
        return self.n_frames > 0 and self.scatter <= _SCATTER and abs(self.pitch) <= STEEP


def find_rest(samples: Samples, limb: int, line: Array | None = None) -> Rest:
    """Return how the line of a foot lies where the foot stands still on the floor.

    Of the samples of the whole recording those in which both its ends are slow (the slowest tenth)
    and its toes low; its shank must hang, as it does not of who lies, kneels or stands on the head.

    Parameters
    ----------
    samples
    limb
        The foot's index.
    line : (3,), optional
        Unit vector in the foot's frame that stands for its own line.
    """
    own = samples.anatomy.directions[limb]
    along = samples.rotations[:, limb] @ (own if line is None else line)
    pitch = np.arcsin(np.clip(along @ UP, -1.0, 1.0))
    toes, speed = _toes(samples, limb)
    height = toes @ UP
    usable = np.isfinite(pitch) & np.isfinite(height) & np.isfinite(speed) & _stands(samples, limb)
    if not usable.any():
        return Rest(np.nan, np.nan, 0)
    span = samples.anatomy.span
    slow = min(float(np.quantile(speed[usable], _SHARE)), _SLOW * span)
    low = float(np.quantile(height[usable], _LOWEST)) + _LOW * span
    rests = pitch[usable & (speed <= slow) & (height <= low)]
    if not len(rests):
        return Rest(np.nan, np.nan, 0)
    middle = float(np.median(rests))
    return Rest(middle, float(np.abs(rests - middle).mean()), len(rests))


def stands(samples: Samples, limb: int) -> bool:
    """Return whether the end of a chain is one that its body stands on, whatever it is called.

    It comes to rest, low and under a limb that hangs, as low as any other end of the body. Of a
    single chain nothing tells: an arm or a tail hangs lowest of itself.

    Parameters
    ----------
    samples
    limb
        The index of the last limb of a chain.
    """
    anatomy = samples.anatomy
    carried = [len(joints) for joints in anatomy.distal_joints]
    if max(carried) < 2 or find_rest(samples, limb).n_frames == 0:
        return False
    ends = [i for i, n in enumerate(carried) if n == 0]
    levels = [_level(samples, i) for i in ends]
    return bool(_level(samples, limb) <= np.nanmin(levels) + _LEVEL * anatomy.span)


def levelling(samples: Samples, bare: Sequence[int], heeled: Sequence[int]) -> dict[int, float]:
    """Return at which pitch the lines of feet without a heel are where they should be level, rad.

    Against the sole, or against the line of the other foot if that has a heel: two feet of one
    person have one zero, so a foot is turned as the other one lies where both rest flat. All such
    feet or none: none where one never rests, or where they run down by less than 15° in the mean.

    Parameters
    ----------
    samples
    bare, heeled
        Indices of feet without a marker behind the ankle, and with one.
    """
    others = [find_rest(samples, limb) for limb in heeled] if bare else []
    if not all(rest.tells for rest in others):
        return {}
    zero = float(np.mean([rest.pitch for rest in others])) if others else 0.0
    rests = {limb: find_rest(samples, limb) for limb in bare}
    if not rests or not all(rest.tells for rest in rests.values()):
        return {}
    pitches = {limb: rest.pitch - zero for limb, rest in rests.items()}
    return pitches if np.mean(list(pitches.values())) < -_STEEPER else {}


def turned_by(points: Array, pitch: float) -> Array:
    """Return a foot's direction with this pitch of its line against the sole taken out.

    Turned about the foot's lateral axis, square to its line and to the vertical: a heel raised in
    the default position stays raised.

    Parameters
    ----------
    points : (3,)
        Along the line, in the body frame.
    pitch
        rad, of the line where the sole is level.
    """
    ahead = points * [1.0, 0.0, 1.0]
    length = float(np.linalg.norm(ahead))
    if length < np.cos(STEEP):
        return points
    own = np.arctan2(points[1], length) - pitch
    return np.asarray(np.cos(own) * ahead / length + np.sin(own) * UP)


def _stands(samples: Samples, limb: int) -> Mask:
    """Return the samples, (n,), in which a foot was seen under a shank, or an upright body."""
    flags = samples.motion.flags[samples.frames, limb]
    shank = samples.directions[:, samples.anatomy.skeleton.parents[limb]] @ -UP
    upright = (samples.vertical == UP).all(axis=1)
    under = np.where(np.isfinite(shank), shank >= _HANGS, upright)
    return np.asarray(under & (flags != PoseFlag.FILLED))


def _toes(samples: Samples, limb: int) -> tuple[Array, Array]:
    """Return where a foot's toe end is, (n, 3) m, and the speed of its faster end, (n,) m/s.

    Of both: toes stand still while the heel is lifted. 0 where a single frame tells none.
    """
    anatomy, (before, after) = samples.anatomy, samples.window
    seconds = (after - before) / samples.motion.rate
    speed = np.zeros(len(samples.frames))
    for end in (anatomy.proximal_ends[limb], anatomy.distal_ends[limb]):
        with np.errstate(invalid="ignore", divide="ignore"):
            way = _carried(samples, limb, end, after) - _carried(samples, limb, end, before)
            moved = lengths(way) / seconds
        speed = np.maximum(speed, np.where(seconds > 0, moved, 0.0))
    toes = _carried(samples, limb, anatomy.distal_ends[limb], samples.frames)
    return toes, speed


def _level(samples: Samples, limb: int) -> float:
    """Return how low a limb's far end is at its lowest, m; NaN if it is never seen."""
    anatomy = samples.anatomy
    heights = _carried(samples, limb, anatomy.distal_ends[limb], samples.frames) @ UP
    heights = heights[np.isfinite(heights)]
    return float(np.quantile(heights, _LOWEST)) if len(heights) else np.nan


def _carried(samples: Samples, limb: int, point: Array, frames: NDArray[np.intp]) -> Array:
    """Return a point of a limb in the world, (n, 3) m."""
    motion = samples.motion
    return place(motion.rotations[frames, limb], motion.origins[frames, limb], point)
