"""The pose of a limb in every frame, from whatever of it is seen."""

from typing import NamedTuple

import numpy as np
from scipy.spatial.transform import Rotation, Slerp

from kinesphere.data import Array, Codes, Mask, PoseFlag
from kinesphere.geometry.poses import place
from kinesphere.geometry.rigid import fit_rigid, tells_pose
from kinesphere.geometry.rotations import rotation_between
from kinesphere.geometry.vectors import is_seen
from kinesphere.skeleton.body import NOISE, Body
from kinesphere.skeleton.body_axes import unit

RELEASE = 0.75
"""A borrowed twist is given back when the flexion falls below this share of where it was taken."""

BLOCK = 16384
"""Frames fitted at a time."""


class Poses(NamedTuple):
    """A limb's poses; NaN and UNSEEN where nothing is known."""

    rotations: Array
    """(n_frames, 3, 3) ``world_from_limb``."""
    shifts: Array
    """(n_frames, 3) m."""
    flags: Codes
    """(n_frames,) PoseFlag."""

    def carry(self, point: Array) -> Array:
        """Return a point of the limb in the world, (3,) m → (n_frames, 3) m."""
        return place(self.rotations, self.shifts, point)


class Neighbour(NamedTuple):
    """A point of the limb that another limb knows: a joint centre."""

    here: Array
    """(3,) m in the limb."""
    world: Array
    """(n_frames, 3) m; NaN where the other limb is unseen."""
    noise: float
    """m."""


def no_poses(n_frames: int) -> Poses:
    """Return poses of a limb never seen."""
    return Poses(
        np.full((n_frames, 3, 3), np.nan),
        np.full((n_frames, 3), np.nan),
        np.full(n_frames, PoseFlag.UNSEEN, dtype=np.uint8),
    )


def fit_poses(
    body: Body,
    own: Array,
    joints: tuple[Neighbour, ...],
    min_spread: float,
    poses: Poses | None = None,
) -> Poses:
    """Fit the limb's pose to its markers and joint centres, where they leave no freedom.

    Block by block: what it needs besides its input and output does not grow with the recording.

    Parameters
    ----------
    body
        Its markers and centre; the twist is not open.
    own : (n_frames, n_markers, 3) m
        Its markers in the world.
    joints
        Joint centres that take part.
    min_spread
        m, as `kinesphere.geometry.rigid.fit_rigid` takes it.
    poses
        To be completed in place, where UNSEEN; new ones otherwise.
    """
    poses = no_poses(len(own)) if poses is None else poses
    local = np.vstack([body.shape, *(p.here for p in joints)])
    weights = 1 / (np.array([*body.noise, *(p.noise for p in joints)]) ** 2 + NOISE**2)
    for start in range(0, len(own), BLOCK):
        block = slice(start, start + BLOCK)
        open_ = poses.flags[block] == PoseFlag.UNSEEN
        if not open_.any():
            continue
        at = block if open_.all() else start + np.flatnonzero(open_)
        markers = own[at]
        world = np.concatenate([markers, *(p.world[at, None] for p in joints)], axis=1)
        into = poses.rotations[at], poses.shifts[at]
        fit = fit_rigid(local, world, weights, min_spread=min_spread, into=into)
        if not isinstance(at, slice):  # a block as a whole is written where it is
            poses.rotations[at], poses.shifts[at] = fit.rotations, fit.shifts
        alone = tells_pose(body.shape, is_seen(markers), min_spread=min_spread)
        flags = np.where(alone, PoseFlag.MEASURED, PoseFlag.JOINT_AIDED)
        poses.flags[at] = np.where(fit.fitted, flags, PoseFlag.UNSEEN)
    return poses


def aim(
    body: Body,
    own: Array,
    centre: Array,
    parent: Poses,
    normal: Array,
    flexed: float,
    poses: Poses,
) -> None:
    """Aim a limb along its joint and markers, in the frames that have no pose yet; in place.

    The twist is the least rotation from where the limb usually sits on its parent, unless the next
    limb lends its own: then ``body.borrow`` is turned onto the normal of the plane of both.

    Parameters
    ----------
    own : (n_frames, n_markers, 3) m
    centre : (n_frames, 3) m
        The joint towards the parent, in the world.
    parent
        Poses of the parent.
    normal : (n_frames, 3)
        ``cross`` of the directions of this limb and the next, in the world; NaN where unknown.
    flexed
        rad, angle between them from which the twist is borrowed.
    """
    assert body.centre is not None  # only the root has none, and it is never aimed
    arms = body.shape - body.centre
    reach = np.nan_to_num(np.linalg.norm(arms, axis=1))
    order = [m for m in np.argsort(-reach) if reach[m] > 0]
    for m in order:  # the farthest marker that is seen tells the direction best
        here = unit(arms[m])
        towards = unit(own[:, m] - centre)
        base = parent.rotations @ body.rest
        open_ = (
            (poses.flags == PoseFlag.UNSEEN) & is_seen(towards) & np.isfinite(base).all(axis=(1, 2))
        )
        if not open_.any():
            continue
        least = rotation_between(base[open_] @ here, towards[open_]) @ base[open_]
        flags = np.full(int(open_.sum()), PoseFlag.TWIST_UNKNOWN, dtype=np.uint8)
        if body.borrow is not None:
            lent = borrowing(np.linalg.norm(normal, axis=1), flexed)[open_]
            least[lent] = _two_vectors(here, body.borrow, towards[open_][lent], normal[open_][lent])
            flags[lent] = PoseFlag.TWIST_BORROWED
        poses.rotations[open_] = least
        poses.shifts[open_] = centre[open_] - least @ body.centre
        poses.flags[open_] = flags


def borrowing(sines: Array, flexed: float) -> Mask:
    """Return in which frames a joint is flexed enough to lend its plane, with hysteresis.

    Parameters
    ----------
    sines : (n_frames,)
        Sine of the flexion; NaN counts as straight.
    flexed
        rad, flexion from which the plane is used; it is let go at `RELEASE` of it.
    """
    above = np.nan_to_num(sines) > np.sin(flexed)
    loose = np.nan_to_num(sines) > np.sin(RELEASE * flexed)
    runs = np.concatenate([[0], np.cumsum(np.diff(loose.astype(np.int8)) != 0)])
    taken = np.zeros(runs[-1] + 1 if len(runs) else 1, dtype=bool)
    np.logical_or.at(taken, runs, above)
    return np.asarray(loose & taken[runs])


def _two_vectors(here: Array, normal: Array, towards: Array, plane: Array) -> Array:
    """Return rotations that take ``here`` to ``towards`` and ``normal`` near ``plane``."""
    local = np.stack([here, unit(normal), np.cross(here, unit(normal))], axis=-1)
    flat = unit(plane - (plane * towards).sum(axis=1, keepdims=True) * towards)
    world = np.stack([towards, flat, np.cross(towards, flat)], axis=-1)
    turned: Array = world @ local.T
    return turned


def bridge(
    poses: Poses, body: Body, parent: Poses | None, centre: Array | None, longest: int
) -> None:
    """Fill short gaps from the poses around them, in place, seen from the parent if there is one.

    Parameters
    ----------
    centre : (n_frames, 3) m
        The joint towards the parent, in the world; None for the root.
    longest
        Most frames of a gap.
    """
    known = poses.flags != PoseFlag.UNSEEN
    if known.all():
        return
    base = np.broadcast_to(np.eye(3), poses.rotations.shape) if parent is None else parent.rotations
    relative = np.swapaxes(base, 1, 2) @ poses.rotations
    for a, b in _gaps(known):
        if a < 1 or b >= len(known) or b - a > longest:
            continue
        ends = relative[[a - 1, b]]
        if not np.isfinite(ends).all():
            continue
        turn = Slerp([0.0, 1.0], Rotation.from_matrix(ends))
        share = np.arange(1, b - a + 1) / (b - a + 1)
        rotations = base[a:b] @ turn(share).as_matrix()
        if centre is None or body.centre is None:
            ends_at = poses.shifts[[a - 1, b]]
            shifts = ends_at[0] + share[:, None] * (ends_at[1] - ends_at[0])
        else:
            shifts = centre[a:b] - rotations @ body.centre
        ok = np.isfinite(rotations).all(axis=(1, 2)) & np.isfinite(shifts).all(axis=1)
        at = np.arange(a, b)[ok]
        poses.rotations[at], poses.shifts[at] = rotations[ok], shifts[ok]
        poses.flags[at] = PoseFlag.FILLED


def _gaps(known: Mask) -> list[tuple[int, int]]:
    """Return the runs of False as (first, beyond last)."""
    edges = np.flatnonzero(np.diff(np.concatenate([[True], known, [True]]).astype(np.int8)))
    return [(int(a), int(b)) for a, b in zip(edges[::2], edges[1::2], strict=True)]
