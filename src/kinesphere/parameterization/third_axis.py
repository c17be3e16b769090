"""Whether a joint has a third axis: one its limb turns about without going anywhere."""

from collections.abc import Mapping
from dataclasses import replace
from itertools import combinations

import numpy as np

from kinesphere.data import Json
from kinesphere.geometry.rotations import mean_rotation
from kinesphere.parameterization.anatomy import N_AXES, body_axes, joint_kind
from kinesphere.parameterization.angles import solve_angles
from kinesphere.parameterization.axes.fit import thinned
from kinesphere.parameterization.axes.registry import BY_ORIENTATION
from kinesphere.parameterization.axes.twist_phases import TwistAxis, find_twist_axis
from kinesphere.parameterization.axis_figures import PER_AXIS, listed_in
from kinesphere.parameterization.confidence import observed_n_axes
from kinesphere.parameterization.joint import asked_n_axes, fit_joint
from kinesphere.parameterization.joint_angles import larger_excursion_positive
from kinesphere.parameterization.joint_fit import JointFit, angles_between, or_null
from kinesphere.parameterization.samples import Phase
from kinesphere.parameterization.second_axis import cone_spread, second_axis
from kinesphere.parameterization.settings import ParameterizationSettings
from kinesphere.parameterization.view import JointView, view_joint
from kinesphere.parameterization.zero import OUT_OF_REACH

LARGELY = 0.25  # of the frames: so often near a singular pose, three angles tell less than two
TOLD = 0.9  # of the frames must tell the twist


def fit_axes(view: JointView, settings: ParameterizationSettings) -> JointFit:
    """Find all axes of one joint, and its rest orientation.

    One or two move the limb (`fit_joint`). Where it also turns about itself on purpose
    (`find_twist_axis`), the axis of that, fixed in the child, is axis 1 of three, the most distal
    one; no twist is left over, and the twist phases have no say about the other two. A
    hinge that does so gets an axis across both, as the elbow of ISB has between flexion and
    pronation (Wu et al. 2005, doi:10.1016/j.jbiomech.2004.05.042). Phases that are about an axis
    which moves the limb anyway tell no third (`_explained`). Where the user says how many
    axes a joint has, it has those; of three, those that no movement tells are put beside the
    others (`_with_limb_line`). One axis found where nobody named the joint gives way to two that
    are sure, if the limb leaves its cone.

    Parameters
    ----------
    view
        The joint.
    settings
        Methods and limits.
    """
    asked = asked_n_axes(view.name, settings.axes)
    if asked in (None, 3) and settings.axes.method in BY_ORIENTATION:
        told = view.twist_known[view.calibration]
        enough = len(told) > 0 and told.mean() >= TOLD
        twist = find_twist_axis(view.samples, settings) if enough else None
        explained: tuple[Phase, ...] = ()
        while twist is not None:
            calm = _without(view, twist, settings)
            kind = joint_kind(view.name)
            swings = N_AXES[kind] if kind else observed_n_axes(calm.samples)
            fit = fit_joint(calm, settings, swings)
            if fit.source != "movement" or fit.doubts:
                break
            if again := _explained(view, fit, twist, settings):
                explained += again
                twist = find_twist_axis(view.samples, settings, explained)
                continue
            joined = _joined(view, fit, twist, settings)
            if joined is not None and _serves(view, joined, settings):
                return joined
            break
    fit = fit_joint(view, settings)
    if asked == 3 and fit.source == "body":
        return _with_limb_line(view, settings) or fit
    if asked is None and joint_kind(view.name) is None and len(fit.axes) == 1:
        # a limb that turns on and on about one axis hides that it swings about another
        spread = np.rad2deg(cone_spread(view.samples.positions, fit.axes[0]))
        if spread > settings.axes.largest_spread:
            two = fit_joint(view, settings, 2)
            if two.source == "movement" and not two.doubts:
                return replace(two, findings={**two.findings, "n_axes_by_data": 2})
    return fit


def _with_limb_line(view: JointView, settings: ParameterizationSettings) -> JointFit | None:
    """Return what the movement tells with the limb's own line as axis 1; None where it is nothing.

    For a user who asked for three axes where fewer are seen to move.
    """
    kind = joint_kind(view.name)
    line = TwistAxis(view.long_axis, (), np.nan, np.nan, np.nan)
    swings = (N_AXES[kind] if kind else observed_n_axes(view.samples)) or 2
    fits = [fit_joint(view, settings, 2)]
    if swings == 1 and fits[0].n_told < 2:  # a hinge's axis is known better as its only one
        fits.insert(0, fit_joint(view, settings, 1))
    for fit in fits:
        if fit.source == "movement":
            return _joined(view, fit, line, settings)
    return None


def _explained(
    view: JointView, fit: JointFit, twist: TwistAxis, settings: ParameterizationSettings
) -> tuple[Phase, ...]:
    """Return the twist phases that are about one of the axes which move the limb.

    A limb that lies along its proximal axis turns about itself where it turns about that. Where no
    name tells which axis is the proximal one, either may be.
    """
    fixed = fit.axes if joint_kind(view.name) is None else fit.axes[-1:]
    near = np.cos(np.deg2rad(settings.axes.smallest_angle))
    found = []
    for phase in twist.phases:
        posture = mean_rotation(view.samples.rotations[thinned(phase)])
        if np.abs(fixed @ posture @ twist.axis).max() > near:
            found.append(phase)
    return tuple(found)


def _serves(view: JointView, fit: JointFit, settings: ParameterizationSettings) -> bool:
    """Return whether three axes reach every pose and are hardly ever singular."""
    solved = solve_angles(
        view.samples.rotations,
        fit.axes,
        fit.rest,
        view.long_axis,
        view.twist_known[view.calibration],
        settings.angles,
        settings.twist,
        view.samples.rate,
    )
    far = solved.excess > np.deg2rad(settings.angles.unreachable)
    edge = solved.sines < np.sin(np.deg2rad(settings.angles.singular))
    return bool(far.mean() <= OUT_OF_REACH and edge.mean() <= LARGELY)


def _without(view: JointView, twist: TwistAxis, settings: ParameterizationSettings) -> JointView:
    """Return the joint without the frames of its twist phases among those that count."""
    frames = np.flatnonzero(view.calibration)
    calibration = view.calibration.copy()
    for a, b in twist.phases:
        calibration[frames[a:b]] = False
    return view_joint(
        view.name,
        view.rotations,
        view.long_axis,
        view.twist_known,
        view.samples.rate,
        calibration,
        settings,
        view.human,
        view.smoothed,
        view.neighbours,
    )


def _joined(
    view: JointView, fit: JointFit, twist: TwistAxis, settings: ParameterizationSettings
) -> JointFit | None:
    """Return the joint with its twist axis as axis 1; None where two axes would be one."""
    body = body_axes(view.name)
    about = fit.rest @ twist.axis
    if body is not None and about @ body[2] < 0:
        about = -about
    swings, uncertainty, assumed = fit.axes, fit.uncertainty, fit.assumed
    put = not twist.phases  # nothing was measured of it
    between = 3 - 1 - len(swings)
    if between:
        side = np.cross(swings[0], about) if body is None else body[1]
        swings = np.array([second_axis(swings[0], about, side), swings[0]])
        uncertainty, assumed = np.array([np.nan, uncertainty[0]]), (put, True, False)
    elif assumed or put:
        assumed = (put, *(assumed or (False, False)))
    axes = np.array([about, *swings])
    closest = max(abs(float(a @ b)) for a, b in combinations(axes, 2))
    if closest > np.cos(np.deg2rad(settings.axes.smallest_angle)):
        return None
    if body is None:
        axes = larger_excursion_positive(view, axes, fit.rest, settings)
    uncertainty = np.array([twist.uncertainty, *uncertainty])
    halves = float(np.rad2deg(twist.halves))
    own: list[Json] = [float(np.rad2deg(twist.range)), twist.conditioning, halves, 0.0]
    if put:
        own = [None] * len(own)
    observed = fit.findings["n_axes_by_data"]
    spans: list[Json] = [list(t) for t in view.samples.with_phases(twist.phases).phase_times]
    swung = listed_in(fit.findings, "phases_s")
    findings: Mapping[str, Json] = {
        **fit.findings,
        "n_axes": 3,
        "n_axes_by_data": observed + (not put) if isinstance(observed, int) else None,
        "axes_uncertainty_deg": or_null(np.rad2deg(uncertainty)),
        "axes_apart_deg": angles_between(axes),
        "phases_s": sorted([*swung, *spans], key=_start),
        "twist_phases_s": spans,
        "twist_axis_off_limb_deg": float(
            np.rad2deg(np.arccos(min(1.0, float(twist.axis @ view.long_axis))))
        ),
        **{
            name: [value, *[None] * between, *listed_in(fit.findings, name)]
            for name, value in zip(PER_AXIS, own, strict=True)
        },
    }
    return replace(fit, axes=axes, uncertainty=uncertainty, findings=findings, assumed=assumed)


def _start(span: Json) -> float:
    return float(span[0]) if isinstance(span, list) and isinstance(span[0], float) else 0.0
