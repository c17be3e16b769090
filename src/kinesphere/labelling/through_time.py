"""Labels for raw captures: broken trajectories, hidden markers, ghosts, swapped identities.

Pieces are joined into tracks, windows that show most of the body at once are labelled by the
statistics of other people, and from there on the person's own distances label the rest, backwards
and forwards in time. A track that stops fitting its label is cut.
"""

from collections.abc import Mapping

import numpy as np

from kinesphere.data import Array, TopologicalModel
from kinesphere.labelling.exchanged import exchange_labels
from kinesphere.labelling.labelled import Labelled, give
from kinesphere.labelling.matching import Labeller
from kinesphere.labelling.personal import recognise_rest
from kinesphere.labelling.propagation import propagate
from kinesphere.labelling.recheck import recheck
from kinesphere.labelling.recognition import recognise_again, recognised
from kinesphere.labelling.runs import Track, tracks_of
from kinesphere.labelling.template import of_one_segment

ROUNDS = 4
"""Most times the body is recognised anew with what has been labelled so far."""


def label_through_time(
    markers: Array,
    rate: float,
    model: TopologicalModel,
    labeller: Labeller,
    *,
    keep_columns: bool,
    least_confidence: float,
    seeds: Mapping[int, int] | None = None,
) -> Labelled:
    """Label every piece of trajectory that can be told.

    Parameters
    ----------
    markers : (n_frames, n_columns, 3) m
        NaN where not seen.
    rate
        Hz.
    labeller
        What recognises the body in a window.
    keep_columns
        Whether a column is one marker wherever it is seen.
    least_confidence
        Labels of the window that are less sure are not given.
    seeds
        Column → label of those that are known already, and stay.
    """
    n_labels = len(model.labels)
    seeds = {} if seeds is None else seeds
    tracks = _tracks(markers, rate, seeds, keep_columns)
    state = Labelled(
        np.full((len(markers), n_labels, 3), np.nan),
        tracks,
        [-1] * len(tracks),
        [0.0] * len(tracks),
    )
    for k, track in enumerate(tracks):
        if track and track[0].column in seeds:
            give(state, markers, k, seeds[track[0].column], 1.0)
    match, columns = recognised(markers, rate, state, model, labeller, least_confidence)
    state.fit = match.fit
    if match.note:
        state.notes.append(match.note)
    elif (match.labels >= 0).any() and not (match.confidence >= least_confidence).any():
        state.notes.append(
            "other labels fit nearly as well: the surest has a confidence of "
            f"{match.confidence.max():.2g}, {least_confidence:g} at least is needed"
        )
    if match.bodies > 1:
        state.notes.append(
            f"{match.bodies} bodies are in the volume; the one that model {model.name} fits best "
            "is labelled"
        )
    order = np.argsort(-match.confidence, kind="stable")
    for k, label, sure in zip(
        np.array(columns, dtype=np.intp)[order],
        match.labels[order],
        match.confidence[order],
        strict=True,
    ):
        if label >= 0 and sure >= least_confidence and state.labels[k] < 0:
            give(state, markers, int(k), int(label), float(sure))
    fixed = {k for k, track in enumerate(tracks) if track[0].column in seeds}
    kin = of_one_segment(model, model.labels)
    for _ in range(ROUNDS):
        before = sum(label >= 0 for label in state.labels)
        if not before:
            return state
        propagate(state, markers, rate, fixed, kin, late=False)
        recheck(state, markers, fixed)
        if not recognise_again(state, markers, model, least_confidence, fixed):
            break
    recheck(state, markers, fixed)
    for _ in range(ROUNDS):
        propagate(state, markers, rate, fixed, kin, late=True)
        changed = recheck(state, markers, fixed)
        given = recognise_rest(state, markers, rate, model, least_confidence)
        if not (changed or given):
            break
    # by now most markers are one point each: what was exchanged while they were few shows
    for _ in range(ROUNDS):
        if not exchange_labels(state, markers, model, least_confidence, fixed):
            break
        recheck(state, markers, fixed)
        propagate(state, markers, rate, fixed, kin, late=True)
    return state


def _tracks(
    markers: Array, rate: float, seeds: Mapping[int, int], keep_columns: bool
) -> list[Track]:
    """Return the tracks; a column whose label is known is one track."""
    if keep_columns or not seeds:
        return tracks_of(markers, rate, keep_columns=keep_columns)
    hidden = markers.copy()
    hidden[:, list(seeds)] = np.nan
    known = np.full_like(markers, np.nan)
    known[:, list(seeds)] = markers[:, list(seeds)]
    return [
        *tracks_of(known, rate, keep_columns=True),
        *tracks_of(hidden, rate, keep_columns=False),
    ]
