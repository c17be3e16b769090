"""Section 4, on real recordings: limb frames of one person, laid upon each other by the markers."""

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from benchmarks.axes.bars import number
from benchmarks.axes.generator import Array
from benchmarks.axes.measures import deviations_pairwise, deviations_to_mean
from benchmarks.axes.normalization import RULES
from kinesphere.data import Motion, Skeleton
from kinesphere.geometry.rotations import nearest_rotation
from kinesphere.normalization import normalize

FOLDER = "functional/"
PARTS: Mapping[str, Sequence[str]] = {
    "pelvis, trunk": ("pelvis", "trunk"),
    "thighs, shanks": ("thigh", "shank"),
    "feet": ("foot",),
    "head": ("head",),
    "forearms": ("forearm",),
}
FEWEST = 3  # markers that tell how two frames lie


def frames_of(name: str, motion: Motion) -> dict[str, Any]:
    """Return rule → limb → marker → (3,) m in the limb's frame, of a trial of the one person."""
    if not name.startswith(FOLDER):
        return {}
    found = {"good": _good(motion)}
    for rule, settings in RULES.items():
        found[rule] = _positions(normalize(motion, settings).skeleton)
    return found


def _good(motion: Motion) -> bool:
    steps = [step for step in motion.history if step.name == "normalization"]
    return bool(steps[-1].findings["good_default_position"])


def _positions(skeleton: Skeleton) -> dict[str, dict[str, list[float]]]:
    return {
        limb.name: {
            marker: place.tolist()
            for marker, place in zip(limb.markers, limb.marker_positions, strict=True)
            if np.isfinite(place).all()
        }
        for limb in skeleton.limbs
    }


def turned(ours: Mapping[str, Any], theirs: Mapping[str, Any]) -> Array | None:
    """Return the rotation from one frame to another by the markers both hold, (3, 3), or None."""
    both = sorted(set(ours) & set(theirs))
    if len(both) < FEWEST:
        return None
    a, b = (np.array([place[marker] for marker in both]) for place in (ours, theirs))
    return nearest_rotation((b - b.mean(axis=0)).T @ (a - a.mean(axis=0)))


def summary(trials: Sequence[Mapping[str, Any]]) -> dict[str, Any]:
    """Return part → rule → mean and median per axis, to the mean and pairwise, deg."""
    trials = [trial for trial in trials if trial]
    good = [trial for trial in trials if trial["good"]]
    parts: dict[str, Any] = {}
    for part, kinds in PARTS.items():
        for rule in RULES:
            mean: list[Array] = []
            pairs: list[Array] = []
            limbs = sorted({x for t in good for x in t[rule] if x.endswith(tuple(kinds))})
            for limb in limbs:
                stack = _laid(good, rule, limb)
                if len(stack) > 1:
                    mean.append(deviations_to_mean(stack))
                    pairs.append(deviations_pairwise(stack))
            if mean:
                parts.setdefault(part, {})[rule] = {
                    "mean": _told(mean),
                    "pairwise": _told(pairs),
                }
    return {"trials": len(trials), "good": len(good), "parts": parts}


def _laid(trials: Sequence[Mapping[str, Any]], rule: str, limb: str) -> Array:
    """Return a limb's frames as the markers of the first trial see them, (n, 3, 3)."""
    held = [trial[rule][limb] for trial in trials if limb in trial[rule]]
    laid = (turned(places, held[0]) for places in held)
    return np.array([turn for turn in laid if turn is not None]).reshape(-1, 3, 3)


def _told(angles: list[Array]) -> dict[str, float]:
    flat = np.concatenate(angles)
    return {"mean": float(flat.mean()), "median": float(np.median(flat))}


_BEFORE = """
**One real person**, {trials} functional trials of one session, in {good} of which the default
position is called good. Markers stay where they are on a limb, so its frames from different trials
are laid upon each other by them (skin moves them by some millimetres: a degree or less). Nobody
stands twice alike, and limbs that lie differently in the body have other frames: this holds the
person's part, too.

| limbs | rule | to mean | pairwise |
|---|---|---:|---:|"""


def page(found: Mapping[str, Any]) -> str:
    """Return what of section 4 is real."""
    if not found.get("parts"):
        return ""
    lines = [_BEFORE.format(trials=found["trials"], good=found["good"])]
    for part, rules in found["parts"].items():
        for rule, row in rules.items():
            shown = f"**{rule}**" if rule == "default" else rule
            cells = [f"{number(row[to]['mean'])} ({number(row[to]['median'])})" for to in row]
            lines.append(f"| {part} | {shown} | " + " | ".join(cells) + " |")
    return "\n".join([*lines, ""])
