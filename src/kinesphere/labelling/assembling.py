"""The labelled recording, put together from tracks and their labels."""

from dataclasses import replace

import numpy as np

from kinesphere.data import Recording, TopologicalModel
from kinesphere.labelling.findings import mean_confidences, step_of
from kinesphere.labelling.labelled import Labelled
from kinesphere.labelling.runs import Run, Track, points_of
from kinesphere.labelling.settings import LabellingSettings
from kinesphere.labelling.spelling import spelled
from kinesphere.labelling.subjects import parse_labels


def assembled(
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
    sure = mean_confidences(state, len(model.labels))
    confidence = np.full(len(labels), np.nan)
    confidence[: len(given)] = sure[given]
    step = step_of(model, settings, seeds, state, sure, recording.rate)
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
