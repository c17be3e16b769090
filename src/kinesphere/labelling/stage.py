"""Labels for points that have none: the stage, from recording to recording."""

from dataclasses import replace

import numpy as np

from kinesphere.data import Recording, TopologicalModel
from kinesphere.errors import BadRecording
from kinesphere.labelling.assembling import assembled
from kinesphere.labelling.checking import checked
from kinesphere.labelling.crowd import followed, is_crowd, taken
from kinesphere.labelling.huang_xia import match_huang_xia
from kinesphere.labelling.matching import Labeller
from kinesphere.labelling.pair_statistics import match_pair_statistics
from kinesphere.labelling.recognition import WHOLE
from kinesphere.labelling.settings import LabellingSettings
from kinesphere.labelling.similarity_tree import match_similarity_tree
from kinesphere.labelling.spelling import spelled
from kinesphere.labelling.subjects import parse_labels
from kinesphere.labelling.through_time import label_through_time

LABELLERS: dict[str, Labeller] = {
    "pair-statistics": match_pair_statistics,
    "huang-xia": match_huang_xia,
    "similarity-tree": match_similarity_tree,
}
"""Method name → labeller."""


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
    crowd = not known and _is_crowd(recording, settings)
    if crowd:
        recording = _followed(recording)
    seeds = known if settings.existing == "keep" else {}
    at = {name: i for i, name in enumerate(model.labels)}
    state = label_through_time(
        recording.markers,
        recording.rate,
        model,
        LABELLERS[settings.method],
        keep_columns=not crowd and _keep_columns(recording, model, settings),
        least_confidence=settings.least_confidence,
        seeds={column: at[name] for name, column in seeds.items()},
    )
    if settings.existing == "check":
        return checked(recording, model, settings, known, state)
    return assembled(recording, model, settings, seeds, state)


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


def _is_crowd(recording: Recording, settings: LabellingSettings) -> bool:
    if settings.tracks != "auto":
        return settings.tracks == "points"
    return is_crowd(recording.markers, recording.rate)


def _followed(recording: Recording) -> Recording:
    """Return the recording with trajectories for columns; nothing is lost but their order."""
    frames = list(recording.markers)
    source = followed(frames, recording.rate)
    residuals = None
    if recording.residuals is not None:
        residuals = np.full(source.shape, np.nan)
        rows, columns = np.nonzero(source >= 0)
        residuals[rows, columns] = recording.residuals[rows, source[rows, columns]]
    return replace(
        recording,
        markers=taken(frames, source),
        labels=tuple(f"*{i}" for i in range(source.shape[1])),
        residuals=residuals,
        confidence=None,
    )
