"""What labelling found, as the step tells it: how sure, and where a person should look."""

from collections.abc import Iterable

import numpy as np

from kinesphere.data import Array, Json, Step, TopologicalModel, settings_as_json
from kinesphere.labelling.labelled import Labelled, length_of
from kinesphere.labelling.runs import Run
from kinesphere.labelling.settings import LabellingSettings
from kinesphere.labelling.template import template_of

SURE = 0.5
"""Confidence from which on a label is called sure..."""
DOUBTFUL = 0.25
"""...and below which a person should look; in between it is likely."""
LASTING = 0.5
"""Share of the recording that a point without label must last..."""
OTHERS = 0.1
"""...and share of the labels that such points are, from which on the layout may be another one."""


def said_of(confidence: float) -> str:
    """Return the word for a confidence that every page and table uses."""
    if confidence >= SURE:
        return "sure"
    return "likely" if confidence >= DOUBTFUL else "look"


def mean_confidences(state: Labelled, n_labels: int) -> Array:
    """Return the mean confidence of each label over the frames it is given in; NaN for none."""
    total, frames = np.zeros(n_labels), np.zeros(n_labels)
    for track, of, sure in zip(state.tracks, state.labels, state.confidence, strict=True):
        if of >= 0:
            n = sum(run.end - run.start for run in track)
            total[of] += n * sure
            frames[of] += n
    return np.where(frames > 0, total / np.maximum(frames, 1), np.nan)


def spans_s(found: Iterable[Run], rate: float) -> list[Json]:
    """Return start and end of runs in s, in order; those that touch are one."""
    joined: list[list[int]] = []
    for start, end in sorted((run.start, run.end) for run in found):
        if joined and start <= joined[-1][1]:
            joined[-1][1] = max(end, joined[-1][1])
        else:
            joined.append([start, end])
    return [[round(a / rate, 3), round(b / rate, 3)] for a, b in joined]


def _doubtful_runs(state: Labelled, label: int) -> list[Run]:
    return [
        run
        for track, of, sure in zip(state.tracks, state.labels, state.confidence, strict=True)
        if of == label and sure < DOUBTFUL
        for run in track
    ]


def step_of(
    model: TopologicalModel,
    settings: LabellingSettings,
    seeds: dict[str, int],
    state: Labelled,
    sure: Array,
    rate: float,
) -> Step:
    """Return the step of a labelling; ``sure`` is the mean confidence of each label."""
    known = recognisable_labels(model)
    seen = np.isfinite(state.points[:, :, 0]).mean(axis=0)
    table: dict[str, Json] = {
        name: {
            "confidence": None if np.isnan(sure[i]) else round(float(sure[i]), 3),
            "share": round(float(seen[i]), 4),
            "pieces": sum(
                len(t) for t, of in zip(state.tracks, state.labels, strict=True) if of == i
            ),
            "kept": name in seeds,
            "look_s": spans_s(_doubtful_runs(state, i), rate),
        }
        for i, name in enumerate(model.labels)
        if name in known or seen[i] > 0
    }
    missing: list[Json] = [name for name in known if not seen[model.labels.index(name)] > 0]
    doubtful: list[Json] = [
        name for i, name in enumerate(model.labels) if seen[i] > 0 and sure[i] < DOUBTFUL
    ]
    loose = sum(of < 0 for of in state.labels)
    lasting = sum(
        of < 0 and length_of(state, k) >= LASTING * len(state.points)
        for k, of in enumerate(state.labels)
    )
    warnings = [*state.notes]
    given = len(known) - len(missing)
    if missing and not given:
        warnings.append(f"none of the {len(known)} labels of model {model.name} was given")
    elif missing:
        warnings.append(
            f"{given} of {len(known)} labels of model {model.name} were given; not found or not "
            f"told from others: {', '.join(map(str, missing))}"
        )
    if lasting > OTHERS * len(known) and given:
        warnings.append(
            f"{lasting} points are there most of the time and bear no label: they are props or "
            f"another body's, or, if they sit on this one, it wears another layout than "
            f"{model.name}, and labels beside them may be those of neighbours"
        )
    if doubtful:
        warnings.append(
            f"labels to look at, another fits nearly as well: {', '.join(map(str, doubtful))}"
        )
    if state.cut:
        warnings.append(
            f"{state.cut} trajectories were cut where they stopped moving with their neighbours: "
            "two markers may have been exchanged there"
        )
    return Step(
        name="label",
        settings={"model": model.name, **settings_as_json(settings)},
        findings={
            "labels_given": given,
            "labels_known": len(known),
            "kept": len(seeds),
            "points_left_unlabelled": loose,
            "pieces": len(state.tracks),
            "cut": state.cut,
            "fit_nats_a_pair": None if np.isnan(state.fit) else round(state.fit, 3),
            "windows_s": [[round(a, 3), round(b, 3)] for a, b in state.windows_s],
            "missing": missing,
            "doubtful": doubtful,
            "labels": table,
        },
        warnings=tuple(warnings),
    )


def recognisable_labels(model: TopologicalModel) -> tuple[str, ...]:
    """Return the labels that the model's statistics know."""
    return template_of(model).labels if model.statistics else ()
