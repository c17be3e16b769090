"""What is compared: a motion, its skeleton, and its parameters where there are any."""

from dataclasses import dataclass, replace

import numpy as np

from kinesphere.data import (
    Array,
    History,
    Motion,
    Parameters,
    PoseFlag,
    Skeleton,
    Solution,
    motion_from_parameters,
)
from kinesphere.errors import BadRecording
from kinesphere.geometry.rotations import rotation_exp, rotation_log

_EXACT = 1e-6  # of a frame: nearer than this no interpolation is needed


@dataclass(frozen=True, eq=False)
class Side:
    """One of the two."""

    motion: Motion
    skeleton: Skeleton
    """The motion's, with movement axes where they are known."""
    parameters: Parameters | None
    history: History = ()

    @property
    def duration(self) -> float:
        """Time in s from the first frame to the last."""
        return (self.motion.n_frames - 1) / self.motion.rate


def side_from(found: Solution | Motion | Parameters) -> Side:
    """Return what can be compared of a solution, a motion, or parameters.

    Raises
    ------
    BadRecording
        If it holds no frame or no limb has a pose, or is none of the three.
    """
    if isinstance(found, Solution):
        side = Side(found.motion, found.skeleton, found.parameters, found.history)
    elif isinstance(found, Parameters):
        side = Side(motion_from_parameters(found), found.skeleton, found, found.history)
    elif isinstance(found, Motion):
        side = Side(found, found.skeleton, None, found.history)
    else:
        raise BadRecording(
            f"a {type(found).__name__} cannot be compared; a solution, a motion or parameters can"
        )
    if not np.isfinite(side.motion.rotations).any():
        raise BadRecording("no limb has a pose in any frame: nothing to compare")
    return side


def unknown_twists(side: Side) -> tuple[str, ...]:
    """Return the limbs whose twist is known in less than half of the frames they are seen in."""
    seen = side.motion.seen
    blind = (side.motion.flags == PoseFlag.TWIST_UNKNOWN).sum(axis=0) > seen.sum(axis=0) / 2
    return tuple(name for name, b in zip(side.motion.skeleton.limb_names, blind, strict=True) if b)


def told_rotations(side: Side) -> Array:
    """Return the limbs' orientations, (n_frames, n_limbs, 3, 3), without twists nobody knows.

    Limbs whose twist is hardly ever known keep what they have: their direction is still true.
    """
    motion = side.motion
    never = np.isin(motion.skeleton.limb_names, unknown_twists(side))
    blind = (motion.flags == PoseFlag.TWIST_UNKNOWN) & ~never
    if not blind.any():
        return motion.rotations
    rotations = np.array(motion.rotations)
    rotations[blind] = np.nan
    return rotations


def relative(side: Side, parent: str, child: str) -> Array:
    """Return ``parent_from_child`` of two limbs, (n_frames, 3, 3)."""
    names, rotations = side.skeleton.limb_names, side.motion.rotations
    upper, lower = rotations[:, names.index(parent)], rotations[:, names.index(child)]
    return np.asarray(np.swapaxes(upper, -1, -2) @ lower)


def sampled(side: Side, times: Array) -> Side:
    """Return a side at other times: rotations on the shortest way, points on a line between frames.

    A time between two frames is seen only where both are.

    Parameters
    ----------
    times : (n,) s
        Within the side's own duration.
    """
    motion, parameters = side.motion, side.parameters
    at = times * motion.rate
    whole = np.clip(np.round(at), 0, motion.n_frames - 1).astype(int)
    if np.abs(at - whole).max(initial=0.0) < _EXACT:
        low, high, share = whole, whole, np.zeros(len(times))
    else:
        low = np.clip(np.floor(at), 0, max(motion.n_frames - 2, 0)).astype(int)
        high, share = np.minimum(low + 1, motion.n_frames - 1), at - low
    # a copy of a frame must not depend on its neighbour, which may be unseen
    low, high = np.where(share > 1 - _EXACT, high, low), np.where(share < _EXACT, low, high)
    share = np.where(low == high, 0.0, share)
    nearest = np.where(share > 0.5, high, low)
    rate = 1.0 if len(times) < 2 else (len(times) - 1) / float(times[-1] - times[0])
    moved = replace(
        motion,
        rotations=_turned(told_rotations(side), low, high, share),
        origins=_moved(motion.origins, low, high, share),
        residuals=motion.residuals[nearest],
        flags=motion.flags[nearest],
        rate=rate,
    )
    if parameters is not None:
        angles = np.concatenate([parameters.angles, parameters.twists[..., None]], axis=2)
        angles = _moved_angles(angles, low, high, share)
        parameters = replace(
            parameters,
            root_positions=_moved(parameters.root_positions, low, high, share),
            root_rotations=_turned(parameters.root_rotations, low, high, share),
            angles=angles[..., :3],
            twists=angles[..., 3],
            residuals=parameters.residuals[nearest],
            flags=parameters.flags[nearest],
            moving=parameters.moving[nearest],
            rate=rate,
        )
    return replace(side, motion=moved, parameters=parameters)


def _share(share: Array, like: Array) -> Array:
    return share.reshape(-1, *[1] * (like.ndim - 1))


def _moved(values: Array, low: Array, high: Array, share: Array) -> Array:
    a, b = values[low], values[high]
    return np.asarray(a + _share(share, a) * (b - a))


def _moved_angles(values: Array, low: Array, high: Array, share: Array) -> Array:
    a, b = values[low], values[high]
    return np.asarray(a + _share(share, a) * wrapped(b - a))


def _turned(rotations: Array, low: Array, high: Array, share: Array) -> Array:
    a = rotations[low]
    if not share.any():
        return np.asarray(a)
    way = rotation_log(np.swapaxes(a, -1, -2) @ rotations[high])
    return np.asarray(a @ rotation_exp(_share(share, way) * way))


def wrapped(angles: Array) -> Array:
    """Return angles in [−π, π)."""
    return np.asarray((angles + np.pi) % (2 * np.pi) - np.pi)
