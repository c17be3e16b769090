"""A limb whose markers and joint lie on a line: its twist is its neighbours' word."""

import numpy as np

from kinesphere.data import Array, JointModel, PoseFlag
from kinesphere.geometry.rigid import into_frame
from kinesphere.geometry.rotations import rotation_between
from kinesphere.skeleton.averages import mean_seen, median_seen
from kinesphere.skeleton.body import Body, robust_rms
from kinesphere.skeleton.body_axes import beside, unit
from kinesphere.skeleton.neighbours import cloud, flexed_normals, next_normals
from kinesphere.skeleton.poses import Poses, aim, no_poses
from kinesphere.skeleton.settings import SkeletonSettings
from kinesphere.skeleton.tree import Tree


def measure_line(
    joint: JointModel,
    parent: Body,
    tree: Tree,
    sample: dict[str, Array],
    centre: Array,
    settings: SkeletonSettings,
) -> Body:
    """Measure a limb whose markers and joint lie on a line: its twist is its neighbours' word."""
    labels = tree.markers[joint.child]
    own = cloud(labels, sample)
    arms = own - centre[:, None]
    reach = median_seen(np.linalg.norm(arms, axis=2))
    far = int(np.nan_to_num(reach, nan=-1.0).argmax())
    towards = unit(arms[:, far])
    by_parent = (np.swapaxes(parent.rotations, 1, 2) @ towards[..., None])[..., 0]
    here = unit(mean_seen(by_parent))
    if not np.isfinite(here).all():
        here = np.array([0.0, -1.0, 0.0])
    along = np.einsum("fmi,fi->fm", arms, towards)  # signed: a heel lies behind its ankle
    lengths = median_seen(along)
    shape = lengths[:, None] * here
    off = np.abs(along - lengths)
    body = Body(joint.child, joint.parent, labels, shape, robust_rms(off), np.zeros(3))
    body.twist_open = True
    flexed = np.deg2rad(settings.flexed_deg)
    normals = next_normals(body.name, towards, own[:, far], tree, sample)
    least = rotation_between(parent.rotations @ here, towards) @ parent.rotations
    bent = flexed_normals(normals, flexed)
    local = (np.swapaxes(least, 1, 2) @ bent[..., None])[..., 0]
    if np.isfinite(local).all(axis=1).sum() >= 5:
        body.borrow = beside(unit(mean_seen(local)), here)
    poses = no_poses(len(own))
    aim(
        body,
        own,
        centre,
        Poses(parent.rotations, parent.shifts, poses.flags),
        normals,
        flexed,
        poses,
    )
    body.rotations, body.shifts = poses.rotations, poses.shifts
    if body.borrow is not None:
        # off the line after all, if only by a little: seen where the twist is known
        lent = poses.flags == PoseFlag.TWIST_BORROWED
        local = into_frame(poses.rotations[lent], poses.shifts[lent], own[lent])
        mean = mean_seen(local)
        body.shape = np.where(np.isfinite(mean), mean, shape)
    return body
