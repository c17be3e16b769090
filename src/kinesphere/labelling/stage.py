"""Labels for points that have none: the stage, from recording to recording."""

from dataclasses import replace

import numpy as np

from kinesphere.data import Array, Json, Recording, Step, TopologicalModel, settings_as_json
from kinesphere.errors import BadRecording
from kinesphere.labelling.huang_xia import match_huang_xia
from kinesphere.labelling.labelled import Labelled
from kinesphere.labelling.matching import Labeller
from kinesphere.labelling.pair_statistics import match_pair_statistics
from kinesphere.labelling.recognition import WHOLE
from kinesphere.labelling.runs import Run, Track, points_of
from kinesphere.labelling.settings import LabellingSettings
from kinesphere.labelling.similarity_tree import match_similarity_tree
from kinesphere.labelling.spelling import spelled
from kinesphere.labelling.subjects import parse_labels
from kinesphere.labelling.template import template_of
from kinesphere.labelling.through_time import label_through_time

LABELLERS: dict[str, Labeller] = {
    "pair-statistics": match_pair_statistics,
    "huang-xia": match_huang_xia,
    "similarity-tree": match_similarity_tree,
}
"""Method name → labeller."""
DOUBTFUL = 0.25
"""Confidence below which a person should look."""


def label(
    recording: Recording,
    model: TopologicalModel,
    settings: LabellingSettings | None = None,
) -> Recording:
    """Return the recording with the model's labels on the points that can be told.

    Trajectories of one marker are joined, points that are no marker of the layout stay unlabelled
    (``*0``, ``*1``…), and ``confidence`` says how sure each label is. Nothing else changes.

    Parameters
    ----------
    model
        With statistics (``kinesphere model``); the built-in ones have them.

    Raises
    ------
    BadRecording
        If there is no frame or no marker position.
    BadModel
        If the model has no statistics.
    """
    settings = LabellingSettings() if settings is None else settings
    if recording.n_frames == 0 or not recording.seen.any():
        raise BadRecording("the recording holds no marker position: nothing to label")
    known = _existing(recording, model) if settings.existing != "ignore" else {}
    seeds = known if settings.existing == "keep" else {}
    at = {name: i for i, name in enumerate(model.labels)}
    state = label_through_time(
        recording.markers,
        recording.rate,
        model,
        LABELLERS[settings.method],
        keep_columns=_keep_columns(recording, model, settings),
        least_confidence=settings.least_confidence,
        seeds={column: at[name] for name, column in seeds.items()},
    )
    if settings.existing == "check":
        return _checked(recording, model, settings, known, state)
    return _assembled(recording, model, settings, seeds, state)


def unlabelled(recording: Recording, model: TopologicalModel) -> bool:
    """Tell whether a recording has no label that the model knows."""
    return not _existing(recording, model)


def _existing(recording: Recording, model: TopologicalModel) -> dict[str, int]:
    """Return label → column of what bears one of the model's labels already."""
    found = spelled(parse_labels(recording.labels, model), model)
    return {
        name: names[0].column
        for name, names in found.items()
        if len(names) == 1 and recording.seen[:, names[0].column].any()
    }


def _keep_columns(
    recording: Recording, model: TopologicalModel, settings: LabellingSettings
) -> bool:
    if settings.tracks != "auto":
        return settings.tracks == "columns"
    return recording.n_markers <= WHOLE * len(model.labels) + 4


def _assembled(
    recording: Recording,
    model: TopologicalModel,
    settings: LabellingSettings,
    seeds: dict[str, int],
    state: Labelled,
) -> Recording:
    """Return the recording with one column a label, then whatever has none."""
    given = [i for i in range(len(model.labels)) if i in set(state.labels)]
    loose = [k for k, of in enumerate(state.labels) if of < 0]
    loose_tracks = [state.tracks[k] for k in loose]
    unseen = np.flatnonzero(~recording.seen.any(axis=0))
    markers = np.concatenate(
        [
            state.points[:, given],
            points_of(recording.markers, loose_tracks),
            recording.markers[:, unseen],
        ],
        axis=1,
    )
    labels = [model.labels[i] for i in given]
    labels += _names(recording, model, loose_tracks, set(labels))
    labels += _names(recording, model, [(Run(int(c), 0, 0),) for c in unseen], set(labels))
    residuals = None
    if recording.residuals is not None:
        values = np.repeat(recording.residuals[:, :, None], 3, axis=2)
        by_label = [
            tuple(r for k, of in enumerate(state.labels) if of == i for r in state.tracks[k])
            for i in given
        ]
        residuals = np.concatenate(
            [
                points_of(values, [*by_label, *loose_tracks])[:, :, 0],
                recording.residuals[:, unseen],
            ],
            axis=1,
        )
    sure = _confidences(state, len(model.labels))
    confidence = np.full(len(labels), np.nan)
    confidence[: len(given)] = sure[given]
    step = _step(model, settings, seeds, state, sure)
    return replace(
        recording,
        markers=markers,
        labels=tuple(labels),
        residuals=residuals,
        confidence=confidence,
        history=(*recording.history, step),
    )


def _names(
    recording: Recording, model: TopologicalModel, tracks: list[Track], taken: set[str]
) -> list[str]:
    """Return names for what has no label: its own if that stands for none, else ``*0``, ``*1``."""
    known = spelled(parse_labels(recording.labels, model), model)
    claimed = {name.column for names in known.values() for name in names}
    used = set(taken) | set(recording.labels)
    names: list[str] = []
    number = 0
    for track in tracks:
        column = track[0].column
        own = recording.labels[column]
        if column not in claimed and own not in taken:
            names.append(own)
            taken.add(own)
            continue
        while f"*{number}" in used:
            number += 1
        used.add(f"*{number}")
        names.append(f"*{number}")
    return names


def _confidences(state: Labelled, n_labels: int) -> Array:
    """Return the mean confidence of each label over the frames it is given in; NaN for none."""
    total, frames = np.zeros(n_labels), np.zeros(n_labels)
    for track, of, sure in zip(state.tracks, state.labels, state.confidence, strict=True):
        if of >= 0:
            n = sum(run.end - run.start for run in track)
            total[of] += n * sure
            frames[of] += n
    return np.where(frames > 0, total / np.maximum(frames, 1), np.nan)


def _step(
    model: TopologicalModel,
    settings: LabellingSettings,
    seeds: dict[str, int],
    state: Labelled,
    sure: Array,
) -> Step:
    known = recognisable_labels(model)
    seen = np.isfinite(state.points[:, :, 0]).mean(axis=0)
    table: dict[str, Json] = {
        name: {
            "confidence": None if np.isnan(sure[i]) else round(float(sure[i]), 3),
            "share": round(float(seen[i]), 4),
            "pieces": sum(
                len(t) for t, of in zip(state.tracks, state.labels, strict=True) if of == i
            ),
        }
        for i, name in enumerate(model.labels)
        if name in known or seen[i] > 0
    }
    missing: list[Json] = [name for name in known if not seen[model.labels.index(name)] > 0]
    doubtful: list[Json] = [
        name for i, name in enumerate(model.labels) if seen[i] > 0 and sure[i] < DOUBTFUL
    ]
    loose = sum(of < 0 for of in state.labels)
    warnings = [*state.notes]
    given = len(known) - len(missing)
    if missing:
        warnings.append(
            f"{given} of {len(known)} labels of model {model.name} were given; not found or not "
            f"told from others: {', '.join(map(str, missing))}"
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


def _checked(
    recording: Recording,
    model: TopologicalModel,
    settings: LabellingSettings,
    known: dict[str, int],
    state: Labelled,
) -> Recording:
    """Return the recording with its own labels, and what speaks against them."""
    found: dict[str, Json] = {}
    sure = np.full(recording.n_markers, np.nan)
    columns = {column: name for name, column in known.items()}
    for track, of, certain in zip(state.tracks, state.labels, state.confidence, strict=True):
        for run in track:
            name = columns.get(run.column)
            if name is None or of < 0:
                continue
            sure[run.column] = certain
            if model.labels[of] != name:
                found[name] = model.labels[of]
    step = Step(
        name="label",
        settings={"model": model.name, **settings_as_json(settings)},
        findings={"checked": len(known), "disagree": found},
        warnings=(
            *state.notes,
            *(f"{name} moves like {other} of model {model.name}" for name, other in found.items()),
        ),
    )
    return replace(recording, confidence=sure, history=(*recording.history, step))
