"""The joint that a limb hangs from, measured in its parent on a sample of the frames."""

from typing import NamedTuple

import numpy as np

from kinesphere.data import Array, JointModel
from kinesphere.geometry.centres import Turning, View, fit_centre, untold
from kinesphere.geometry.joint_turns import joint_modes
from kinesphere.geometry.pose_errors import (
    mean_pose_covariance,
    pose_covariance,
    usual_pose_covariance,
)
from kinesphere.geometry.rigid import RigidFit, into_frame
from kinesphere.geometry.skin_noise import skin_noise
from kinesphere.geometry.vectors import is_seen
from kinesphere.skeleton.body import NOISE, Body, measure_shape
from kinesphere.skeleton.landmarks import expected_centre, expected_off
from kinesphere.skeleton.linked_joint import LinkedJoint
from kinesphere.skeleton.measured import MeasuredJoint
from kinesphere.skeleton.neighbours import cloud
from kinesphere.skeleton.settings import SkeletonSettings
from kinesphere.skeleton.weighing import LOOSELY, UNLIKE, weighed

STRAYS = 0.75
"""Share of `SkeletonSettings.undetermined_mm` that a limb's markers may stray in each direction on
average: skin of 20 mm a radian leaves 3 mm, real trunks 11, two limbs taken for one 20."""


class FoundJoint(NamedTuple):
    """A joint, and what is known of the limb that hangs from it before its body is measured."""

    measured: MeasuredJoint
    own: Array
    """(n_sample, n_markers, 3) m, the limb's markers in the world."""
    noise: Array
    """(n_markers,) m."""
    solid: tuple[Array, Array, RigidFit] | None
    """Shape, noise and pose by its markers alone; None where they tell none."""


def find_joint(
    joint: JointModel,
    parent: Body,
    labels: tuple[str, ...],
    sample: dict[str, Array],
    settings: SkeletonSettings,
    told: LinkedJoint | None = None,
) -> FoundJoint:
    """Return a limb's joint by the motion of its markers in its parent.

    Parameters
    ----------
    labels
        The limb's own markers.
    told
        The joint as a group of limbs has it; then it is there.
    """
    own = cloud(labels, sample)
    at = expected_centre(joint, parent, sample, labels)
    weigh = at.anatomy and settings.weigh_anatomy
    may_be_off = UNLIKE * at.spread if at.anatomy and not weigh else at.spread
    spread = LOOSELY * at.spread if weigh else may_be_off
    outlier, min_spread = settings.outlier_mm * 1e-3, settings.min_spread_mm * 1e-3
    solid = measure_shape(own, outlier, min_spread) if len(labels) > 2 else None
    usual = float(np.sqrt(np.mean(parent.noise**2)) if solid is None else 0.0)
    noise = np.full(len(labels), usual) if solid is None else solid[1]
    fit = None if told is None else told.seen_from(parent, spread)
    if fit is None:
        others = cloud(parent.labels, sample)
        view = View(
            into_frame(parent.rotations, parent.shifts, own),
            np.hypot(noise, NOISE),
            _pose_covariance(parent, own, others),
            None if solid is None else _turning(solid, parent, own, others),
        )
        fit = fit_centre(
            view,
            at.centre,
            spread,
            off=expected_off(at.source, parent, labels),
            hidden=settings.soft_tissue,
            hinge=parent.right if joint.n_axes == 1 else None,
            tighter=settings.hinge,
        )
    strays = max(float(np.mean(one)) for one in (parent.noise, noise))
    if strays > STRAYS * settings.undetermined_mm * 1e-3:
        fit = untold(fit, spread)  # what is no body has no joint that its motion could tell
    alone = fit.centre
    if weigh:
        fit = weighed(fit, at.centre, at.spread)
    drawn = float(np.linalg.norm(fit.centre - alone))
    measured = MeasuredJoint(joint, fit, at.centre, may_be_off, at.source, drawn)
    return FoundJoint(measured, own, noise, solid)


def _pose_covariance(parent: Body, own: Array, others: Array) -> Array:
    """Return how uncertain the parent's pose is where it sees something of the limb, (6, 6)."""
    sees = is_seen(own).any(axis=1) & is_seen(parent.shifts)
    seen = is_seen(others)[sees]
    if parent.centre is not None:
        seen = np.concatenate([seen, np.ones((len(seen), 1), dtype=np.bool_)], axis=1)
    return usual_pose_covariance(parent.points, 1 / np.sqrt(parent.weights), seen)


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
        mean_pose_covariance(shape, np.hypot(noise, NOISE), is_seen(own)[known]),
        float(np.hypot(np.sqrt(np.mean(noise**2)), NOISE)),
        skin,
        seeing,
    )
