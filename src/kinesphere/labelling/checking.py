"""Labels that a recording bears already, held against those that would be given."""

from collections.abc import Mapping
from dataclasses import replace
from typing import NamedTuple

import numpy as np

from kinesphere.data import Json, Recording, Step, TopologicalModel, settings_as_json
from kinesphere.labelling.findings import DOUBTFUL, spans_s
from kinesphere.labelling.labelled import Labelled
from kinesphere.labelling.recognition import LASTING
from kinesphere.labelling.runs import Run
from kinesphere.labelling.settings import LabellingSettings

MOST = 0.95
"""Share of its frames from which on a label is said to move like another, with no share named."""


class _Verdict(NamedTuple):
    """What the pieces of one column that can be judged say about its label."""

    confidence: float
    """NaN where none can be judged, 0 where one speaks for another label."""
    other: str
    """The label it moves like, empty where that is its own."""
    spans_s: list[Json]
    """Start and end of what moves like another."""
    frames: int = 0
    """How many those are."""


def checked(
    recording: Recording,
    model: TopologicalModel,
    settings: LabellingSettings,
    known: Mapping[str, int],
    state: Labelled,
) -> Recording:
    """Return the recording with its own labels, and what speaks against them.

    A label is judged by what would be given to its marker for as long as recognition itself wants
    of a point, and not by what would be doubtful. Labels that could not be judged have no
    confidence, those that another label fits better have 0.
    """
    verdicts = {
        name: _verdict(recording, column, model, name, state) for name, column in known.items()
    }
    sure = np.full(recording.n_markers, np.nan)
    for name, column in known.items():
        sure[column] = verdicts[name].confidence
    unknown: list[Json] = [name for name, found in verdicts.items() if np.isnan(found.confidence)]
    wrong = {name: found for name, found in verdicts.items() if found.other}
    table: dict[str, Json] = {
        name: {
            "marker": recording.labels[column],
            "confidence": None if name in unknown else round(float(sure[column]), 3),
            "share": round(float(recording.seen[:, column].mean()), 4),
            "moves_like": verdicts[name].other or None,
            "look_s": verdicts[name].spans_s,
        }
        for name, column in known.items()
    }
    step = Step(
        name="label",
        settings={"model": model.name, **settings_as_json(settings)},
        findings={
            "checked": len(known) - len(unknown),
            "disagree": {name: found.other for name, found in wrong.items()},
            "not_judged": unknown,
            "fit_nats_a_pair": None if np.isnan(state.fit) else round(state.fit, 3),
            "labels": table,
        },
        warnings=(
            *state.notes,
            *([f"could not be judged: {', '.join(map(str, unknown))}"] if unknown else ()),
            *(
                f"{name} moves like {found.other} of model {model.name}"
                + _when(found, recording, known[name])
                for name, found in wrong.items()
            ),
        ),
    )
    return replace(recording, confidence=sure, history=(*recording.history, step))


def _verdict(
    recording: Recording, column: int, model: TopologicalModel, name: str, state: Labelled
) -> _Verdict:
    pieces: dict[int, list[tuple[Run, float]]] = {}
    for track, of, certain in zip(state.tracks, state.labels, state.confidence, strict=True):
        if of >= 0:
            own = [(run, certain) for run in track if run.column == column]
            pieces.setdefault(of, []).extend(own)
    judged: dict[str, float] = {}
    for of, found in pieces.items():
        frames = np.array([run.end - run.start for run, _ in found], dtype=np.float64)
        if frames.sum() < max(1.0, LASTING * recording.n_frames):
            continue
        certain = float(frames @ [c for _, c in found] / frames.sum())
        if certain >= DOUBTFUL:
            judged[model.labels[of]] = certain
    others = {label: certain for label, certain in judged.items() if label != name}
    if not others:
        return _Verdict(judged.get(name, np.nan), "", [])
    other = max(others, key=lambda label: others[label])
    runs = [run for run, _ in pieces[model.labels.index(other)]]
    n = sum(run.end - run.start for run in runs)
    return _Verdict(0.0, other, spans_s(runs, recording.rate), n)


def _when(found: _Verdict, recording: Recording, column: int) -> str:
    share = found.frames / recording.seen[:, column].sum()
    return "" if share > MOST else f" in {share:.0%} of its frames"
