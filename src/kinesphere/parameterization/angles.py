"""Rotation angles about the joint's axes, from rest to every pose (paper section 4.4)."""

from dataclasses import dataclass, replace

import numpy as np

from kinesphere.data import Array, Mask
from kinesphere.geometry.rotations import carried, turned, turned_from
from kinesphere.parameterization.branches import (
    CALM,
    branches_of_movement,
    branches_of_small_twist,
)
from kinesphere.parameterization.kernels import two_axis_solutions
from kinesphere.parameterization.samples import smooth_rotations
from kinesphere.parameterization.settings import AngleSettings, TwistSettings
from kinesphere.parameterization.twist import closed_twist, sampled_twist


@dataclass(frozen=True, eq=False)
class JointAngles:
    """Angles and twist of one joint, and how well they are determined."""

    angles: Array
    """(n_frames, 3) rad in (−π, π]; NaN for an axis the joint does not have, and about the first
    of three where the orientation about the limb is arbitrary."""
    twists: Array
    """(n_frames,) rad in (−π, π]; 0 for a joint of three axes."""
    excess: Array
    """(n_frames,) rad from the limb to the nearest direction the axes can take it to."""
    sines: Array
    """(n_frames,) singularity measure: sine of the angle of the limb, before the proximal
    rotation, to the plane of two axes; 1 for a joint of one axis."""


def solve_angles(
    rotations: Array,
    axes: Array,
    rest: Array,
    long_axis: Array,
    twist_known: Mask,
    settings: AngleSettings,
    twist: TwistSettings,
    rate: float = 0.0,
) -> JointAngles:
    """Return the angles that rebuild the poses of a joint.

    Parameters
    ----------
    rotations : (n_frames, 3, 3)
        ``parent_from_child``.
    axes : (n_axes, 3)
        One to three unit vectors in the parent, distal first.
    rest : (3, 3)
    long_axis : (3,)
        In the child.
    twist_known : (n_frames,)
        False where the orientation about the limb is arbitrary; its twist is then NaN.
    settings, twist
        How a branch is chosen, and how the twist is found.
    rate
        Hz; 0 where unknown. Tells how long a limb may be twisted into the other half turn before
        its branch is doubted, and what is too fast for a limb and therefore noise.
    """
    if len(axes) == 1:
        solved = one_axis_angles(rotations, axes[0], rest, long_axis)
    elif len(axes) == 2:
        solved = two_axis_angles(
            rotations, axes, rest, long_axis, twist_known, settings, settings.unwrap, rate
        )
    else:
        return three_axis_angles(rotations, axes, rest, long_axis, twist_known, settings, rate)
    twists = solved.twists
    if twist.method == "sampled":
        model = np.broadcast_to(rest, rotations.shape)
        for i, axis in enumerate(axes):
            model = turned(model, axis, solved.angles[:, i])
        twists = sampled_twist(model, rotations, long_axis, np.deg2rad(twist.step))
    twists = np.where(twist_known, twists, np.nan)
    return JointAngles(solved.angles, twists, solved.excess, solved.sines)


def one_axis_angles(rotations: Array, axis: Array, rest: Array, long_axis: Array) -> JointAngles:
    """Return the angle about one axis and the twist, by azimuth: exact least squares.

    The limb can only go round its cone; ``excess`` says how far outside it is.
    """
    p = carried(rotations, long_axis)
    r = rest @ long_axis
    theta = np.arctan2(np.cross(r, p) @ axis, p @ r - (r @ axis) * (p @ axis))
    model = turned_from(rest, axis, theta)
    angles = np.full((len(rotations), 3), np.nan)
    angles[:, 0] = theta
    off = np.abs(_colatitude(axis, p) - _colatitude(axis, r))
    ones = np.where(np.isnan(theta), np.nan, 1.0)
    return JointAngles(
        _half_open(angles), _half_open(closed_twist(model, rotations, long_axis)), off, ones
    )


def two_axis_angles(
    rotations: Array,
    axes: Array,
    rest: Array,
    long_axis: Array,
    twist_known: Mask,
    settings: AngleSettings,
    deliberate: bool = False,
    rate: float = 0.0,
) -> JointAngles:
    """Return angles about two axes: two circles meet on the joint sphere in at most two points.

    Subproblem 2 of Paden & Kahan (Murray, Li & Sastry 1994, section 3.3) in closed form. Where the
    circles miss, the intermediate point is taken in the plane of the axes, which keeps the limb's
    azimuth about the proximal axis: the reachable set is a band about that axis, so this is the
    exact least-squares answer (as in Elias & Wen 2022, arXiv:2211.05737). Which of the two points
    counts is the branch rule's say; a ``deliberate`` twist is a movement like the others, whose
    size is no reason to change the branch.
    """
    given = axes[0].copy(), axes[1].copy(), np.ascontiguousarray(rest), long_axis.copy()
    solutions, sines, excess = two_axis_solutions(np.ascontiguousarray(rotations), *given)
    if settings.branch == "viterbi" and deliberate:
        calm = np.ascontiguousarray(smooth_rotations(rotations, rate, CALM))
        calm = two_axis_solutions(calm, *given)[0]
        branch = branches_of_movement(solutions, calm, twist_known, rate)
    elif settings.branch == "viterbi":
        branch = branches_of_small_twist(solutions, twist_known, settings.twist_cost, rate)
    elif settings.branch == "smallest-twist":
        smaller = np.abs(solutions[:, 1, 2]) < np.abs(solutions[:, 0, 2])
        branch = (smaller & twist_known).astype(np.int8)
    else:
        branch = np.zeros(len(solutions), dtype=np.int8)
    solved = _half_open(solutions[np.arange(len(solutions)), branch])
    angles = np.full((len(rotations), 3), np.nan)
    angles[:, :2] = solved[:, :2]
    return JointAngles(angles, solved[:, 2], excess, sines)


def three_axis_angles(
    rotations: Array,
    axes: Array,
    rest: Array,
    long_axis: Array,
    twist_known: Mask,
    settings: AngleSettings,
    rate: float = 0.0,
) -> JointAngles:
    """Return angles about three axes of any directions, which leave no twist over.

    ``R(a3, θ3) R(a2, θ2) R(a1, θ1) rest``: the first axis plays the limb of a two-axis joint, and
    the rotation about it the twist. Where the orientation about the limb is arbitrary, nothing
    tells θ1: it is NaN, and the others take the limb where it is as if θ1 were zero.
    """
    if settings.branch == "smallest-twist":  # there is none
        settings = replace(settings, branch="viterbi")
    solved = two_axis_angles(
        rotations @ rest.T, axes[1:], np.eye(3), axes[0], twist_known, settings, True, rate
    )
    first, others = np.where(twist_known, solved.twists, np.nan), solved.angles[:, :2]
    twists = np.where(np.isnan(first), np.nan, 0.0)
    excess, sines = solved.excess, solved.sines
    if not twist_known.all():
        limb = two_axis_angles(
            rotations, axes[1:], rest, long_axis, twist_known, settings, rate=rate
        )
        others = np.where(twist_known[:, None], others, limb.angles[:, :2])
        excess = np.where(twist_known, excess, limb.excess)
        sines = np.where(twist_known, sines, limb.sines)
    return JointAngles(np.column_stack([first, others]), twists, excess, sines)


def unwrapped(angles: Array) -> Array:
    """Return angles without jumps of a full turn over time, (n_frames, ...) rad; NaN stays NaN.

    Delivered angles lie in (−π, π]; a limb that turns on and on needs more than that. Across a gap
    the nearest turn is taken.
    """
    continuous = np.array(angles, dtype=np.float64)
    columns = continuous.reshape(len(continuous), -1)
    for column in columns.T:
        known = np.isfinite(column)
        column[known] = np.unwrap(column[known])
    return columns.reshape(angles.shape)


def _colatitude(axis: Array, points: Array) -> Array:
    """Return the angle to an axis in rad, (..., 3) → (...,), precise at the poles too."""
    sine = np.linalg.norm(np.cross(axis, points), axis=-1)
    angle: Array = np.arctan2(sine, points @ axis)
    return angle


def _half_open(angles: Array) -> Array:
    """Return angles with −π replaced by π."""
    return np.where(angles <= -np.pi, np.pi, angles)
