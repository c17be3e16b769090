"""What each stage found, in a line or two for the terminal."""

from collections import Counter
from collections.abc import Callable
from typing import Any

import numpy as np

from kinesphere.cli.surface_words import surface_in_words
from kinesphere.report import counted, finding_in_words, in_words, number_in_words

MANY_HIDDEN = 0.02
"""Share of the samples of limbs' markers from which on it is said how to fill them."""


def stage_in_words(stage: dict[str, Any], summary: dict[str, Any]) -> str:
    """Return what a stage found and how good it is.

    Parameters
    ----------
    stage
        One of ``summary["stages"]``.
    summary
        As ``describe_solution`` returns it.
    """
    words = _WORDS.get(stage["name"], _any)
    told = words({**stage["settings"], **stage["findings"]}, summary)
    warnings = stage.get("warnings", ())
    return told or (f"{counted(len(warnings), 'warning')}, see below" if warnings else "")


def _any(found: dict[str, Any], _: dict[str, Any]) -> str:
    plain = [(k, v) for k, v in found.items() if isinstance(v, int | float | str) and v != ""]
    return ", ".join(" ".join(finding_in_words(k, v)) for k, v in plain[:5])


def _read(found: dict[str, Any], summary: dict[str, Any]) -> str:
    kind = [str(found.get("format", "")).upper(), found.get("encoding"), found.get("unit")]
    head = ", ".join(str(word) for word in kind if word)
    return f"{head}, {counted(summary['n_frames'], 'frame')} at {summary['rate_hz']:g} Hz".lstrip(
        ", "
    )


def _labelling(found: dict[str, Any], summary: dict[str, Any]) -> str:
    text = (
        f"model {summary['model']}: {found.get('required_found')} of {found.get('required')} "
        "labels are there"
    )
    if found.get("subject"):
        text += f", subject {found['subject']}"
    if missing := found.get("missing"):
        text += f"; missing {', '.join(missing[:6])}" + (", …" if len(missing) > 6 else "")
    if extra := found.get("extra"):
        text += f"; {len(extra)} more not used"
    return text


def _discovery(found: dict[str, Any], summary: dict[str, Any]) -> str:
    trees, n_loose = found.get("trees", 1), len(found.get("loose", ()))
    text = f"{_bodies(found.get('bodies_found'))} from motion alone"
    if trees > 1:
        text += f" in {counted(trees, 'tree')}"
    named = sum(not limb.startswith("limb_") for limb in summary["limbs"])
    sure = found.get("names_confidence")
    text += f"; {counted(named, 'limb')} named" if named else "; no limb named"
    text += "" if sure is None else f" (confidence {sure:.2f})"
    if n_loose:
        text += f"; {counted(n_loose, 'marker')} loose"
    return text


def _bodies(n: object) -> str:
    return "1 body" if n == 1 else f"{n} bodies"


def _orientation(found: dict[str, Any], _: dict[str, Any]) -> str:
    text = f"up was {found.get('up')}, {source_in_words(found.get('up_from'))}"
    return text + ("; mirrored, turned right" if found.get("mirrored") else "")


def _scene(found: dict[str, Any], summary: dict[str, Any]) -> str:
    cameras = found.get("cameras", [])
    return (
        f"{counted(len(cameras), 'camera')} ({', '.join(map(str, cameras[:4]))}"
        f"{', …' if len(cameras) > 4 else ''}), {counted(summary['n_frames'], 'frame')} at "
        f"{summary['rate_hz']:g} Hz; {found.get('unit')}, up was {found.get('up')}"
    )


def _scene_checks(found: dict[str, Any], _: dict[str, Any]) -> str:
    if not found.get("checked"):
        return "nothing to check calibration and offsets with"
    apart = found.get("disagreement_px")
    if apart is None or not np.isfinite(apart):
        return "no silhouettes in two cameras at once"
    return f"silhouettes of the cameras contradict each other by {number_in_words(apart, 'px')}"


def _track(found: dict[str, Any], _: dict[str, Any]) -> str:
    text = f"{found.get('model')} body, {found.get('method')} method, start: {found.get('start')}"
    return text + (", doubtful" if found.get("start_doubt") else "")


def _tracking_result(found: dict[str, Any], summary: dict[str, Any]) -> str:
    overlap = found.get("overlap_mean")
    lost = {k: n for k, n in found.get("frames_lost_of_limb", {}).items() if n}
    text = f"{found.get('n_solved')} of {found.get('n_frames')} frames"
    if overlap is not None:
        text += f", overlap {overlap:.2f}"
    if lost:
        worst = max(lost, key=lambda name: lost[name])
        frames = counted(lost[worst], "frame")
        return text + f"; {counted(len(lost), 'limb')} lost at times, most {worst} ({frames})"
    stages = summary.get("stages", ())
    doubted = any(stage["findings"].get("start_doubt") for stage in stages)
    return text + (
        "; no limb held lost, but the start is doubtful" if doubted else "; no limb lost"
    )


def _editing(found: dict[str, Any], _: dict[str, Any]) -> str:
    joints = ", ".join(f"{joint} in {counted(n, 'frame')}" for joint, n in found["frames"].items())
    return f"{counted(len(found['edits']), 'edit')}: {joints}"


def source_in_words(source: object) -> str:
    """Return what told which way is up: the file, the body, the user, or nothing."""
    return "assumed" if source in (None, "assumed") else f"from the {source}"


def _skeleton(found: dict[str, Any], summary: dict[str, Any]) -> str:
    joints = summary["joint_findings"]
    kinds = Counter(joint["observability"] for joint in joints)
    told = ", ".join(f"{n} {kind}" for kind, n in kinds.most_common())
    limbs = counted(len(summary["limbs"]), "limb")
    known = [joint for joint in joints if np.isfinite(joint["residual_mm"])]
    text = (
        f"{limbs} {'fits' if limbs == '1 limb' else 'fit'} to "
        f"{_mm(summary['limb_residual_rms_mm'])} rms; "
        + (f"{counted(len(joints), 'joint centre')}: {told}" if joints else "no joints")
    )
    if known:
        worst = max(known, key=lambda joint: joint["residual_mm"])
        median = float(np.median([joint["residual_mm"] for joint in known]))
        of = f" of {len(known)}" if len(known) < len(joints) else ""
        text += f"; apart {_mm(median)} (median{of}), "
        text += f"{_mm(worst['residual_mm'])} ({worst['name']})"
    hidden = found.get("hidden_share") or 0.0
    if hidden >= MANY_HIDDEN and not found.get("fill_markers"):
        text += (
            f"; {hidden:.0%} of marker samples hidden and left so: "
            "--set skeleton.fill_markers=true fills them from the limbs' poses"
        )
    return text


def _normalization(found: dict[str, Any], _: dict[str, Any]) -> str:
    parts = []
    if "default_time_s" in found:
        n = found.get("n_frames_averaged", 1)
        parts.append(
            f"default position at {number_in_words(found['default_time_s'], 's')}, "
            f"{counted(n, 'frame')} averaged"
        )
    if isinstance(found.get("facing"), dict):
        decided = str(found["facing"].get("decided_by"))
        parts.append(f"facing {'' if decided.startswith('assumed') else 'by '}{decided}")
    if found.get("good_default_position") is False:
        parts.append("not a good one (see below)")
    return "; ".join(parts)


def _calibration(found: dict[str, Any], _: dict[str, Any]) -> str:
    if span := found.get("window_s"):
        return f"window {span[0]:g}–{span[1]:g} s; {found['used_s']:.4g} s of it are recorded"
    sources: dict[str, list[str]] = {}
    for joint, origins in (found.get("axes_from") or {}).items():
        whole = len(set(origins.values())) == 1
        for axis, name in list(origins.items())[: 1 if whole else None]:
            if name is not None:
                part = in_words(joint) if whole else f"{in_words(joint)} ({in_words(axis)})"
                sources.setdefault(str(name), []).append(part)
    told = "; ".join(f"{name}: {', '.join(parts)}" for name, parts in sorted(sources.items()))
    if not told:
        return "no axes of other recordings"
    several = len(found.get("recordings", ())) > 1
    return f"axes known best by {told}" if several else f"axes of {told}"


def _parameterization(_: dict[str, Any], summary: dict[str, Any]) -> str:
    sources = Counter(joint["axes_from"] for joint in summary["joint_findings"])
    said = {
        "movement": "by their own movements",
        "body": "of the body frame",
        "reused": "of another recording",
        "given": "given",
    }
    told = ", ".join(f"{n} {said.get(str(s), str(s))}" for s, n in sources.most_common())
    n_axes = sum(joint["n_axes"] for joint in summary["joint_findings"])
    if not told:
        return "no joints, so no axes"
    axes = "1 axis" if n_axes == 1 else f"{n_axes} axes"
    rebuilt = f"{counted(len(summary['limbs']), 'limb')} rebuilt to "
    return f"{axes}, joints: {told}; {rebuilt}{_mm(summary['rebuilt_residual_rms_mm'])} rms"


def _mm(value: float) -> str:
    return number_in_words(value, "mm")


_WORDS: dict[str, Callable[[dict[str, Any], dict[str, Any]], str]] = {
    "read": _read,
    "labelling": _labelling,
    "discovery": _discovery,
    "orientation": _orientation,
    "skeleton": _skeleton,
    "calibration": _calibration,
    "normalization": _normalization,
    "parameterization": _parameterization,
    "editing": _editing,
    "surface": surface_in_words,
    "scene": _scene,
    "scene checks": _scene_checks,
    "track": _track,
    "tracking result": _tracking_result,
}
