"""The labels of least energy of one set of points, scale included."""

import math

import numpy as np

from kinesphere.geometry.signature import Signature, scale_of
from kinesphere.labelling.doubting import doubt, shaken
from kinesphere.labelling.exchanging import exchange_blocks, shake
from kinesphere.labelling.layout import Layout, Solved
from kinesphere.labelling.problem import Labels, Problem, problem_of
from kinesphere.labelling.search import AGREEING, find_labels, glance
from kinesphere.labelling.shapes import alike
from kinesphere.labelling.template import Template

RESCALED = 0.01
"""Change of scale after a first labelling from which on costs are computed anew."""

FEW = 0.9
"""Points, as a share of the labels, below which the shortest tree does not tell the scale."""
STEP = 1.3
"""Most ratio of two scales tried then: a template's distances spread by an eighth."""
MOST_STEPS = 4


def solve(found: Signature, layout: Layout, given: Labels | None = None) -> Solved:
    """Search for the labels of points by nothing but their statistics.

    Parameters
    ----------
    given : (n_points,)
        Labels that are right in parts, if known: they tell the scale, and are one more start.
    """
    template = layout.template
    if given is None:
        share = (template.n - 1) / max(min(found.n, template.n) - 1, 1)
        scale = scale_of(found.mean) * share
        if found.n < FEW * template.n:
            scale, given = best_scale(found, layout, scale, share)
    else:
        scale = scale_by_labels(found, given, template)
    problem = problem_of(found, scale, template)
    # where there are no more points than labels, all are first taken for markers
    begin = alike(found.mean / scale, template.mean, layout.twin)
    begin += [] if given is None else [given]
    best = find_labels(problem, layout.moves, begin, nullable=found.n > template.n)
    labels, rivals = best.labels, list(best.rivals)
    rescaled = scale_by_labels(found, labels, template)
    if abs(rescaled / scale - 1) > RESCALED:
        scale = rescaled
        problem = problem_of(found, scale, template)
        rivals = _descended(problem, rivals)
        labels = min(rivals, key=lambda end: (end[0], end[1].tobytes()))[1]
    labels, energy = refined(problem, labels, layout)
    solved = finished(found, scale, layout, problem, labels, energy, rivals)
    return solved._replace(converged=min(1.0, (best.agreeing - 1) / (AGREEING - 1)))


def best_scale(
    found: Signature, layout: Layout, whole: float, share: float
) -> tuple[float, Labels]:
    """Return the scale of a body that wears few of the labels, and labels to start from.

    Points that lack a limb join to a tree shorter by their share of the labels; points all over
    the body that lack every other label join to one as long as the whole. So a glance is taken
    at scales from one to the other, and the labels of least energy at their own scale tell it.

    Parameters
    ----------
    whole
        The scale if the points lack whole limbs.
    share
        Its ratio to the length of their own tree.
    """
    template = layout.template
    steps = min(max(math.ceil(math.log(share) / math.log(STEP)), 1), MOST_STEPS)
    tried = []
    for k in range(steps + 1):
        scale = whole / share ** (k / steps)
        begin = alike(found.mean / scale, template.mean, layout.twin)
        labels = glance(problem_of(found, scale, template), layout.moves, begin, nullable=False)[1]
        own = scale_by_labels(found, labels, template)
        problem = problem_of(found, own, template)
        labels = problem.descend(labels, nullable=True)
        tried.append((problem.energy(labels), own, labels))
    _, own, labels = min(tried, key=lambda one: one[:2])
    return own, labels


def _descended(problem: Problem, rivals: list[tuple[float, Labels]]) -> list[tuple[float, Labels]]:
    """Return where other labels end in a problem, and their energy there."""
    ends = [problem.descend(labels, nullable=True) for _, labels in rivals]
    return [(problem.energy(labels), labels) for labels in ends]


def continued(found: Signature, layout: Layout, labels: Labels) -> Solved:
    """Improve and complete labels that are there already."""
    scale = scale_by_labels(found, labels, layout.template)
    problem = problem_of(found, scale, layout.template)
    labels, energy = refined(problem, labels, layout)
    return finished(found, scale, layout, problem, labels, energy, [])


def finished(
    found: Signature,
    scale: float,
    layout: Layout,
    problem: Problem,
    labels: Labels,
    energy: float,
    rivals: list[tuple[float, Labels]],
) -> Solved:
    """Try unpaired markers on the other side, then doubt every label."""
    template = layout.template
    for label in np.flatnonzero(layout.twin == np.arange(template.n)):
        turned = template.with_other_side(int(label), layout.twin)
        other = problem_of(found, scale, turned, (problem, int(label)))
        if other.energy(labels) < energy - 1e-6:
            template, problem = turned, other
            labels, energy = refined(problem, labels, layout)
            rivals = _descended(problem, rivals)
    labels, energy, margins = doubt(problem, labels, layout.near, layout.twin, nullable=True)
    better, _, margins = shaken(problem, labels, energy, margins, layout.near)
    if (better != labels).any():
        labels = problem.descend(better, nullable=True)
        labels, energy, margins = doubt(problem, labels, layout.near, layout.twin, nullable=True)
    return Solved(problem, labels, energy, margins, rivals)


def refined(problem: Problem, labels: Labels, layout: Layout) -> tuple[Labels, float]:
    """Return labels after exchanges of two, of blocks and within neighbourhoods; their energy."""
    rng = np.random.default_rng(0)
    labels = problem.descend(labels, nullable=True)
    labels, _ = exchange_blocks(problem, labels, layout.moves, nullable=True)
    labels, _ = shake(problem, labels, layout.near, rng, nullable=True)
    return exchange_blocks(problem, labels, layout.moves, nullable=True)


def scale_by_labels(found: Signature, labels: Labels, template: Template) -> float:
    """Return the scale at which the labelled distances are on the whole the template's."""
    given = np.flatnonzero(labels >= 0)
    rows, columns = np.triu_indices(len(given), 1)
    seen = found.mean[given[rows], given[columns]]
    expected = template.mean[labels[given[rows]], labels[given[columns]]]
    ratio = seen / expected
    ratio = ratio[np.isfinite(ratio)]
    return float(np.median(ratio)) if len(ratio) else scale_of(found.mean)
