"""Section 6: how far two halves of a recording agree, where nobody knows the truth."""

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from benchmarks.axes.bars import Bar, number
from benchmarks.axes.measures import Array, found_at_joints, line_angles, matched, mirrored
from kinesphere.data import Joint, Motion, Parameters
from kinesphere.parameterization import AxesSettings, ParameterizationSettings, n_told, parameterize
from kinesphere.parameterization.anatomy import wanted_n_axes

KNEES_AGREE, SIDES_AGREE, CONTRADICTION = 1.5, 10.0, 10.0
FUNCTIONAL = ("hip", "knee", "ankle")
KEEP = ParameterizationSettings(axes=AxesSettings(on_doubt="movement"))


def half_rows(motion: Motion, whole: Parameters) -> list[dict[str, Any]]:
    """Return for each joint how far axes from the first and the second half are apart.

    Halves keep doubtful axes, so that disagreement shows; whether the whole recording's axes are
    from the movement, and what was said about them, stands beside.
    """
    end, middle = motion.times[-1], motion.times[-1] / 2
    windows = ((0.0, middle), (middle, end))
    # a half that moves about one axis alone is asked for both, that like be compared with like
    two = (joint.name for joint in whole.skeleton.joints if _kept(joint) is not None)
    keep = replace(KEEP, axes=replace(KEEP.axes, counts=", ".join(f"{name}=2" for name in two)))
    halves = [parameterize(motion, keep, calibration=window) for window in windows]
    carried = parameterize(motion, keep, reuse=halves[0].skeleton)
    second = motion.times >= middle
    told = found_at_joints(whole.history)
    rows = []
    for j, joint in enumerate(whole.skeleton.joints):
        first, last = (half.skeleton.joints[j] for half in halves)
        findings = told[joint.name]
        row: dict[str, Any] = {
            "joint": joint.name,
            "source": joint.axes_source,
            "sources": list(joint.axes_sources),
            "n_axes_by_data": findings.get("n_axes_by_data"),
            "doubts": findings.get("doubts", []),
            "remark": findings.get("remark"),
            "axes": np.asarray(joint.axes).tolist(),
            "halves_deg": None,
            "held_out_mm": _mm(carried.residuals[second, j]),
            "own_mm": _mm(halves[1].residuals[second, j]),
        }
        if "twist_axis_off_limb_deg" in findings:
            row["twist_axis"] = {
                "off_limb_deg": findings["twist_axis_off_limb_deg"],
                "range_deg": findings["ranges_deg"][0],
                "halves_deg": findings["halves_disagreement_deg"][0],
                "said_deg": findings["axes_uncertainty_deg"][0],
                "phases_s": findings["twist_phases_s"],
            }
        kept = _kept(joint)
        row["half_told"] = kept is not None
        row["enough"] = all(_enough(half, joint.name, kept) for half in halves)
        if first.axes_source == last.axes_source == "movement":
            # a second axis that one half added to a hinge, distal, is no axis of the movement
            count = min(first.n_axes, last.n_axes)
            a, b = np.asarray(first.axes)[-count:], np.asarray(last.axes)[-count:]
            order = matched(b[-2:], a[-2:]) if len(a) > 1 else [0]
            if len(a) == 3:  # the first is what the limb turns about
                order = [0, 1 + order[0], 1 + order[1]]
            row["halves_deg"] = line_angles(a, b[order]).tolist()
            if kept is not None:  # halves have a say about what the movement told
                a, b = (np.asarray(half.axes) for half in (first, last))
                row["halves_deg"] = [float(line_angles(a[_nearest(a, kept)], b[_nearest(b, kept)]))]
        rows.append(row)
    return rows


def _kept(joint: Joint) -> Array | None:
    """Return the one axis of two that the movement told, (3,); None where it told both or none."""
    if not any(joint.axes_assumed) or n_told(joint) == wanted_n_axes(joint.name):
        return None
    return np.asarray(joint.axes)[joint.axes_assumed.index(False)]


def _nearest(axes: Array, axis: Array) -> int:
    return int(line_angles(axes, axis).argmin())


def _flagged(row: Mapping[str, Any]) -> bool:
    """Return whether something was said against the axes that a movement told."""
    return bool(row["remark"] if row["half_told"] else row["doubts"])


def _enough(half: Parameters, name: str, kept: Array | None) -> bool:
    """Return whether a half moves far enough about each of its axes to speak against the whole.

    Or about the one that is nearest to the only one ``kept``, (3,).
    """
    joint = half.skeleton.joint(name)
    ranges = found_at_joints(half.history)[name].get("ranges_deg", ())
    if kept is not None and len(ranges) == joint.n_axes:
        ranges = [ranges[_nearest(np.asarray(joint.axes), kept)]]
    told = [r for r in ranges if r is not None]
    return bool(min(told, default=0.0) >= KEEP.axes.smallest_range)


def _mm(residuals: np.ndarray) -> float | None:
    known = residuals[np.isfinite(residuals)]
    return 1e3 * float(known.mean()) if len(known) else None


def functional(sources: Mapping[str, Sequence[Mapping[str, Any]]]) -> list[dict[str, Any]]:
    """Return the row of each joint in the trial that is made for it."""
    rows = []
    for kind in FUNCTIONAL:
        for side in ("left", "right"):
            trial = f"functional/Test_func_{side[0]}{kind}.c3d"
            for row in sources.get(trial, ()):
                if row["joint"] == f"{side}_{kind}":
                    rows.append({**row, "kind": kind})
    return rows


def mirror_difference(rows: Sequence[Mapping[str, Any]]) -> float | None:
    """Return the angle in deg between the left knee's axis and the mirror image of the right's."""
    axes = {row["joint"]: np.array(row["axes"][0]) for row in rows if row["kind"] == "knee"}
    if set(axes) != {"left_knee", "right_knee"}:
        return None
    return float(line_angles(axes["left_knee"], mirrored(axes["right_knee"])))


def contradictions(sources: Mapping[str, Sequence[Mapping[str, Any]]]) -> dict[str, list[str]]:
    """Return joints with axes of their own, and those whose halves contradict each other unsaid.

    A half without enough movement about each axis contradicts nothing: those stand apart, as
    untested.
    """
    given, bad, untested = [], [], []
    for name, rows in sources.items():
        for row in rows:
            if row["source"] == "movement":
                given.append(f"{name} {row['joint']}")
                if not (row["enough"] and row["halves_deg"]):
                    untested.append(given[-1])
                elif max(row["halves_deg"]) > CONTRADICTION and not _flagged(row):
                    bad.append(f"{given[-1]} ({max(row['halves_deg']):.0f}°)")
    return {"given": given, "contradicted": bad, "untested": untested}


def bars(sources: Mapping[str, Sequence[Mapping[str, Any]]]) -> list[Bar]:
    """Return what is asked of real joints."""
    rows = functional(sources)
    if not rows:
        return []
    asked = []
    for row in rows:
        if row["kind"] == "knee":
            halves = row["halves_deg"][0] if row["halves_deg"] else float("nan")
            asked.append(
                Bar(
                    "Repeatability",
                    f"{_spoken(row)}: axis, first and second half",
                    halves,
                    "deg",
                    KNEES_AGREE,
                )
            )
    difference = mirror_difference(rows)
    asked.append(
        Bar(
            "Repeatability",
            "knees: left against mirrored right",
            float("nan") if difference is None else difference,
            "deg",
            SIDES_AGREE,
        )
    )
    wrong = [r for r in rows if (r["n_axes_by_data"] == 1) != (r["kind"] == "knee")]
    asked.append(
        Bar(
            "Repeatability",
            "joints with the wrong number of axes by the data",
            float(len(wrong)),
            "",
            0,
        )
    )
    both = contradictions(sources)
    bad = both["contradicted"]
    untested, given = len(both["untested"]), len(both["given"])
    asked.append(
        Bar(
            "Repeatability",
            "joints with axes that halves contradict by more than 10°, unflagged, "
            f"of {given - untested} tested ({untested} of {given} cannot be)",
            float(len(bad)),
            "",
            0,
        )
    )
    return asked


_BEFORE = """\
## 6 Repeatability on real recordings

Trials in which one joint is moved on purpose. *Halves*: angle between axes from the first and from
the second half, doubtful ones kept. *Held out*: mean distance of the limb's mid point in the second
half with axes and rest from the first; *own*: with its own.

| joint | axes by the data | axes are from | halves, ° | held out, mm | own, mm | said about them |
|---|---:|---|---:|---:|---:|---|"""
_AFTER = """
The left knee's axis and the mirror image of the right one's are {mirror}° apart. Each is told in
the normalized frame of its own thigh and its own trial, so this holds the difference of the
person's legs as well as that of two normalizations: no pose tells which twist of a thigh is
neutral.

In all recordings together {given} joints got axes from their movement. At {untested} of them one
half moves too little to tell: nothing tests those. Of the other {tested}, halves contradict each
other by more than 10° at {bad} although nothing was said{which}. All other joints have axes of the
body frame, with the reason among the warnings.
"""


def page(sources: Mapping[str, Sequence[Mapping[str, Any]]]) -> str:
    """Return the section."""
    rows = functional(sources)
    if not rows:
        return "## 6 Repeatability on real recordings\n\nNo real recordings were there.\n"
    lines = [_BEFORE]
    for row in rows:
        halves = ", ".join(number(h) for h in row["halves_deg"] or []) or "–"
        cells = [
            _spoken(row),
            str(row["n_axes_by_data"] or "–"),
            _spoken_sources(row["sources"]),
            halves,
            _shown_mm(row["held_out_mm"]),
            _shown_mm(row["own_mm"]),
            "; ".join(row["doubts"]),
        ]
        lines.append("| " + " | ".join(cells) + " |")
    both = contradictions(sources)
    bad = both["contradicted"]
    lines.append(
        _AFTER.format(
            mirror=number(mirror_difference(rows)),
            given=len(both["given"]),
            bad=len(bad),
            untested=len(both["untested"]),
            tested=len(both["given"]) - len(both["untested"]),
            which=" (" + ", ".join(bad) + ")" if bad else "",
        )
    )
    return "\n".join(lines)


def _spoken_sources(sources: Sequence[str]) -> str:
    """Return where axes are from in a word, or of each axis."""
    return sources[0] if len(set(sources)) == 1 else ", ".join(sources)


def _shown_mm(value: float | None) -> str:
    return number(0.0 if value is not None and value < 5e-4 else value)


def _spoken(row: Mapping[str, Any]) -> str:
    return str(row["joint"]).replace("_", " ")
