"""The default labeller: distances over time, their spread, and handedness, all at once.

No pose, no height, no training: statistics of all frames are compared with those of other people.
A quadratic assignment [1]_ whose cost knows left from right.

References
----------
.. [1] Koopmans & Beckmann (1957), Econometrica 25(1), 53-76; annealed after Connolly (1990),
   Eur. J. Oper. Res. 46(1), 93-100.
"""

from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from kinesphere.data import Array, TopologicalModel
from kinesphere.geometry.signature import Signature, scale_of, signature
from kinesphere.labelling.blocks import Moves, block_moves, twins
from kinesphere.labelling.bodies import bodies_of
from kinesphere.labelling.matching import Match, nothing
from kinesphere.labelling.plausible import is_still, plausible
from kinesphere.labelling.problem import Labels, Problem, problem_of
from kinesphere.labelling.search import (
    doubt,
    exchange_blocks,
    find_labels,
    nearest_labels,
    shake,
)
from kinesphere.labelling.template import LEAST_LABELS, Template, template_of

MARGIN = 8.0
"""Nats of energy at which a label is held 63 % sure: neighbouring pairs tell much the same, so a
nat of energy is worth far less than one of evidence."""
RESCALED = 0.01
"""Change of scale after a first labelling from which on costs are computed anew."""
WORST_FIT = 0.8
"""Nats a pair by which labels must fit better than nothing; right labels of other people have 1.3
and more, points that move at random reach 0.5."""
LEAST_AGREEMENT = 0.3
"""Handedness that must agree: right labels have 0.6 and more, those of a mirrored body −0.6."""


@dataclass(frozen=True)
class _Layout:
    """A template and what the search needs beside it."""

    template: Template
    moves: Moves
    near: Labels
    twin: NDArray[np.int64]
    into: NDArray[np.int64]
    """(n_template_labels,) index into the model's labels."""


class _Solved(NamedTuple):
    """A problem, and the labels of least energy."""

    problem: Problem
    labels: Labels
    energy: float
    margins: Array
    rivals: list[tuple[float, Labels]]


def match_pair_statistics(
    points: Array, model: TopologicalModel, start: Labels | None = None
) -> Match:
    """Label points by the statistics of their distances and their handedness.

    Parameters
    ----------
    points : (n_frames, n_points, 3)
        NaN where not seen; in any unit, axes and order of frames.
    model
        With statistics.
    start : (n_points,)
        Labels to start from, by index into the model's, −1 for none: they are improved and
        completed rather than searched for.

    Raises
    ------
    BadModel
        If the model has no statistics, or of too few markers.
    """
    layout = _layout_of(model)
    n_points = points.shape[1]
    seen = np.asarray(np.isfinite(points).all(axis=2))
    if seen.any(axis=1).sum() < 2:
        return nothing(n_points, "one frame alone shows no motion to recognise markers by")
    kept = np.flatnonzero(seen.sum(axis=0) >= 2)
    bodies = bodies_of(points[:, kept], layout.template.n) if start is None else []
    if bodies:
        return _best_of([kept[body] for body in bodies], points, model)
    if start is None:
        kept = plausible(points, seen, layout.template.n)
    if len(kept) < LEAST_LABELS:
        return nothing(
            n_points, f"{len(kept)} markers are seen; {LEAST_LABELS} at least can be told apart"
        )
    found = signature(points[:, kept])
    if start is None and is_still(found):
        return nothing(
            n_points, "nothing moves: markers are recognised by how they move with each other"
        )
    if start is None:
        solved = _solve(found, layout)
    else:
        back = np.full(len(model.labels) + 1, -1, dtype=np.int64)
        back[layout.into] = np.arange(layout.template.n)
        solved = _continued(found, layout, back[start[kept]])
    return _match(solved, layout, kept, n_points, model.name)


def _best_of(bodies: list[NDArray[np.intp]], points: Array, model: TopologicalModel) -> Match:
    """Return the labels of the body that the model fits best; the others get none."""
    found = [match_pair_statistics(points[:, body], model) for body in bodies]
    best = max(range(len(found)), key=lambda k: (not found[k].note, found[k].fit, -k))
    labels = np.full(points.shape[1], -1, dtype=np.int64)
    sure = np.zeros(points.shape[1])
    labels[bodies[best]], sure[bodies[best]] = found[best].labels, found[best].confidence
    return replace(found[best], labels=labels, confidence=sure, bodies=len(bodies))


def _match(
    solved: _Solved, layout: _Layout, kept: NDArray[np.intp], n_points: int, name: str
) -> Match:
    """Return the labels of a solved problem, unless they fit too badly to be given."""
    confidence = _confidence(solved, layout)
    labels = np.full(n_points, -1, dtype=np.int64)
    sure = np.zeros(n_points)
    given = solved.labels >= 0
    labels[kept[given]] = layout.into[solved.labels[given]]
    sure[kept[given]] = confidence[given]
    n = int(given.sum())
    fit = -solved.energy / max(n * (n - 1) / 2, 1.0)
    match = Match(labels, sure, fit)
    agreement = solved.problem.agreement(solved.labels)
    if n < LEAST_LABELS or fit < WORST_FIT:
        return match.refused(
            f"the markers do not move like those of {name}: the best labels fit by "
            f"{fit:.2f} nats a pair, {WORST_FIT} at least are needed"
        )
    if not agreement >= LEAST_AGREEMENT:
        return match.refused(
            f"left and right of {name} cannot be told: {agreement:.2f} of the handedness "
            f"agrees, {LEAST_AGREEMENT} at least is needed"
        )
    return match


def _layout_of(model: TopologicalModel) -> _Layout:
    template = template_of(model)
    into = {label: i for i, label in enumerate(model.labels)}
    return _Layout(
        template,
        block_moves(model, template.labels, template.mean),
        nearest_labels(template.mean),
        twins(model, template.labels),
        np.array([into[label] for label in template.labels], dtype=np.int64),
    )


def _solve(found: Signature, layout: _Layout) -> _Solved:
    template = layout.template
    share = (template.n - 1) / max(min(found.n, template.n) - 1, 1)
    scale = scale_of(found.mean) * share
    problem = problem_of(found, scale, template)
    # where there are no more points than labels, all are first taken for markers
    best = find_labels(problem, layout.moves, layout.near, nullable=found.n > template.n)
    labels, energy, rivals = best.labels, best.energy, list(best.rivals)
    rescaled = _scale_by_labels(found, labels, template)
    if abs(rescaled / scale - 1) > RESCALED:
        scale = rescaled
        problem = problem_of(found, scale, template)
        labels, energy, rivals = *_refined(problem, labels, layout), []
    return _finished(found, scale, layout, problem, labels, energy, rivals)


def _continued(found: Signature, layout: _Layout, labels: Labels) -> _Solved:
    scale = _scale_by_labels(found, labels, layout.template)
    problem = problem_of(found, scale, layout.template)
    labels, energy = _refined(problem, labels, layout)
    return _finished(found, scale, layout, problem, labels, energy, [])


def _finished(
    found: Signature,
    scale: float,
    layout: _Layout,
    problem: Problem,
    labels: Labels,
    energy: float,
    rivals: list[tuple[float, Labels]],
) -> _Solved:
    """Try unpaired markers on the other side, then doubt every label."""
    template = layout.template
    for label in np.flatnonzero(layout.twin == np.arange(template.n)):
        turned = template.with_other_side(int(label), layout.twin)
        other = problem_of(found, scale, turned, (problem, int(label)))
        if other.energy(labels) < energy - 1e-6:
            template, problem = turned, other
            labels, energy, rivals = *_refined(problem, labels, layout), []
    labels, energy, margins = doubt(problem, labels, layout.near, layout.twin, nullable=True)
    return _Solved(problem, labels, energy, margins, rivals)


def _refined(problem: Problem, labels: Labels, layout: _Layout) -> tuple[Labels, float]:
    rng = np.random.default_rng(0)
    labels = problem.descend(labels, nullable=True)
    labels, _ = exchange_blocks(problem, labels, layout.moves, nullable=True)
    labels, _ = shake(problem, labels, layout.near, rng, nullable=True)
    return exchange_blocks(problem, labels, layout.moves, nullable=True)


def _scale_by_labels(found: Signature, labels: Labels, template: Template) -> float:
    """Return the scale at which the labelled distances are on the whole the template's."""
    given = np.flatnonzero(labels >= 0)
    rows, columns = np.triu_indices(len(given), 1)
    seen = found.mean[given[rows], given[columns]]
    expected = template.mean[labels[given[rows]], labels[given[columns]]]
    ratio = seen / expected
    ratio = ratio[np.isfinite(ratio)]
    return float(np.median(ratio)) if len(ratio) else scale_of(found.mean)


def _confidence(solved: _Solved, layout: _Layout) -> Array:
    """Return 0…1 for each point, by the least rise of energy that changes its label."""
    problem, labels = solved.problem, solved.labels
    margin = solved.margins.copy()
    for move in layout.moves.every:
        changed = np.where(labels >= 0, move[labels], -1)
        rise = problem.energy(changed) - solved.energy
        moved = changed != labels
        margin[moved] = np.minimum(margin[moved], rise)
    for energy, other in solved.rivals:
        moved = other != labels
        margin[moved] = np.minimum(margin[moved], energy - solved.energy)
    return 1 - np.exp(-np.maximum(margin, 0.0) / MARGIN)
