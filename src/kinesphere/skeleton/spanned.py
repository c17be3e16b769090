"""A limb whose markers are hidden, between two joints that its neighbours show."""

import numpy as np
from scipy.spatial.transform import Rotation, Slerp

from kinesphere.data import Array, Mask, PoseFlag
from kinesphere.geometry.rotations import rotation_between
from kinesphere.geometry.vectors import is_seen
from kinesphere.skeleton.body import Body
from kinesphere.skeleton.body_axes import unit
from kinesphere.skeleton.poses import Neighbour, Poses


def span(
    poses: Poses, body: Body, parent: Poses, centre: Array, beyond: Neighbour, longest: int
) -> None:
    """Place a limb between two joints in the frames that have no pose yet; in place.

    The joints tell where it is and where it points. Its twist is carried over: from the poses
    around the gap, seen from the parent, turned the least way onto the line between the joints. In
    gaps longer than ``longest`` frames that is a guess, and flagged so.

    Parameters
    ----------
    centre : (n_frames, 3) m
        The joint towards the parent, in the world.
    beyond
        The joint towards the next limb.
    """
    open_ = (poses.flags == PoseFlag.UNSEEN) & is_seen(centre) & is_seen(beyond.world)
    open_ &= np.isfinite(parent.rotations).all(axis=(1, 2))
    if body.centre is None or not open_.any():
        return
    carried, short = _carried(poses, parent, longest)
    at = np.flatnonzero(open_ & np.isfinite(carried).all(axis=(1, 2)))
    guess = parent.rotations[at] @ carried[at]
    here = unit(beyond.here - body.centre)
    towards = unit(beyond.world[at] - centre[at])
    placed = rotation_between(guess @ here, towards) @ guess
    poses.rotations[at] = placed
    poses.shifts[at] = centre[at] - placed @ body.centre
    poses.flags[at] = np.where(short[at], PoseFlag.FILLED, PoseFlag.TWIST_UNKNOWN)


def _carried(poses: Poses, parent: Poses, longest: int) -> tuple[Array, Mask]:
    """Return relative rotations bridged over every gap, and in which frames the gap is short."""
    relative = np.swapaxes(parent.rotations, 1, 2) @ poses.rotations
    known = np.flatnonzero(np.isfinite(relative).all(axis=(1, 2)))
    frames = np.arange(len(relative))
    if len(known) < 2:
        return relative, np.zeros(len(relative), dtype=bool)
    way = Slerp(known, Rotation.from_matrix(relative[known]))
    carried: Array = way(np.clip(frames, known[0], known[-1])).as_matrix()
    after = np.searchsorted(known, frames)
    inside = (after > 0) & (after < len(known))
    gap = known[np.minimum(after, len(known) - 1)] - known[np.maximum(after - 1, 0)] - 1
    return carried, np.asarray(inside & (gap <= longest))
