"""The page's tables: what was found and the figures that tell whether to trust it."""

from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from kinesphere.data import Array, Joint, JointFlag, Json, PoseFlag, Solution, Step
from kinesphere.data.sticks import side_of
from kinesphere.report.axes_words import axes_in_detail
from kinesphere.report.notices import Notice, names_of, notices
from kinesphere.report.wording import counted, finding_in_words, number_in_words

UNSURE = 10.0  # deg, standard deviation of an axis from which on the body's is no worse
OUT_OF_REACH = 0.05  # of the frames; about axes a person has, the limb goes wherever it goes


@dataclass(frozen=True)
class Tile:
    """One figure at the top of the page."""

    name: str
    value: str
    aside: str = ""


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


@dataclass(frozen=True)
class LimbRow:
    """What a person needs to know of one limb."""

    name: str
    length: str
    other_side: str
    """Difference to the same limb of the other side."""
    markers: str
    residual: str
    measured: str
    unseen: str


@dataclass(frozen=True)
class FindingTable:
    """What a step found of each joint or limb."""

    name: str
    header: tuple[str, ...]
    rows: tuple[tuple[str, ...], ...]


@dataclass(frozen=True)
class StepCard:
    """One step of the history."""

    name: str
    seconds: str
    findings: tuple[tuple[str, str], ...]
    tables: tuple[FindingTable, ...]
    warnings: tuple[Notice, ...]
    settings: tuple[tuple[str, str], ...]
    version: str


def rms(values: Array) -> float:
    """Return the root mean square of what is no NaN; NaN of nothing."""
    known = values[np.isfinite(values)]
    return float(np.sqrt(np.mean(known**2))) if len(known) else float("nan")


def tiles(solution: Solution) -> list[Tile]:
    """Return the figures that sum up a solution."""
    motion, parameters = solution.motion, solution.parameters
    joints = solution.skeleton.joints
    sure = sum(joint.observability in ("determined", "given") for joint in joints)
    centres = [joint.residual * 1e3 for joint in joints if np.isfinite(joint.residual)]
    return [
        Tile(
            "Recording",
            number_in_words(motion.n_frames / motion.rate, "s"),
            f"{counted(motion.n_frames, 'frame')} at {motion.rate:g} Hz",
        ),
        Tile(
            "Skeleton",
            f"{len(motion.skeleton.limbs)} limbs",
            f"model {solution.model_name}",
        ),
        Tile("Limb fit", _mm(rms(motion.residuals)), "rms, markers against rigid limbs"),
        Tile(
            "Joint centres",
            _mm(float(np.median(centres)) / 1e3 if centres else float("nan")),
            f"median residual; {sure} of {len(joints)} fixed by the motion",
        ),
        Tile("Rebuilt", _mm(rms(parameters.residuals)), "rms, limb mid points from the parameters"),
        Tile("Seen", f"{motion.seen.mean():.1%}", "of all limb poses"),
    ]


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
        twin = _other_side(joint.name)
        for name in (joint.name, twin) if joint.side == "left" else (twin, joint.name):
            if name in waiting:
                paired.append(waiting.pop(name))
    return [*middle, *paired]


def limb_rows(solution: Solution) -> list[LimbRow]:
    """Return one row a limb, root first."""
    motion, lengths = solution.motion, {limb.name: limb.length for limb in solution.skeleton.limbs}
    rows = []
    for i, limb in enumerate(solution.skeleton.limbs):
        flags = motion.flags[:, i]
        own = np.isin(flags, (PoseFlag.MEASURED, PoseFlag.JOINT_AIDED)).mean()
        rows.append(
            LimbRow(
                name=in_words(limb.name),
                length=number_in_words(limb.length * 1e3, "mm", digits=4),
                other_side=_against_other_side(limb.name, lengths),
                markers=", ".join(limb.markers),
                residual=_mm(rms(motion.residuals[:, i])),
                measured=f"{own:.1%}",
                unseen=f"{(flags == PoseFlag.UNSEEN).mean():.1%}",
            )
        )
    return rows


def step_cards(solution: Solution) -> list[StepCard]:
    """Return one card a step, in the order things were done."""
    cards = []
    for step in solution.history:
        seconds = solution.seconds.get(step.name)
        cards.append(
            StepCard(
                name=in_words(step.name),
                seconds="" if seconds is None else number_in_words(seconds, "s"),
                findings=tuple(
                    finding_in_words(k, v) for k, v in step.findings.items() if not _is_table(v)
                ),
                tables=tuple(_table(k, v) for k, v in step.findings.items() if _is_table(v)),
                warnings=tuple(notices(step.warnings, names_of(solution.skeleton))),
                settings=settings_rows(step),
                version=step.version,
            )
        )
    return cards


def settings_rows(step: Step) -> tuple[tuple[str, str], ...]:
    """Return every setting of a step as text, nested ones as ``stage.key``."""
    return tuple(_flat(step.settings))


def in_words(name: str) -> str:
    """Return a name as a person writes it: ``left_upper_arm`` → ``left upper arm``."""
    return name.replace("_", " ")


def _is_table(value: Json) -> bool:
    return isinstance(value, dict) and any(isinstance(row, dict) for row in value.values())


def _table(name: str, found: Any) -> FindingTable:
    """Return a dictionary of dictionaries as rows; lists and further dictionaries stay out."""
    entries = {key: row for key, row in found.items() if isinstance(row, dict)}
    keys = dict.fromkeys(
        key
        for row in entries.values()
        for key, value in row.items()
        if not isinstance(value, dict | list)
    )
    return FindingTable(
        name=in_words(name),
        header=tuple(finding_in_words(key, None)[0] for key in keys),
        rows=tuple(
            (in_words(entry), *(finding_in_words(key, row.get(key))[1] for key in keys))
            for entry, row in entries.items()
        ),
    )


def _flat(settings: Any, above: str = "") -> list[tuple[str, str]]:
    rows: list[tuple[str, str]] = []
    for key, value in settings.items():
        if isinstance(value, dict):
            rows += _flat(value, f"{above}{key}.")
        else:
            rows.append((f"{above}{key}", finding_in_words("", value, listed=20)[1]))
    return rows


def _joint_row(solution: Solution, j: int, joint: Joint) -> JointRow:
    parameters = solution.parameters
    flags = parameters.flags[:, j]
    known = {flag: (flags & flag).astype(bool).mean() for flag in JointFlag if (flags & flag).any()}
    uncertainty = joint.axes_uncertainty
    axes = f"{joint.n_axes} from {joint.axes_source}" if joint.axes_source else "–"
    if uncertainty is not None and np.isfinite(uncertainty).any():
        axes += f", ± {np.rad2deg(np.nanmax(uncertainty)):.1f}°"
    return JointRow(
        name=in_words(joint.name),
        index=j,
        side=side_of(joint.name),
        n_axes=joint.n_axes,
        parent=in_words(joint.parent),
        child=in_words(joint.child),
        residual=_mm(joint.residual),
        range_of_motion=number_in_words(np.rad2deg(joint.range_of_motion), "°"),
        observability=joint.observability,
        note=joint.note,
        axes=axes,
        axes_note=axes_in_detail(joint.name, parameters.history),
        angles=tuple(
            degrees_span(np.rad2deg(values))
            for values in (*parameters.angles[:, j].T, parameters.twists[:, j])
        ),
        rebuilt=_mm(rms(parameters.residuals[:, j])),
        flagged=", ".join(
            f"{in_words(str(flag.name).lower())} {share:.1%}" for flag, share in known.items()
        ),
        trust=_trust(joint, known.get(JointFlag.UNREACHABLE, 0.0)),
    )


def _trust(joint: Joint, unreachable: float) -> str:
    """Judge a joint by what its centre and axes rest on; 15 mm is half a knee's width of skin."""
    if joint.observability in ("undetermined",) or joint.residual > 0.030:
        return "poor"
    if joint.observability == "hinge" or joint.residual > 0.015 or joint.axes_source == "body":
        return "fair"
    known = np.asarray(() if joint.axes_uncertainty is None else joint.axes_uncertainty)
    loose = bool((known > np.deg2rad(UNSURE)).any())  # NaN, nothing told, is not
    return "fair" if loose or unreachable > OUT_OF_REACH else "good"


def degrees_span(degrees: Array) -> str:
    """Return 5 % … 95 % of what is no NaN, (n_frames,) in degrees."""
    known = degrees[np.isfinite(degrees)]
    if not len(known):
        return "–"
    low, high = (float(v) for v in np.percentile(known, [5, 95]))
    return f"{round(low)}° … {round(high)}°"  # round() knows no -0


def _mm(metres: float) -> str:
    return number_in_words(metres * 1e3, "mm")


def _against_other_side(name: str, lengths: dict[str, float]) -> str:
    own, twin = lengths[name], lengths.get(_other_side(name), np.nan)
    if not (np.isfinite(own) and np.isfinite(twin)) or name == _other_side(name):
        return ""
    return f"{2 * (own - twin) / (own + twin):+.1%}"


def _other_side(name: str) -> str:
    """Return the name of the limb or joint of the other side, in either spelling."""
    for side, other in (("left", "right"), ("right", "left")):
        if name.startswith((f"{side}_", f"{side} ")):
            return other + name.removeprefix(side)
    return name
