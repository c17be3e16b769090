"""Poses of limbs that have none of their own, from the limbs on either side, in every frame."""

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation, Slerp

from kinesphere.data import Array, PoseFlag
from kinesphere.geometry.linkage import Linkage
from kinesphere.geometry.linkage_fit import pose_linkage
from kinesphere.geometry.vectors import is_seen
from kinesphere.skeleton.body import Body
from kinesphere.skeleton.measured import MeasuredJoint
from kinesphere.skeleton.neighbours import cloud
from kinesphere.skeleton.poses import BLOCK, Poses


def parents_in(group: tuple[str, ...], bodies: dict[str, Body]) -> tuple[int, ...]:
    """Return where in a group each limb's parent is; −1 for the first."""
    return (-1, *(group.index(str(bodies[limb].parent)) for limb in group[1:]))


def linkage_of(
    group: tuple[str, ...],
    bodies: dict[str, Body],
    joints: dict[str, MeasuredJoint],
    rotations: Array,
    origin: Array,
) -> Linkage:
    """Return limbs that hang together as a linkage; markers of no known place are left out.

    Parameters
    ----------
    group
        Parents first.
    rotations : (n_frames, n_limbs, 3, 3)
    origin : (n_frames, 3) m, of the first limb.
    """
    limbs = [bodies[limb] for limb in group]
    parents = parents_in(group, bodies)
    ends = [np.zeros(3), *(_centre(body) for body in limbs[1:])]
    hung = [
        joints[limb].fit.centre - ends[p] for limb, p in zip(group[1:], parents[1:], strict=True)
    ]
    return Linkage(
        parents,
        tuple(body.shape[is_seen(body.shape)] - end for body, end in zip(limbs, ends, strict=True)),
        np.vstack([np.zeros(3), *hung]),
        rotations,
        origin,
    )


def markers_of(group: tuple[str, ...], bodies: dict[str, Body], markers: dict[str, Array]) -> Array:
    """Return the markers of `linkage_of`, (n_frames, n_markers, 3) m."""
    clouds = [cloud(bodies[g].labels, markers)[:, is_seen(bodies[g].shape)] for g in group]
    return np.concatenate(clouds, axis=1)


def pose_linked(
    group: tuple[str, ...],
    bodies: dict[str, Body],
    joints: dict[str, MeasuredJoint],
    markers: dict[str, Array],
    frames: NDArray[np.intp],
    first: Poses,
    poses: dict[str, Poses],
) -> None:
    """Pose a group's limbs that have no pose of their own, in place, where all of it is seen.

    Every frame begins from how the limbs lay in the sampled frames around it.

    Parameters
    ----------
    frames
        The sampled frames, those of the bodies' poses.
    first
        Poses of the group's first limb.
    poses
        Limb → its poses, of those to be posed.
    """
    sampled = np.stack([bodies[limb].rotations for limb in group], axis=1)
    inside = np.swapaxes(sampled[:, :1], 2, 3) @ sampled
    known = np.flatnonzero(np.isfinite(inside).all(axis=(1, 2, 3)))
    points = markers_of(group[1:], bodies, markers)
    whole = is_seen(points).all(axis=1) & np.isfinite(first.rotations).all(axis=(1, 2))
    at = np.flatnonzero(whole)
    if len(known) < 2 or not len(at):
        return
    around = frames[known]
    ways = [
        Slerp(around, Rotation.from_matrix(turns)) for turns in np.moveaxis(inside[known], 1, 0)
    ]
    for block in np.split(at, range(BLOCK, len(at), BLOCK)):
        now = block.clip(around[0], around[-1])
        lay = np.stack([way(now).as_matrix() for way in ways], axis=1)
        rotations = first.rotations[block, None] @ lay
        start = linkage_of(group, bodies, joints, rotations, first.shifts[block])
        fit, settled = pose_linkage(start, points[block])
        origins = fit.origins
        for i, limb in enumerate(group[1:], start=1):
            if limb in poses:
                turned, there = fit.rotations[settled, i], block[settled]
                poses[limb].rotations[there] = turned
                poses[limb].shifts[there] = origins[settled, i] - turned @ _centre(bodies[limb])
                poses[limb].flags[there] = PoseFlag.JOINT_AIDED


def _centre(body: Body) -> Array:
    assert body.centre is not None  # only the root of all has none
    return body.centre
