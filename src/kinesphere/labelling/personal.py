"""What is left is recognised together: pieces of one time, by the person's own statistics.

A foot whose five markers come into view at once has no labelled neighbour near it, and none of them
can be told alone; but they know each other. Each stretch of time is one small assignment of what
has no label, beside what has one.
"""

from dataclasses import replace
from typing import NamedTuple

import numpy as np

from kinesphere.data import Array, TopologicalModel
from kinesphere.geometry.signature import signature
from kinesphere.labelling.blocks import twins
from kinesphere.labelling.doubting import doubt
from kinesphere.labelling.exchanging import shake
from kinesphere.labelling.kernels import linear_terms
from kinesphere.labelling.labelled import Labelled, give, length_of
from kinesphere.labelling.own_distances import FLOOR, own_distances
from kinesphere.labelling.pair_statistics import MARGIN
from kinesphere.labelling.problem import Labels, problem_of
from kinesphere.labelling.resting import accompanied
from kinesphere.labelling.runs import points_of
from kinesphere.labelling.search import nearest_labels
from kinesphere.labelling.template import (
    DEVIATION_FLOOR,
    DEVIATION_SHARE,
    LEAST_LABELS,
    Template,
    template_of,
)

SHORTEST_S = 0.75
"""s, shortest piece that is looked at: how a distance varies takes some motion to see."""
LONGEST_S = 4.0
"""s, longest stretch looked at together."""
PRESENT = 0.5
"""Share of a stretch that a point must be seen in: two pieces of one marker are not both."""
LEAST_CONFIDENCE = 0.3
"""Confidence from which on a label is given here."""
FITTING = 1.5
"""Nats a pair by which a piece must fit its label better than nothing: right ones 1.5 to 2.8."""
SEED = 20100517


class _Person(NamedTuple):
    """What a person's own labels tell."""

    template: Template
    scale: float
    near: Labels
    twin: Labels
    into: Labels
    """(n_template_labels,) index into the model's labels."""


def personal_template(template: Template, points: Array) -> tuple[Template, float]:
    """Return a layout's template with the person's own distances where known, and their scale.

    Parameters
    ----------
    points : (n_frames, n_template_labels, 3) m
        What is labelled so far, NaN elsewhere.

    Returns
    -------
    template
    scale
        m, what its lengths are shares of.
    """
    own = own_distances(points)
    known = np.isfinite(own.mean) & np.isfinite(template.mean) & ~np.eye(template.n, dtype=bool)
    if not known.any():
        return template, template.size
    scale = float(np.median(own.mean[known] / template.mean[known]))
    std = np.sqrt(np.maximum(own.deviation**2 - FLOOR**2, 0.0)) / scale
    own_variance = (FLOOR / scale) ** 2 + DEVIATION_SHARE * std**2
    personal = replace(
        template,
        mean=np.where(known, own.mean / scale, template.mean),
        variance=np.where(known, own_variance, template.variance),
        log_std=np.where(known, np.log(std + DEVIATION_FLOOR), template.log_std),
    )
    return personal, scale


def recognise_rest(
    state: Labelled, markers: Array, rate: float, model: TopologicalModel, least_confidence: float
) -> bool:
    """Label pieces by what they are to each other and to what has labels at the time.

    A stretch in which what has labels would rather have others is left alone. Return whether any
    was given.
    """
    template = template_of(model)
    into = np.array([model.labels.index(x) for x in template.labels], dtype=np.int64)
    personal, scale = personal_template(template, state.points[:, into])
    near, twin = nearest_labels(personal.mean), twins(model, template.labels)
    person = _Person(personal, scale, near, twin, into)
    least = max(2, round(SHORTEST_S * rate))
    loose = [k for k, of in enumerate(state.labels) if of < 0 and length_of(state, k) >= least]
    points = points_of(markers, [state.tracks[k] for k in loose])
    seen = np.isfinite(points[:, :, 0])
    tried: set[int] = set()
    given = False
    for k in sorted(loose, key=lambda k: (-length_of(state, k), k)):
        if k in tried:
            continue
        start, end = _stretch(state.tracks[k][0].start, state.tracks[k][-1].end, rate)
        present = np.flatnonzero(seen[start:end].mean(axis=0) >= PRESENT)
        here = [int(x) for x in present if state.labels[loose[x]] < 0]
        tried |= {loose[x] for x in here}
        labels, sure = _assigned(state.points[start:end, into], points[start:end, here], person)
        for x, label, c in zip(here, labels, sure, strict=True):
            if label >= 0 and c >= max(least_confidence, LEAST_CONFIDENCE):
                give(state, markers, loose[x], int(into[label]), float(c))
                given = given or state.labels[loose[x]] >= 0
    return given


def _stretch(start: int, end: int, rate: float) -> tuple[int, int]:
    """Return the middle of a stretch that is too long."""
    most = max(2, round(LONGEST_S * rate))
    if end - start <= most:
        return start, end
    start = (start + end - most) // 2
    return start, start + most


def _assigned(labelled: Array, loose: Array, person: _Person) -> tuple[Labels, Array]:
    """Return labels and confidences of loose points beside labelled ones, of one stretch."""
    none = np.full(loose.shape[1], -1, dtype=np.int64), np.zeros(loose.shape[1])
    held = np.flatnonzero(np.isfinite(labelled[:, :, 0]).mean(axis=0) >= PRESENT)
    if len(held) < LEAST_LABELS or not loose.shape[1]:
        return none
    points = np.concatenate([labelled[:, held], loose], axis=1)
    problem = problem_of(signature(points), person.scale, person.template)
    start = np.concatenate([held, none[0]])
    labels = problem.descend(start, nullable=True)
    rng = np.random.default_rng(SEED)
    labels, _ = shake(problem, labels, person.near, rng, nullable=True)
    labels, _, margins = doubt(problem, labels, person.near, person.twin, nullable=True)
    if (labels[: len(held)] != held).any():
        return none
    terms = linear_terms(labels, problem.costs)
    new = labels[len(held) :]
    fit = -terms[np.arange(len(held), len(labels)), new] / max((labels >= 0).sum() - 1, 1)
    sure = 1 - np.exp(-np.maximum(margins[len(held) :], 0.0) / MARGIN)
    fine = accompanied(points, labels, person.near)[len(held) :]
    return np.where((fit >= FITTING) & fine, new, -1), sure
