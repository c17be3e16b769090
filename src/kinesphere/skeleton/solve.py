"""Every limb's pose in every frame: outward from the root, then inward for what is still open."""

import numpy as np

from kinesphere.data import Array, PoseFlag
from kinesphere.geometry.rigid import out_of_frame
from kinesphere.skeleton.body import Body
from kinesphere.skeleton.body_axes import unit
from kinesphere.skeleton.chain import MeasuredJoint
from kinesphere.skeleton.neighbours import cloud, next_normals
from kinesphere.skeleton.poses import Neighbour, Poses, aim, bridge, fit_poses, no_poses
from kinesphere.skeleton.settings import SkeletonSettings
from kinesphere.skeleton.tree import Tree


def solve_poses(
    tree: Tree,
    bodies: dict[str, Body],
    joints: dict[str, MeasuredJoint],
    markers: dict[str, Array],
    rate: float,
    settings: SkeletonSettings,
) -> dict[str, Poses]:
    """Return the poses of every limb in every frame.

    Parameters
    ----------
    markers
        Label → (n_frames, 3) m in the world.
    rate
        Hz.
    """
    min_spread = settings.min_spread_mm * 1e-3
    own = {limb: cloud(tree.markers[limb], markers) for limb in tree.limbs}
    alone = {
        limb: fit_poses(bodies[limb], own[limb], (), (), min_spread)
        for limb in tree.limbs
        if not bodies[limb].twist_open
    }
    poses: dict[str, Poses] = {}
    for limb in tree.limbs:
        body = bodies[limb]
        parent = None if body.parent is None else poses[body.parent]
        centre = None if parent is None else parent.carry(joints[limb].fit.centre)
        helpers = tuple(
            Neighbour(
                joints[child].fit.centre,
                alone[child].carry(_centre(bodies[child])),
                bodies[child].centre_noise,
            )
            for child in tree.children(limb)
            if child in alone and (alone[child].flags != PoseFlag.UNSEEN).any()
        )
        near = () if centre is None else (Neighbour(_centre(body), centre, body.centre_noise),)
        longest = int(settings.fill_gap_s * rate)
        if body.twist_open:
            poses[limb] = no_poses(len(own[limb]))
        else:
            measured = alone[limb].flags == PoseFlag.MEASURED
            poses[limb] = fit_poses(body, own[limb], near, helpers, min_spread, measured)
            bridge(poses[limb], body, parent, centre, longest)
        if parent is not None and centre is not None:
            flexed = np.deg2rad(settings.flexed_deg)
            reach = np.linalg.norm(body.shape - _centre(body), axis=1)
            far = int(np.nan_to_num(reach, nan=-1.0).argmax())
            end = own[limb][:, far]
            normals = next_normals(limb, unit(end - centre), end, tree, markers)
            aim(body, own[limb], centre, parent, normals, flexed, poses[limb])
            if body.twist_open:
                bridge(poses[limb], body, parent, centre, longest)
    return poses


def residuals(body: Body, own: Array, poses: Poses) -> Array:
    """Return the rms distance of a limb's markers from where its pose puts them, (n_frames,) m."""
    off = ((own - out_of_frame(poses.rotations, poses.shifts, body.shape)) ** 2).sum(axis=2)
    known = np.isfinite(off)
    count = known.sum(axis=1)
    with np.errstate(invalid="ignore", divide="ignore"):
        rms: Array = np.sqrt(np.where(known, off, 0.0).sum(axis=1) / count)
    return np.where(count > 0, rms, np.nan)


def _centre(body: Body) -> Array:
    return np.full(3, np.nan) if body.centre is None else body.centre
