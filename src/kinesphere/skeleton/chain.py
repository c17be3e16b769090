"""Limbs and joint centres measured from the root outward, on a sample of the frames."""

from collections.abc import Mapping

import numpy as np

from kinesphere.data import Array, JointModel, PoseFlag, TopologicalModel
from kinesphere.errors import DegenerateMotion
from kinesphere.geometry.centres import CentreFit, Turning, View, fit_centre
from kinesphere.geometry.joint_turns import joint_modes
from kinesphere.geometry.pose_errors import point_covariance, pose_covariance
from kinesphere.geometry.rigid import (
    RigidFit,
    into_frame,
    out_of_frame,
)
from kinesphere.geometry.rotations import mean_rotation
from kinesphere.geometry.skin import skin_noise
from kinesphere.skeleton.body import NOISE, Body, measure_shape, robust_rms
from kinesphere.skeleton.landmarks import expected_centre
from kinesphere.skeleton.limb_axes import find_axes
from kinesphere.skeleton.lines import measure_line
from kinesphere.skeleton.linked import LinkedJoint, fit_linked
from kinesphere.skeleton.measured import MeasuredJoint
from kinesphere.skeleton.neighbours import cloud
from kinesphere.skeleton.poses import Neighbour, fit_poses
from kinesphere.skeleton.settings import SkeletonSettings
from kinesphere.skeleton.symmetry import evened
from kinesphere.skeleton.tree import Tree


def measure_chain(
    tree: Tree, model: TopologicalModel, sample: dict[str, Array], settings: SkeletonSettings
) -> tuple[dict[str, Body], dict[str, MeasuredJoint]]:
    """Measure every limb's shape and joint centre.

    Parameters
    ----------
    sample
        Label → (n_sample, 3) m, every marker of the recording in the sampled frames.

    Returns
    -------
    bodies : limb → Body, root first
    joints : child limb → MeasuredJoint

    Raises
    ------
    DegenerateMotion
        If the root's markers never show an orientation.
    """
    bodies, joints = _measure_outward(tree, model, sample, settings, {}, {}, {}, {})
    linked, evener = {}, {}
    if settings.link_limbs:
        linked = fit_linked(tree, bodies, joints, sample, settings)
    if settings.even_hips_mm:
        evener = evened(joints, bodies, model, settings.even_hips_mm * 1e-3)
    if linked or evener:
        return _measure_outward(tree, model, sample, settings, linked, evener, bodies, joints)
    return bodies, joints


def _measure_outward(
    tree: Tree,
    model: TopologicalModel,
    sample: dict[str, Array],
    settings: SkeletonSettings,
    linked: Mapping[str, LinkedJoint],
    evener: Mapping[str, CentreFit],
    bodies_before: Mapping[str, Body],
    joints_before: Mapping[str, MeasuredJoint],
) -> tuple[dict[str, Body], dict[str, MeasuredJoint]]:
    """Measure limb by limb from the root.

    Joints that groups of limbs told are as those say, hips as both say; what neither touches stays
    as it was before, if it was measured.
    """
    joints: dict[str, MeasuredJoint] = {}
    if bodies_before:
        bodies = {tree.root: bodies_before[tree.root]}
    else:
        bodies = {tree.root: _measure_root(tree, sample, settings)}
        find_axes(bodies[tree.root], None, tree, model, sample, settings)
    for joint in tree.joints:
        parent, limb = bodies[joint.parent], joint.child
        same = parent is bodies_before.get(joint.parent)
        if same and limb not in linked and limb not in evener:
            bodies[limb], joints[limb] = bodies_before[limb], joints_before[limb]
            continue
        told = evener.get(limb) if same else None
        body, measured = _measure_limb(joint, parent, tree, sample, settings, linked, told)
        bodies[limb], joints[limb] = body, measured
        find_axes(body, parent, tree, model, sample, settings)
    return bodies, joints


def _measure_root(tree: Tree, sample: dict[str, Array], settings: SkeletonSettings) -> Body:
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


def _measure_limb(
    joint: JointModel,
    parent: Body,
    tree: Tree,
    sample: dict[str, Array],
    settings: SkeletonSettings,
    linked: Mapping[str, LinkedJoint],
    fit: CentreFit | None,
) -> tuple[Body, MeasuredJoint]:
    labels = tree.markers[joint.child]
    own = cloud(labels, sample)
    expected, spread, source = expected_centre(joint, parent, sample, labels)
    outlier, min_spread = settings.outlier_mm * 1e-3, settings.min_spread_mm * 1e-3
    seen_by_parent = into_frame(parent.rotations, parent.shifts, own)
    solid = measure_shape(own, outlier, min_spread) if len(labels) > 2 else None
    usual = float(np.sqrt(np.mean(parent.noise**2)) if solid is None else 0.0)
    noise = np.full(len(labels), usual) if solid is None else solid[1]
    view = View(
        seen_by_parent,
        np.hypot(noise, NOISE),
        parent.pose_covariance,
        None if solid is None else _turning(solid, parent, own, cloud(parent.labels, sample)),
    )
    told = linked.get(joint.child)
    if told is not None:
        fit = told.seen_from(parent, spread)
    if fit is None:
        fit = fit_centre(
            view,
            expected,
            spread,
            hidden=settings.soft_tissue,
            hinge=parent.right if joint.n_axes == 1 else None,
            tighter=settings.hinge,
        )
    measured = MeasuredJoint(joint, fit, expected, spread, source)
    centre = out_of_frame(parent.rotations, parent.shifts, fit.centre[None])[:, 0]
    if told is not None:
        centre = np.where(np.isfinite(told.world), told.world, centre)
    with_joint = np.concatenate([own, centre[:, None]], axis=1)
    beyond = [linked[limb].world for limb in tree.children(joint.child) if limb in linked]
    if solid is None:
        with_joint = np.concatenate([with_joint, *(at[:, None] for at in beyond)], axis=1)
        found = measure_shape(with_joint, outlier, min_spread)
    else:
        found = measure_shape(
            with_joint,
            outlier,
            min_spread,
            noise=np.append(noise, joint_noise(solid, centre, fit.noise)),
        )
    if found is None:
        return measure_line(joint, parent, tree, sample, centre, settings), measured
    shape, noise, _ = found
    n = len(labels)
    body = Body(joint.child, joint.parent, labels, shape[:n], noise[:n], shape[n])
    body.centre_noise = float(noise[n])
    body.own_pose, body.linked = solid is not None, solid is None and told is not None
    seen = [centre, *beyond] if solid is None else [centre]
    carried = zip(shape[n:], seen, noise[n:], strict=True)
    poses = fit_poses(body, own, tuple(Neighbour(*one) for one in carried), min_spread)
    if (poses.flags == PoseFlag.UNSEEN).all():  # off a line by so little that weights decide
        return measure_line(joint, parent, tree, sample, centre, settings), measured
    body.rotations, body.shifts = poses.rotations, poses.shifts
    relative = np.swapaxes(parent.rotations, 1, 2) @ body.rotations
    if np.isfinite(relative).all(axis=(1, 2)).any():
        body.rest = mean_rotation(relative)
    return body, measured


def _turning(
    solid: tuple[Array, Array, RigidFit], parent: Body, own: Array, others: Array
) -> Turning:
    """Return how a limb with a pose of its own turns in its parent."""
    shape, noise, pose = solid
    rotations = np.swapaxes(parent.rotations, 1, 2) @ pose.rotations
    known = np.isfinite(rotations).all(axis=(1, 2))
    skin = seeing = None
    if known.any() and len(parent.labels) > 2:
        modes = np.full(parent.shifts.shape, np.nan)
        modes[known] = joint_modes(rotations[known])
        mine = skin_noise(into_frame(pose.rotations, pose.shifts, own)[known], shape, modes[known])
        theirs = skin_noise(
            into_frame(parent.rotations, parent.shifts, others)[known], parent.shape, modes[known]
        )
        skin, seeing = pose_covariance(shape, mine), pose_covariance(parent.shape, theirs)
    return Turning(
        rotations,
        into_frame(parent.rotations, parent.shifts, pose.shifts[:, None])[:, 0],
        pose_covariance(shape, np.hypot(noise, NOISE)),
        float(np.hypot(np.sqrt(np.mean(noise**2)), NOISE)),
        skin,
        seeing,
    )


def joint_noise(solid: tuple[Array, Array, RigidFit], centre: Array, least: float) -> float:
    """Return how far, in m, a joint strays in a limb beyond what the limb's own pose explains."""
    shape, noise, pose = solid
    local = into_frame(pose.rotations, pose.shifts, centre[:, None])
    known = np.isfinite(local).all(axis=(1, 2))
    if not known.any():
        return least
    usual = np.median(local[known, 0], axis=0)
    strays = float(robust_rms(np.linalg.norm(local - usual, axis=2))[0])
    shaky = point_covariance(pose_covariance(shape, np.hypot(noise, NOISE)), usual)
    return float(np.sqrt(max(strays**2 - np.trace(shaky) / 3, least**2)))
