"""Where a joint's angles are zero, and which of its axes is the proximal one."""

from dataclasses import replace

import numpy as np

from kinesphere.data import Array
from kinesphere.geometry.even_frames import every_nth
from kinesphere.geometry.rotations import mean_rotation, rotation_about, rotation_between
from kinesphere.parameterization.anatomy import joint_kind, named_axes
from kinesphere.parameterization.angles import solve_angles, two_axis_angles
from kinesphere.parameterization.axes.universal_joint import reference_rotation
from kinesphere.parameterization.rest import paper_rest, rest_target, robust_rest
from kinesphere.parameterization.settings import ParameterizationSettings
from kinesphere.parameterization.view import JointView

TRIAL_FRAMES = 600  # enough to tell which order of axes serves better
CLEARLY = 0.5  # another order must lower the twist at least to this share to be taken: where
# limbs really twist, the wrong order of axes lowers it to 0.65 now and then
OUT_OF_REACH = 0.05  # of the frames; about axes a person has, the limb goes wherever it goes


def movement_rest(
    view: JointView, found: Array, heights: Array, settings: ParameterizationSettings
) -> tuple[Array, Array, list[int]]:
    """Return axes distal first, the rest orientation, and where each axis stood in ``found``.

    Sar Dessai et al. 2006, sections 4.3 and 4.4; the order is left open there.

    Parameters
    ----------
    view
        The joint.
    found : (n_axes, 3)
        Axes in any order and sign.
    heights : (n_axes,)
        Cosine of the cone on which the limb moves about each.
    settings
        Of rest, angles and twist.

    Returns
    -------
    axes : (n_axes, 3)
    rest : (3, 3)
    order
        Index in ``found`` of each axis.
    """
    axes, order = named_axes(found, view.name)
    axes, order = axes[::-1], order[::-1]  # flexion proximal, unless another order serves better
    if settings.axes.method == "universal-joint" and len(axes) == 2:
        # this method knows the order, and its distal axis holds for its own reference orientation
        axes, order = (axes, order) if order[0] == 0 else (axes[::-1], order[::-1])
        return axes, _usual_twist(view, axes, settings), order
    turned = np.sign((axes * found[order]).sum(axis=1))  # a cone's height turns with its axis
    rest = _rest(view, axes, turned * heights[order], settings)
    if len(axes) == 2:
        plain, other = (
            reach_and_twist(view, tried, rest, settings) for tried in (axes, axes[::-1])
        )
        if other[0] < plain[0] or (other[0] == plain[0] and other[1] < CLEARLY * plain[1]):
            axes, order = axes[::-1], order[::-1]
    return axes, rest, order


def _usual_twist(view: JointView, axes: Array, settings: ParameterizationSettings) -> Array:
    """Return the reference orientation, (3, 3), turned about the limb to its usual twist."""
    reference = reference_rotation(view.samples)
    solved = two_axis_angles(
        view.samples.rotations,
        axes,
        reference,
        view.long_axis,
        view.twist_known[view.calibration],
        settings.angles,
    )
    known = solved.twists[solved.sines > np.sin(np.deg2rad(settings.angles.singular))]
    if len(known) == 0:
        return reference
    usual = float(np.angle(np.exp(1j * known).mean()))
    turned: Array = rotation_about(reference @ view.long_axis, np.array([usual]))[0] @ reference
    return turned


def _rest(
    view: JointView, axes: Array, heights: Array, settings: ParameterizationSettings
) -> Array:
    anatomical = (
        settings.rest.method == "robust"
        and settings.rest.zero == "anatomical"
        and joint_kind(view.name) is not None
    )
    zero = view.long_axis if anatomical else None
    rotations, positions = view.samples.rotations, view.samples.positions
    if settings.rest.method == "paper":
        target, _ = rest_target(axes, np.zeros(len(axes)), view.gravity, None)
        return paper_rest(rotations, positions, target)
    target, _ = rest_target(axes, heights, view.gravity, zero)
    slow = ~view.movement.moving[view.calibration]
    return robust_rest(rotations, positions, slow, axes, target, settings.rest)


def aligned_rest(view: JointView, axes: Array) -> Array:
    """Return the rest orientation that goes with axes of the body frame.

    The limb aligned with its parent; a one-axis joint's is tilted onto the cone the limb really
    moves on; a joint nobody named has no alignment, so the mean orientation serves.
    """
    if joint_kind(view.name) is None:
        return mean_rotation(view.samples.rotations) if view.calibration.any() else np.eye(3)
    if len(axes) > 1 or not view.calibration.any():
        return np.eye(3)
    height = float(np.median(view.samples.positions @ axes[0]))
    target, unique = rest_target(axes, np.array([height]), view.gravity, view.long_axis)
    return rotation_between(view.long_axis, target) if unique else np.eye(3)


def body_rest(view: JointView, axes: Array, settings: ParameterizationSettings) -> Array:
    """Return `aligned_rest`; of a joint nobody named one that its axes can take to its poses.

    Over a whole turn the mean orientation is none that the limb ever has: where it leaves poses
    out of reach, slow samples near the place where the axes' circles meet serve instead.
    """
    rest = aligned_rest(view, axes)
    if joint_kind(view.name) is not None or len(axes) > 2 or not view.calibration.any():
        return rest
    usual, _ = reach_and_twist(view, axes, rest, settings)
    if usual <= OUT_OF_REACH:
        return rest
    # one axis takes the limb round its median cone, two across each other and it take it anywhere
    heights = np.array([np.median(view.samples.positions @ axes[0])] if len(axes) == 1 else [0, 0])
    met = _rest(view, axes, heights, settings)
    share, _ = reach_and_twist(view, axes, met, settings)
    return met if share < usual else rest


def reach_and_twist(
    view: JointView, axes: Array, rest: Array, settings: ParameterizationSettings
) -> tuple[float, float]:
    """Return the share of frames out of reach (in whole percent) and the rms twist in rad."""
    at = np.flatnonzero(np.isfinite(view.rotations[:, 0, 0]))
    at = at[every_nth(len(at), len(at) // TRIAL_FRAMES)]
    solved = solve_angles(
        view.rotations[at],
        axes,
        rest,
        view.long_axis,
        view.twist_known[at],
        settings.angles,
        replace(settings.twist, method="closed-form"),
    )
    unreachable = np.mean(solved.excess > np.deg2rad(settings.angles.unreachable))
    known = np.isfinite(solved.twists)
    twist = float(np.sqrt(np.mean(solved.twists[known] ** 2))) if known.any() else 0.0
    return round(float(unreachable), 2), twist
