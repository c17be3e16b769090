"""What is left is recognised together: pieces of one time, by the person's own statistics.

A foot whose five markers came into view at once has no labelled neighbour near it, yet its pieces
know each other. Each stretch of time is one small assignment beside what has labels there.
"""

import numpy as np

from kinesphere.data import Array, TopologicalModel
from kinesphere.geometry.signature import signature
from kinesphere.labelling.kernels import linear_terms
from kinesphere.labelling.labelled import Labelled, give, length_of
from kinesphere.labelling.own_distances import FLOOR, own_distances
from kinesphere.labelling.problem import problem_of
from kinesphere.labelling.runs import points_of
from kinesphere.labelling.search import doubt, nearest_labels, shake
from kinesphere.labelling.template import DEVIATION_FLOOR, DEVIATION_SHARE, Template, template_of

SHORTEST_S = 0.75
"""s, shortest piece that is looked at."""
LONGEST_S = 4.0
"""s, longest stretch looked at together."""
MARGIN = 8.0
"""Nats at which a label is held 63 % sure, as for whole bodies."""
INTO_FREE = 0.25
OVERLAP = 0.5
FITTING = -1.5


def personal_template(template: Template, points: Array) -> tuple[Template, float]:
    """Return a layout's template with a person's own distances where they are known, and the scale.

    Parameters
    ----------
    points : (n_frames, n_template_labels, 3) m
        What is labelled so far.
    """
    own = own_distances(points)
    known = np.isfinite(own.mean) & np.isfinite(template.mean) & ~np.eye(template.n, dtype=bool)
    scale = float(np.median((own.mean / template.mean)[known])) if known.any() else template.size
    std = np.sqrt(np.maximum(own.deviation**2 - FLOOR**2, 0.0)) / scale
    own_variance = (FLOOR / scale) ** 2 + DEVIATION_SHARE * std**2
    from dataclasses import replace

    return replace(
        template,
        mean=np.where(known, own.mean / scale, template.mean),
        variance=np.where(known, own_variance, template.variance),
        log_std=np.where(known, np.log(std + DEVIATION_FLOOR), template.log_std),
    ), scale


def recognise_rest(
    state: Labelled, markers: Array, rate: float, model: TopologicalModel, least_confidence: float
) -> bool:
    """Label pieces by what they are to each other and to what has labels at the time."""
    template = template_of(model)
    into = np.array([model.labels.index(x) for x in template.labels], dtype=np.int64)
    personal, scale = personal_template(template, state.points[:, into])
    near = nearest_labels(personal.mean)
    least = max(2, round(SHORTEST_S * rate))
    tried: set[int] = set()
    given = False
    loose = [k for k, of in enumerate(state.labels) if of < 0 and length_of(state, k) >= least]
    for k in sorted(loose, key=lambda k: (-length_of(state, k), k)):
        if k in tried or state.labels[k] >= 0:
            continue
        start, end = state.tracks[k][0].start, state.tracks[k][-1].end
        most = round(LONGEST_S * rate)
        if end - start > most:
            start = (start + end - most) // 2
            end = start + most
        inside = points_of(markers, [state.tracks[x] for x in loose])[start:end]
        share = np.isfinite(inside[:, :, 0]).mean(axis=0)
        here = [
            x
            for x, part in zip(loose, share, strict=True)
            if part >= OVERLAP and state.labels[x] < 0
        ]
        tried |= set(here)
        held = np.flatnonzero(
            np.isfinite(state.points[start:end, into, 0]).mean(axis=0) >= OVERLAP
        )
        if len(held) < 4:
            continue
        points = np.concatenate(
            [
                state.points[start:end][:, into[held]],
                points_of(markers, [state.tracks[x] for x in here])[start:end],
            ],
            axis=1,
        )
        problem = problem_of(signature(points), scale, personal)
        labels = np.array([*held, *([-1] * len(here))], dtype=np.int64)
        labels = problem.descend(labels, nullable=True)
        labels, _ = shake(problem, labels, near, np.random.default_rng(0), nullable=True)
        labels, energy, margins = doubt(problem, labels, near, nullable=True)
        sure = 1 - np.exp(-np.maximum(margins, 0.0) / MARGIN)
        import kinesphere.labelling.personal as me
        if hasattr(me, "HOOK"):
            terms = linear_terms(labels, problem.costs)
            moved = [(int(into[h]), int(into[l]) if l >= 0 else -1) for h, l in zip(held, labels) if h != l]
            for q, x in enumerate(here):
                l = labels[len(held) + q]
                if l >= 0:
                    me.HOOK(state.tracks[x], int(into[l]), float(sure[len(held) + q]), terms[len(held) + q, l] / (labels >= 0).sum(), length_of(state, x) / rate, (end - start) / rate, share[loose.index(x)], moved)
        moved = (labels[: len(held)] != held).any()
        terms = linear_terms(labels, problem.costs)
        for x, label, c in zip(here, labels[len(held) :], sure[len(held) :], strict=True):
            term = float(terms[len(held) + here.index(x), label]) / max((labels >= 0).sum() - 1, 1)
            if label >= 0 and c >= max(least_confidence, 0.3) and term <= FITTING and not moved:
                before = state.labels[x]
                give(state, markers, x, int(into[label]), float(c))
                given = given or state.labels[x] != before
    return given
