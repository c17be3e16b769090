"""The body of a limb, its shape and poses, measured on a sample of the frames."""

from collections.abc import Mapping

import numpy as np

from kinesphere.data import Array, PoseFlag
from kinesphere.errors import DegenerateMotion
from kinesphere.geometry.pose_errors import point_covariance, pose_covariance
from kinesphere.geometry.rigid import RigidFit, into_frame, out_of_frame
from kinesphere.geometry.rotations import mean_rotation
from kinesphere.skeleton.body import NOISE, Body, measure_shape, robust_rms
from kinesphere.skeleton.limb_joint import FoundJoint
from kinesphere.skeleton.lines import measure_line
from kinesphere.skeleton.linked_joint import LinkedJoint
from kinesphere.skeleton.neighbours import cloud
from kinesphere.skeleton.poses import Neighbour, fit_poses
from kinesphere.skeleton.settings import SkeletonSettings
from kinesphere.skeleton.tree import Tree

SHARP = 1e-4
"""m, least noise that markers are believed to have: cameras see no sharper."""


def measure_root(tree: Tree, sample: dict[str, Array], settings: SkeletonSettings) -> Body:
    """Measure the limb that all others hang from.

    Raises
    ------
    DegenerateMotion
        If its markers never show an orientation.
    """
    labels = tree.markers[tree.root]
    measured = measure_shape(
        cloud(labels, sample), settings.outlier_mm * 1e-3, settings.min_spread_mm * 1e-3
    )
    if measured is None:
        raise DegenerateMotion(
            f"the root {tree.root} has no frame in which its markers {', '.join(labels)} are seen "
            f"together off a line; at least three are needed to tell where it points"
        )
    shape, noise, fit = measured
    return Body(
        tree.root,
        None,
        labels,
        shape,
        noise,
        rotations=fit.rotations,
        shifts=fit.shifts,
        own_pose=True,
    )


def measure_limb(
    found: FoundJoint,
    parent: Body,
    tree: Tree,
    sample: dict[str, Array],
    settings: SkeletonSettings,
    linked: Mapping[str, LinkedJoint],
) -> Body:
    """Measure a limb that hangs from a joint.

    Parameters
    ----------
    linked
        Child limb → its joint as a group of limbs has it: that is where the limb meets it.
    """
    own, noise, solid = found.own, found.noise, found.solid
    joint, fit = found.measured.model, found.measured.fit
    outlier, min_spread = settings.outlier_mm * 1e-3, settings.min_spread_mm * 1e-3
    told = linked.get(joint.child)
    centre = out_of_frame(parent.rotations, parent.shifts, fit.centre[None])[:, 0]
    if told is not None:
        centre = np.where(np.isfinite(told.world), told.world, centre)
    with_joint = np.concatenate([own, centre[:, None]], axis=1)
    beyond = [linked[limb].world for limb in tree.children(joint.child) if limb in linked]
    if solid is None:
        with_joint = np.concatenate([with_joint, *(at[:, None] for at in beyond)], axis=1)
        shaped = measure_shape(with_joint, outlier, min_spread)
    else:
        shakes = np.trace(point_covariance(parent.pose_covariance, fit.centre)) / 3
        noise = np.append(noise, joint_noise(solid, centre, float(np.sqrt(shakes))))
        shaped = measure_shape(with_joint, outlier, min_spread, noise=noise)
    if shaped is None:
        return measure_line(joint, parent, tree, sample, centre, settings)
    shape, noise, _ = shaped
    n = own.shape[1]
    labels = tree.markers[joint.child]
    body = Body(joint.child, joint.parent, labels, shape[:n], noise[:n], shape[n])
    body.centre_noise = float(noise[n])
    body.own_pose, body.linked = solid is not None, solid is None and told is not None
    seen = [centre, *beyond] if solid is None else [centre]
    carried = zip(shape[n:], seen, noise[n:], strict=True)
    poses = fit_poses(body, own, tuple(Neighbour(*one) for one in carried), min_spread)
    if (poses.flags == PoseFlag.UNSEEN).all():  # off a line by so little that weights decide
        return measure_line(joint, parent, tree, sample, centre, settings)
    body.rotations, body.shifts = poses.rotations, poses.shifts
    relative = np.swapaxes(parent.rotations, 1, 2) @ body.rotations
    if np.isfinite(relative).all(axis=(1, 2)).any():
        body.rest = mean_rotation(relative)
    return body


def joint_noise(solid: tuple[Array, Array, RigidFit], centre: Array, least: float) -> float:
    """Return the noise of a joint in a limb, in each direction, on the scale of its markers'.

    What a joint strays in the limb by more than the limb's own pose shakes there, as its markers'
    residuals have it. Weights reckon markers noisier than residuals show, by `NOISE`, and so the
    pose as shakier; what strays counts as many times as much, or the joint would outvote them.

    Parameters
    ----------
    solid
        Shape, noise and pose of the limb by its markers alone.
    centre : (n_frames, 3) m, the joint in the world by the parent.
    least
        m, what is known to stray at least, on that scale: the parent's pose shakes, too.
    """
    shape, noise, pose = solid
    local = into_frame(pose.rotations, pose.shifts, centre[:, None])
    known = np.isfinite(local).all(axis=(1, 2))
    if not known.any():
        return least
    usual = np.median(local[known, 0], axis=0)
    strays = float(robust_rms(np.linalg.norm(local - usual, axis=2))[0])
    shown, reckoned = (
        float(np.trace(point_covariance(pose_covariance(shape, np.hypot(noise, one)), usual))) / 3
        for one in (SHARP, NOISE)
    )
    return float(np.sqrt(max((strays**2 - shown) * reckoned / shown, least**2)))
