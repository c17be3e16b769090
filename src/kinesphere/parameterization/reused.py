"""Axes from another recording: what was found of them there, and where own ones serve instead."""

from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np

from kinesphere.data import Json, Skeleton
from kinesphere.parameterization.anatomy import n_told, wanted_n_axes
from kinesphere.parameterization.giving_way import there_or_own
from kinesphere.parameterization.joined import counterpart, joined, told_axes
from kinesphere.parameterization.joint_fit import JointFit
from kinesphere.parameterization.settings import ParameterizationSettings
from kinesphere.parameterization.third_axis import fit_axes
from kinesphere.parameterization.view import JointView
from kinesphere.parameterization.zero import OUT_OF_REACH, reach_and_twist

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
    "alike_deg",
    "other_reading_deg",
    "held_out_deg",
    "held_out_body_deg",
    "twist_axis_off_limb_deg",
)
"""Findings about axes that hold wherever they are used; times and residuals do not."""


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
    view: JointView,
    reuse: Skeleton | None,
    settings: ParameterizationSettings,
    *,
    give_way: bool = False,
) -> JointFit:
    """Return a joint's axes from another solution, or from its own movement if that tells more.

    With ``give_way`` also where those from there are doubtful or plainly wrong (`there_or_own`).
    What was only assumed there may be measured here: of two axes that alone, beside the other from
    there, where the limb can be followed about the two.
    """
    there = reused_fit(view.name, reuse)
    if there is None:
        return fit_axes(view, settings)
    if not there.half_told:
        return there_or_own(there, None, view, settings, give_way=give_way)
    own = fit_axes(view, settings)
    if own.n_told > there.n_told:
        return own
    both = _with_own(there, own, view, settings)
    if both is not None:
        return both
    return there_or_own(there, own, view, settings, give_way=give_way)


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


def not_reused(own: Sequence[str], reuse: Skeleton | None) -> tuple[str, ...]:
    """Return of which joints that have their own axes nothing is told to be reused, or less."""
    if reuse is None:
        return ()
    less = [name for name in own if reused_fit(name, reuse) is not None]
    none = [name for name in own if name not in less]
    warnings = []
    if none:
        named = ", ".join(none)
        warnings.append(f"no recording to be reused measured axes of {named}; theirs are from here")
    if less:
        named = ", ".join(less)
        warnings.append(f"more axes of {named} are told here than to be reused; they are from here")
    return tuple(warnings)


def told_of(name: str, skeleton: Skeleton) -> Mapping[str, Json]:
    """Return what the parameterization in a skeleton's history found at a joint."""
    for step in reversed(skeleton.history):
        joints = step.findings.get("joints") if step.name == "parameterization" else None
        if isinstance(joints, Mapping):
            found = joints.get(name)
            return found if isinstance(found, Mapping) else {}
    return {}
