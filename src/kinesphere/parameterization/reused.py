"""Axes from another recording: what was doubted of them there, and whether they fit here."""

from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from kinesphere.data import Array, Json, Skeleton
from kinesphere.parameterization.anatomy import n_told, wanted_n_axes
from kinesphere.parameterization.angles import JointAngles
from kinesphere.parameterization.joined import counterpart, joined, told_axes
from kinesphere.parameterization.joint import OUT_OF_REACH, solve_joint
from kinesphere.parameterization.joint_fit import JointFit
from kinesphere.parameterization.settings import ParameterizationSettings
from kinesphere.parameterization.third_axis import fit_axes
from kinesphere.parameterization.view import JointView
from kinesphere.parameterization.zero import reach_and_twist

CARRIED = (
    "n_axes_by_data",
    "axes_method",
    "doubts",
    "remark",
    "axes_uncertainty_deg",
    "axes_apart_deg",
    "ranges_deg",
    "conditioning",
    "explained",
    "halves_disagreement_deg",
    "other_reading_deg",
    "held_out_deg",
    "held_out_body_deg",
    "twist_axis_off_limb_deg",
)
"""Findings about axes that hold wherever they are used; times and residuals do not."""
WORSE = 2.0  # times: so much farther off than the recording's own axes, at least
FAR = np.deg2rad(2.0)  # rms, and farther than they by as much: less is how a limb is dressed


def reused_fit(name: str, reuse: Skeleton | None) -> JointFit | None:
    """Return a joint's axes from another solution; None if it measured none of that name.

    Doubts of that solution's history stay doubts, axes put across others stay assumed.
    """
    if reuse is None or name not in reuse.joint_names:
        return None
    joint = reuse.joint(name)
    if joint.axes is None or joint.rest is None or joint.axes_source == "body":
        return None  # what was assumed there may be measured here
    unknown = np.full(joint.n_axes, np.nan)
    uncertainty = unknown if joint.axes_uncertainty is None else joint.axes_uncertainty
    told = told_of(name, reuse)
    findings: dict[str, Json] = {key: told[key] for key in CARRIED if key in told}
    findings |= {"n_axes": joint.n_axes, "axes_source": "reused"}
    doubts = findings.get("doubts")
    said = tuple(str(doubt) for doubt in doubts) if isinstance(doubts, list | tuple) else ()
    return JointFit(
        joint.axes,
        joint.rest,
        "reused",
        uncertainty,
        findings,
        said,
        assumed=joint.axes_assumed,
        half_told=any(joint.axes_assumed) and n_told(joint) < wanted_n_axes(name),
        reused_from=joint.axes_reused_from,
    )


def own_or_reused(
    view: JointView, reuse: Skeleton | None, settings: ParameterizationSettings
) -> JointFit:
    """Return a joint's axes from another solution, or from its own movement if that tells more.

    What was only assumed there may be measured here: of two axes that alone, beside the other from
    there, where the limb can be followed about the two.
    """
    there = reused_fit(view.name, reuse)
    if there is not None and not there.half_told:
        return there
    own = fit_axes(view, settings)
    if there is None or own.n_told > there.n_told:
        return own
    both = _with_own(there, own, view, settings)
    return there if both is None else both


def _with_own(
    there: JointFit, own: JointFit, view: JointView, settings: ParameterizationSettings
) -> JointFit | None:
    """Return a half told joint with the axis that this recording tells in place of the assumed one.

    The rest orientation is that of the recording which tells the distal axis (`joined`).
    """
    if len(there.axes) != 2 or not own.half_told:
        return None
    closest = np.deg2rad(settings.axes.smallest_angle)
    place = there.assumed.index(True)
    for k in told_axes(own, view.name):
        if counterpart(own, k, there, view.name) == place:
            both = joined(there, own, place, k, closest)
            if both is None:
                return None
            both = replace(both, rest=own.rest if place == 0 else there.rest)
            share, _ = reach_and_twist(view, both.axes, both.rest, settings)
            return None if share > OUT_OF_REACH else both
    return None


def told_of(name: str, skeleton: Skeleton) -> Mapping[str, Json]:
    """Return what the parameterization in a skeleton's history found at a joint."""
    for step in reversed(skeleton.history):
        joints = step.findings.get("joints") if step.name == "parameterization" else None
        if isinstance(joints, Mapping):
            found = joints.get(name)
            return found if isinstance(found, Mapping) else {}
    return {}


def misfit(view: JointView, solved: JointAngles, settings: ParameterizationSettings) -> str:
    """Return how reused axes miss the limb, a clause; empty where they do not.

    A limb may leave the reach of any axes a little (a hinge's cone above all); so where it does
    often, the recording's own axes, found as if none were reused, are the measure.
    """
    seen = np.isfinite(solved.excess)
    limit = np.deg2rad(settings.angles.unreachable)
    share = float((solved.excess[seen] > limit).mean()) if seen.any() else 0.0
    if share <= OUT_OF_REACH:
        return ""
    own = fit_axes(view, settings)
    theirs, ours = _rms(solved.excess), _rms(solve_joint(view, own.axes, own.rest, settings).excess)
    if theirs < max(WORSE * ours, ours + FAR):
        return ""
    return (
        f"out of their reach in {share:.0%} of the frames and {np.rad2deg(theirs):.1f}° rms off "
        f"instead of {np.rad2deg(ours):.1f}° by its own"
    )


def _rms(values: Array) -> float:
    return float(np.sqrt(np.nanmean(values**2)))
