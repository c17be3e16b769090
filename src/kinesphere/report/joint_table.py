"""The table of joints: the figures that tell whether to trust each of them."""

from dataclasses import dataclass, replace

import numpy as np

from kinesphere.data import Joint, JointFlag, Solution
from kinesphere.data.sticks import side_of
from kinesphere.report.axes_words import axes_in_detail, origins_in_words
from kinesphere.report.limb_table import other_side
from kinesphere.report.tiles import rms
from kinesphere.report.wording import degrees_span, in_words, millimetres, number_in_words

UNSURE = 10.0  # deg, standard deviation of an axis from which on the body's is no worse
OUT_OF_REACH = 0.05  # of the frames; about axes a person has, the limb goes wherever it goes


@dataclass(frozen=True)
class JointRow:
    """What a person needs to know of one joint."""

    name: str
    index: int
    side: str
    """``left``, ``right``, ``middle``, or ``alone`` where its chart has no neighbour."""
    n_axes: int
    parent: str
    child: str
    residual: str
    """mm, rms distance between the centre seen from both sides."""
    range_of_motion: str
    observability: str
    note: str
    axes: str
    """Where the axes come from and how sure they are."""
    axes_note: str
    """How well each of them is determined."""
    angles: tuple[str, ...]
    """5 % … 95 % of each angle and of the twist, in degrees."""
    rebuilt: str
    """mm, rms distance of the limb's mid point rebuilt from the parameters."""
    flagged: str
    trust: str
    """``good``, ``fair`` or ``poor``: the dot before the name."""


def joint_rows(solution: Solution) -> list[JointRow]:
    """Return one row a joint, in skeleton order."""
    return [_joint_row(solution, j, joint) for j, joint in enumerate(solution.skeleton.joints)]


def chart_order(joints: list[JointRow]) -> list[JointRow]:
    """Return the joints as their charts are laid out in two columns: left beside right.

    Joints of the middle come first; the last of an odd number of them takes the whole row.
    """
    middle = [joint for joint in joints if joint.side == "middle"]
    if len(middle) % 2:
        middle[-1] = replace(middle[-1], side="alone")
    paired: list[JointRow] = []
    waiting = {joint.name: joint for joint in joints if joint.side != "middle"}
    for joint in [joint for joint in joints if joint.side != "middle"]:
        twin = other_side(joint.name)
        for name in (joint.name, twin) if joint.side == "left" else (twin, joint.name):
            if name in waiting:
                paired.append(waiting.pop(name))
    return [*middle, *paired]


def _joint_row(solution: Solution, j: int, joint: Joint) -> JointRow:
    parameters = solution.parameters
    flags = parameters.flags[:, j]
    known = {flag: (flags & flag).astype(bool).mean() for flag in JointFlag if (flags & flag).any()}
    uncertainty = joint.axes_uncertainty
    axes = origins_in_words(joint.axes_sources, joint.axes_reused_from) or "–"
    if uncertainty is not None and np.isfinite(uncertainty).any():
        axes += f", ± {np.rad2deg(np.nanmax(uncertainty)):.1f}°"
    return JointRow(
        name=in_words(joint.name),
        index=j,
        side=side_of(joint.name),
        n_axes=joint.n_axes,
        parent=in_words(joint.parent),
        child=in_words(joint.child),
        residual=millimetres(joint.residual),
        range_of_motion=number_in_words(np.rad2deg(joint.range_of_motion), "°"),
        observability=joint.observability,
        note=joint.note,
        axes=axes,
        axes_note=axes_in_detail(joint.name, parameters.history),
        angles=tuple(
            degrees_span(np.rad2deg(values))
            for values in (*parameters.angles[:, j].T, parameters.twists[:, j])
        ),
        rebuilt=millimetres(rms(parameters.residuals[:, j])),
        flagged=", ".join(
            f"{in_words(str(flag.name).lower())} {share:.1%}" for flag, share in known.items()
        ),
        trust=_trust(joint, known.get(JointFlag.UNREACHABLE, 0.0)),
    )


def _trust(joint: Joint, unreachable: float) -> str:
    """Judge a joint by what its centre and axes rest on; 15 mm is half a knee's width of skin."""
    if joint.observability in ("undetermined",) or joint.residual > 0.030:
        return "poor"
    if joint.observability == "hinge" or joint.residual > 0.015 or "body" in joint.axes_sources:
        return "fair"
    known = np.asarray(() if joint.axes_uncertainty is None else joint.axes_uncertainty)
    loose = bool((known > np.deg2rad(UNSURE)).any())  # NaN, nothing told, is not
    return "fair" if loose or unreachable > OUT_OF_REACH else "good"
