"""How a foot's line lies to its sole, from when the foot rests flat on the floor."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from kinesphere.data import Array, Mask, PoseFlag
from kinesphere.geometry.vectors import lengths
from kinesphere.normalization.limb_frames import STEEP
from kinesphere.normalization.samples import UP, Samples

_SHARE = 0.1  # of the samples, the slowest, in which a foot rests if it ever does
_SLOW = 0.08  # spans of the body a second from which on a foot does not rest: 0.15 m/s
_LOW = 0.015  # spans of the body above the toes' lowest level within which they are on the floor
_LOWEST = 0.05  # quantile of the toes' height that is their lowest level
_SCATTER = np.deg2rad(5.0)
"""rad of the pitch at rest, in the mean over frames, from which on it tells nothing."""
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


def find_rest(samples: Samples, limb: int) -> Rest:
    """Return how the line of a foot lies where the foot stands still on the floor.

    Of the samples of the whole recording those in which both its ends are slow (the slowest tenth)
    and its toes low; its shank must hang, as it does not of who lies, kneels or stands on the head.

    Parameters
    ----------
    samples
    limb
        The foot's index.
    """
    pitch = np.arcsin(np.clip(samples.directions[:, limb] @ UP, -1.0, 1.0))
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


def _carried(samples: Samples, limb: int, point: Array, frames: NDArray[np.intp]) -> Array:
    """Return a point of a limb in the world, (n, 3) m."""
    motion = samples.motion
    return np.asarray(motion.rotations[frames, limb] @ point + motion.origins[frames, limb])
