"""Limbs and joint centres measured from the root outward, on a sample of the frames."""

import warnings
from dataclasses import dataclass

import numpy as np

from kinesphere.data import Array, JointModel, PoseFlag, TopologicalModel
from kinesphere.errors import DegenerateMotion
from kinesphere.geometry.centres import CentreFit, Turning, View, fit_centre
from kinesphere.geometry.rigid import (
    RigidFit,
    into_frame,
    out_of_frame,
    point_covariance,
    pose_covariance,
)
from kinesphere.geometry.rotations import mean_rotation, rotation_between
from kinesphere.skeleton.body import NOISE, Body, measure_shape, robust_rms
from kinesphere.skeleton.body_axes import (
    HINGE_SIGN,
    beside,
    right_from_hinge,
    right_from_pairs,
    right_from_parent,
    unit,
    up_of_trunk,
)
from kinesphere.skeleton.landmarks import expected_centre
from kinesphere.skeleton.poses import Neighbour, Poses, aim, fit_poses, no_poses
from kinesphere.skeleton.settings import SkeletonSettings
from kinesphere.skeleton.tree import Tree


@dataclass(frozen=True)
class MeasuredJoint:
    """A joint centre with what it was expected to be."""

    model: JointModel
    fit: CentreFit
    expected: Array
    """(3,) m in the parent."""
    source: str
    """Where the expectation comes from."""


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
    bodies = {tree.root: _measure_root(tree, sample, settings)}
    _find_axes(bodies[tree.root], None, tree, model, sample, settings)
    joints: dict[str, MeasuredJoint] = {}
    for joint in tree.joints:
        parent = bodies[joint.parent]
        body, measured = _measure_limb(joint, parent, tree, sample, settings)
        bodies[joint.child], joints[joint.child] = body, measured
        _find_axes(body, parent, tree, model, sample, settings)
    return bodies, joints


def cloud(labels: tuple[str, ...], sample: dict[str, Array]) -> Array:
    """Return markers side by side, (n_sample, n_labels, 3) m."""
    return np.stack([sample[label] for label in labels], axis=1)


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
    return Body(tree.root, None, labels, shape, noise, rotations=fit.rotations, shifts=fit.shifts)


def _measure_limb(
    joint: JointModel,
    parent: Body,
    tree: Tree,
    sample: dict[str, Array],
    settings: SkeletonSettings,
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
        None if solid is None else _turning(solid, parent),
    )
    fit = fit_centre(
        view,
        expected,
        spread,
        hidden=settings.soft_tissue,
        hinge=parent.right if joint.n_axes == 1 else None,
        tighter=settings.hinge,
    )
    measured = MeasuredJoint(joint, fit, expected, source)
    centre = out_of_frame(parent.rotations, parent.shifts, fit.centre[None])[:, 0]
    with_joint = np.concatenate([own, centre[:, None]], axis=1)
    if solid is None:
        found = measure_shape(with_joint, outlier, min_spread)
    else:
        found = measure_shape(
            with_joint,
            outlier,
            min_spread,
            noise=np.append(noise, _joint_noise(solid, centre, fit.noise)),
        )
    if found is None:
        return _measure_line(joint, parent, tree, sample, centre, own, settings), measured
    shape, noise, _ = found
    body = Body(joint.child, joint.parent, labels, shape[:-1], noise[:-1], shape[-1])
    body.centre_noise = float(noise[-1])
    carried = (Neighbour(_known(body.centre), centre, body.centre_noise),)
    poses = fit_poses(body, own, carried, (), min_spread)
    body.rotations, body.shifts = poses.rotations, poses.shifts
    relative = np.swapaxes(parent.rotations, 1, 2) @ body.rotations
    if np.isfinite(relative).all(axis=(1, 2)).any():
        body.rest = mean_rotation(relative)
    return body, measured


def _turning(solid: tuple[Array, Array, RigidFit], parent: Body) -> Turning:
    """Return how a limb with a pose of its own turns in its parent."""
    shape, noise, pose = solid
    return Turning(
        np.swapaxes(parent.rotations, 1, 2) @ pose.rotations,
        into_frame(parent.rotations, parent.shifts, pose.shifts[:, None])[:, 0],
        pose_covariance(shape, np.hypot(noise, NOISE)),
        float(np.hypot(np.sqrt(np.mean(noise**2)), NOISE)),
    )


def _joint_noise(solid: tuple[Array, Array, RigidFit], centre: Array, least: float) -> float:
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


def _measure_line(
    joint: JointModel,
    parent: Body,
    tree: Tree,
    sample: dict[str, Array],
    centre: Array,
    own: Array,
    settings: SkeletonSettings,
) -> Body:
    """Measure a limb whose markers and joint lie on a line: its twist is its neighbours' word."""
    labels = tree.markers[joint.child]
    arms = own - centre[:, None]
    lengths = np.nanmedian(np.linalg.norm(arms, axis=2), axis=0)
    far = int(lengths.argmax())
    towards = unit(arms[:, far])
    by_parent = (np.swapaxes(parent.rotations, 1, 2) @ towards[..., None])[..., 0]
    here = unit(np.nanmean(by_parent, axis=0))
    if not np.isfinite(here).all():
        here = np.array([0.0, -1.0, 0.0])
    shape = lengths[:, None] * here
    off = np.abs(np.linalg.norm(arms, axis=2) - lengths)
    body = Body(joint.child, joint.parent, labels, shape, robust_rms(off), np.zeros(3))
    body.twist_open = True
    flexed = np.deg2rad(settings.flexed_deg)
    normals = next_normals(body.name, towards, own[:, far], tree, sample)
    least = rotation_between(parent.rotations @ here, towards) @ parent.rotations
    bent = flexion_normals_of(normals, flexed)
    local = (np.swapaxes(least, 1, 2) @ bent[..., None])[..., 0]
    if np.isfinite(local).all(axis=1).sum() >= 5:
        body.borrow = beside(unit(np.nanmean(local, axis=0)), here)
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
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", RuntimeWarning)  # a marker never seen with the twist
            mean = np.nanmean(local, axis=0)
        body.shape = np.where(np.isfinite(mean), mean, shape)
    return body


def next_normals(
    limb: str, towards: Array, end: Array, tree: Tree, sample: dict[str, Array]
) -> Array:
    """Return ``cross`` of the directions of a limb and the one limb beyond it, (n, 3).

    Parameters
    ----------
    towards : (n, 3)
        Unit direction of the limb, in the world.
    end : (n, 3) m
        Its far end.

    Returns
    -------
    (n, 3)
        As long as the sine of the flexion, towards the body's right where the joint's name tells;
        NaN where unknown.
    """
    beyond = tree.children(limb)
    if len(beyond) != 1:
        return np.full(towards.shape, np.nan)
    sign = hinge_sign(next(j for j in tree.joints if j.child == beyond[0]))
    lower = cloud(tree.markers[beyond[0]], sample).mean(axis=1) - end
    normals: Array = (sign or 1.0) * np.cross(towards, unit(lower))
    return normals


def flexion_normals_of(normals: Array, flexed: float) -> Array:
    """Return normals whose length is at least the sine of ``flexed``, NaN for the others."""
    enough = np.linalg.norm(normals, axis=1) > np.sin(flexed)
    return np.where(enough[:, None], normals, np.nan)


def hinge_sign(joint: JointModel) -> float | None:
    """Return which way the joint's flexion axis points, +1 for right; None if nobody knows."""
    return next((sign for part, sign in HINGE_SIGN.items() if joint.name.endswith(part)), None)


def _find_axes(
    body: Body,
    parent: Body | None,
    tree: Tree,
    model: TopologicalModel,
    sample: dict[str, Array],
    settings: SkeletonSettings,
) -> None:
    """Find the limb's right and up, in place."""
    own = cloud(body.labels, sample)
    pairs = right_from_pairs(body, model)
    if pairs is not None or parent is None:
        # pelvis, trunk, head: up is the body's
        rest = [
            label
            for limb in tree.limbs
            if limb in ("head", "trunk")
            for label in tree.markers[limb]
        ]
        feet = [
            label
            for limb in tree.limbs
            if "foot" in limb or "shank" in limb
            for label in tree.markers[limb]
        ]
        ends = [
            np.nanmean(cloud(tuple(labels), sample), axis=1) if labels else np.nanmean(own, axis=1)
            for labels in (rest, feet)
        ]
        if body.name != "pelvis":
            ends[1] = np.nanmean(cloud(tree.markers[tree.root], sample), axis=1)
        body.up = up_of_trunk(
            body, ends[0] - np.nanmean(own, axis=1) if rest else own[:, 0] * 0 + [0, 1, 0]
        )
        body.right = pairs
        if pairs is not None:
            body.up = beside(body.up, pairs)
        return
    assert body.centre is not None
    arms = body.shape - body.centre
    far = int(np.linalg.norm(arms, axis=1).argmax())
    long = unit(arms[far])
    body.up = -long
    right = right_from_parent(body, parent)
    for joint in tree.joints:
        sign = hinge_sign(joint) if joint.parent == body.name else None
        if sign is None:
            continue
        centre = out_of_frame(body.rotations, body.shifts, body.centre[None])[:, 0]
        lower = cloud(tree.markers[joint.child], sample).mean(axis=1) - own[:, far]
        hinge = right_from_hinge(body, own[:, far] - centre, lower, np.deg2rad(settings.flexed_deg))
        right = sign * hinge if hinge is not None else right
    if body.twist_open and body.borrow is not None:
        right = body.borrow
    body.right = None if right is None else beside(right, long)


def _known(point: Array | None) -> Array:
    assert point is not None
    return point
