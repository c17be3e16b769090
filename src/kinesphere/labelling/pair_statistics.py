"""The default labeller: distances over time, their spread, and handedness, all at once.

No pose, no height, no training: statistics of all frames are compared with those of other people.
A quadratic assignment [1]_ whose cost knows left from right.

References
----------
.. [1] Koopmans & Beckmann (1957), Econometrica 25(1), 53-76; annealed after Connolly (1990),
   Eur. J. Oper. Res. 46(1), 93-100.
"""

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from kinesphere.data import Array, TopologicalModel
from kinesphere.geometry.signature import Signature, scale_of, signature
from kinesphere.labelling.bodies import bodies_of
from kinesphere.labelling.held import held_to_distances
from kinesphere.labelling.layout import Layout, Solved, layout_of
from kinesphere.labelling.matching import Match, nothing
from kinesphere.labelling.plausible import in_own_order, is_still, learnt_standing, plausible
from kinesphere.labelling.problem import Labels, problem_of
from kinesphere.labelling.resting import resting, solved_apart
from kinesphere.labelling.same_person import (
    MIRROR_IMAGE,
    SKIN,
    is_mirrored,
    is_the_person,
    rigid_pairs,
    template_of_person,
)
from kinesphere.labelling.seating import seated
from kinesphere.labelling.solving import continued, finished, refined
from kinesphere.labelling.template import LEAST_LABELS
from kinesphere.labelling.verdict import MARGIN as MARGIN
from kinesphere.labelling.verdict import verdict
from kinesphere.labelling.worn import is_worn, layout_held, numbered, smaller_layout


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
    layout = layout_of(model)
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
    else:
        kept = kept[(start[kept] >= 0) | ~resting(points[:, kept])]
    if len(kept) < LEAST_LABELS:
        return nothing(
            n_points, f"{len(kept)} markers are seen; {LEAST_LABELS} at least can be told apart"
        )
    kept = in_own_order(points, kept)
    found = signature(points[:, kept])
    if not scale_of(found.mean) > 0:
        return nothing(n_points, "all points are in one place")
    again = _of_person(found, layout, model)
    if isinstance(again, str):
        return nothing(n_points, again)
    if again is not None:
        return verdict(again, layout, kept, n_points, model.name)
    if learnt_standing(model):
        return nothing(
            n_points,
            f"model {model.name} was learnt from people standing still: it knows those people by "
            "their distances, and nobody here has them",
        )
    if start is None and is_still(found):
        return nothing(
            n_points, "nothing moves: markers are recognised by how they move with each other"
        )
    if start is None:
        solved, some, layout = _of_anybody(points[:, kept], found, layout, model)
        kept = kept[some]
    else:
        layout = layout_held(model, layout, start[kept])
        back = np.full(len(model.labels) + 1, -1, dtype=np.int64)
        back[layout.into] = np.arange(layout.template.n)
        solved = continued(found, layout, back[start[kept]])
    return verdict(solved, layout, kept, n_points, model.name)


def _of_anybody(
    points: Array, found: Signature, layout: Layout, model: TopologicalModel
) -> tuple[Solved, NDArray[np.intp], Layout]:
    """Label points by the model, or by the smaller layout of one of its recordings if that is worn.

    Returns the labels, the points they are about, and the layout they belong to.
    """
    n = points.shape[1]
    solved, some = solved_apart(points, found, layout)
    smaller = smaller_layout(model, layout, n)
    if smaller is not None:
        alone, these = solved_apart(points, found, smaller)
        ours = numbered(alone.labels, these, smaller, layout, n)
        if is_worn(found, ours, numbered(solved.labels, some, layout, layout, n), layout):
            return alone, these, smaller
    return solved, some, layout


def _best_of(bodies: list[NDArray[np.intp]], points: Array, model: TopologicalModel) -> Match:
    """Return the labels of the body that the model fits best; the others get none."""
    found = [match_pair_statistics(points[:, body], model) for body in bodies]
    best = max(range(len(found)), key=lambda k: (not found[k].note, found[k].fit, -k))
    labels = np.full(points.shape[1], -1, dtype=np.int64)
    sure = np.zeros(points.shape[1])
    labels[bodies[best]], sure[bodies[best]] = found[best].labels, found[best].confidence
    return replace(found[best], labels=labels, confidence=sure, bodies=len(bodies))


def _of_person(found: Signature, layout: Layout, model: TopologicalModel) -> Solved | str | None:
    """Label points as the one person's the model was learnt from, or say that they are mirrored."""
    names = layout.template.labels
    rigid = rigid_pairs(model, names, model.statistics)
    if not rigid.any():
        return None
    own = replace(layout, template=template_of_person(layout.template, rigid))
    size = own.template.size
    problem = problem_of(found, size, own.template)
    at = {label: i for i, label in enumerate(names)}
    segments = [[at[x] for x in (*s.markers, *s.shared) if x in at] for s in model.segments]
    labels = seated(problem, found.mean, size * own.template.mean, rigid, SKIN, segments)
    labels, energy = refined(problem, labels, own)
    # true labels of a mirrored body disagree with its handedness, those found agree with it
    turned = problem.agreement(np.where(labels >= 0, layout.twin[labels], -1)) < 0
    if turned and is_mirrored(found.mean, labels, layout.twin, own.template, rigid):
        return MIRROR_IMAGE.format(model.name)
    if not is_the_person(found.mean, labels, own.template, rigid):
        return None
    solved = finished(found, size, own, problem, labels, energy, [])
    wanted = size * own.template.mean
    held = held_to_distances(problem, found.mean, solved.labels, wanted, rigid, segments)
    margins = np.where(held == solved.labels, solved.margins, MARGIN)
    return Solved(solved.problem, held, solved.problem.energy(held), margins, [])
