"""Trials as a page: noise-free against the thresholds, then how errors grow."""

import math
from collections.abc import Iterable, Mapping, Sequence

import numpy as np

from benchmarks.accuracy.conditions import CONDITIONS
from benchmarks.accuracy.measure import LAYOUTS, Trial
from kinesphere.synthetic import TruthRow

THRESHOLDS: Mapping[str, Mapping[str, float]] = {
    "bodies": {
        "joint centre": 0.1,
        "joint centre across the axis": 0.1,
        "axis": 0.5,
        "angle": 0.5,
        "twist": 0.5,
        "angle, same conventions": 0.5,
        "twist, same conventions": 0.5,
        "markers": 0.1,
    },
    "cmu41": {
        "joint centre": 2.0,
        "joint centre across the axis": 2.0,
        "axis": 0.5,
        "angle": 0.5,
        "twist": 0.5,
        "angle, same conventions": 0.5,
        "twist, same conventions": 0.5,
        "markers": 0.1,
    },
}
"""mm and deg, for noise-free performances; they hold for the largest error in any frame."""

_TITLES = {
    "bodies": "Marker bodies (3–5 markers at random on each limb)",
    "cmu41": "The 41 markers of the CMU layout, solved with the built-in model",
}
_INTRODUCTION = """\
# Accuracy on synthetic performances

Written by `make bench` (`python -m benchmarks.accuracy`); every number is in
`benchmarks/results/accuracy.json`.

A random actor of twelve limbs and eleven joints (`kinesphere.synthetic`) stands, makes the main
movements of each limb within a minute at 50 Hz, then walks and reaches about for 20 s, twisting
every limb. {n_seeds} actors a condition. The line is told the interval of the calibration, nothing
else.

*rms* is taken over frames, separately for each joint, limb or axis; *median* and *worst* are over
joints and actors; *any frame* is the largest error of any joint in any frame of any actor.

Hinges (elbow, knee) are compared across their axis: along it the centre is a matter of definition
as long as the limb only bends. *Constant* is the part of an error that stays the same in all
frames, seen from the parent: what is wrong with the skeleton rather than with the poses. *Angle*
and *twist* are as delivered, but for sign, zero and the matching of axes. Which of two axes is the
proximal one, where exactly angles are zero and what a limb's long axis is are conventions that a
motion does not hold; *same conventions* compares with the true motion told in those of the
solution, and so shows what wrong axes and wrong poses cause.
"""


def page(trials: Sequence[Trial]) -> str:
    """Return the results as Markdown."""
    n_seeds = len({trial.seed for trial in trials})
    parts = [_INTRODUCTION.format(n_seeds=n_seeds)]
    for layout in LAYOUTS:
        mine = [trial for trial in trials if trial.layout == layout]
        parts.append(f"## {_TITLES[layout]}\n")
        parts.append(_against_thresholds(mine, THRESHOLDS[layout]))
        parts.append(_growth(mine))
        if failures := [trial for trial in mine if trial.failure]:
            lines = (f"- {t.condition}, seed {t.seed}: {t.failure}" for t in failures)
            parts.append("Not solved:\n\n" + "\n".join(lines) + "\n")
    parts.append("## Conditions\n")
    parts.append("\n".join(f"- **{c.name}**: {c.what}" for c in CONDITIONS) + "\n")
    return "\n".join(parts)


def missed(trials: Sequence[Trial]) -> list[str]:
    """Return which noise-free measures miss their threshold, each as a sentence."""
    found = []
    for layout in LAYOUTS:
        mine = [t for t in trials if (t.layout, t.condition) == (layout, "noise-free")]
        for (_, measure), rows in _grouped(mine).items():
            limit = THRESHOLDS[layout].get(measure)
            worst = max(rows, key=_largest)
            if limit is not None and not worst.largest <= limit:
                found.append(
                    f"{layout}, noise-free: {measure} of {worst.of} is off by "
                    f"{_number(worst.largest)} {worst.unit}; {limit} is allowed"
                )
    return found


def _against_thresholds(trials: Sequence[Trial], thresholds: Mapping[str, float]) -> str:
    lines = [
        "Noise-free:\n",
        "| stage | measure | unit | median rms | worst rms | any frame | where | allowed | |",
        "|---|---|---|---:|---:|---:|---|---:|---|",
    ]
    noise_free = [trial for trial in trials if trial.condition == "noise-free"]
    for (stage, measure), rows in _grouped(noise_free).items():
        worst = max(rows, key=_largest)
        limit = thresholds.get(measure)
        verdict = "" if limit is None else ("ok" if worst.largest <= limit else "**missed**")
        lines.append(
            f"| {stage} | {measure} | {worst.unit} | {_number(_median(rows))} "
            f"| {_number(_worst(rows))} | {_number(worst.largest)} | {worst.of.replace('_', ' ')} "
            f"| {'' if limit is None else limit} | {verdict} |"
        )
    return "\n".join(lines) + "\n"


def _growth(trials: Sequence[Trial]) -> str:
    by_condition = {
        name: _grouped([trial for trial in trials if trial.condition == name])
        for name in dict.fromkeys(trial.condition for trial in trials)
    }
    keys = list(dict.fromkeys(key for groups in by_condition.values() for key in groups))
    lines = [
        "Median / worst rms in every condition:\n",
        "| measure | unit | " + " | ".join(by_condition) + " |",
        "|---|---|" + "---:|" * len(by_condition),
    ]
    for key in keys:
        rows_of = [groups.get(key, []) for groups in by_condition.values()]
        unit = next(rows[0].unit for rows in rows_of if rows)
        cells = (
            f"{_number(_median(rows))} / {_number(_worst(rows))}" if rows else "–"
            for rows in rows_of
        )
        lines.append(f"| {key[1]} | {unit} | " + " | ".join(cells) + " |")
    return "\n".join(lines) + "\n"


def _grouped(trials: Iterable[Trial]) -> dict[tuple[str, str], list[TruthRow]]:
    groups: dict[tuple[str, str], list[TruthRow]] = {}
    for trial in trials:
        for row in trial.rows:
            groups.setdefault((row.stage, row.measure), []).append(row)
    return groups


def _median(rows: Sequence[TruthRow]) -> float:
    return float(np.median([row.error for row in rows]))


def _worst(rows: Sequence[TruthRow]) -> float:
    return max((row.error for row in rows), key=lambda error: math.inf if error != error else error)


def _largest(row: TruthRow) -> float:
    return math.inf if math.isnan(row.largest) else row.largest


def _number(value: float) -> str:
    """Return two to three digits that mean something; – for no number."""
    if not math.isfinite(value):
        return "–"
    if value < 0.0005:
        return "0"
    return f"{value:.3f}" if value < 0.1 else f"{value:.2f}" if value < 10 else f"{value:.1f}"
