"""How sure labels are, and whether they are given at all."""

import numpy as np
from numpy.typing import NDArray

from kinesphere.data import Array
from kinesphere.labelling.layout import Layout, Solved
from kinesphere.labelling.matching import Match
from kinesphere.labelling.template import LEAST_LABELS

MARGIN = 8.0
"""Nats of energy at which a label is held 63 % sure: neighbouring pairs tell much the same, so a
nat of energy is worth far less than one of evidence."""
ALONE = 4
"""Labels that may differ for a nat between two labellings to count in full; between labellings
that have more labels different it is shared among them, for each of those costs as much by chance
as it does alone."""
WORST_FIT = 0.8
"""Nats a pair by which labels must fit better than nothing; right labels of other people have 1.3
and more, points that move at random reach 0.5."""
LEAST_AGREEMENT = 0.3
"""Handedness that must agree: right labels have 0.6 and more. It does not tell mirrored points: a
body is nearly its own mirror image, so labels with left and right exchanged agree as well."""


def verdict(
    solved: Solved, layout: Layout, kept: NDArray[np.intp], n_points: int, name: str
) -> Match:
    """Return the labels of a solved problem, unless they fit too badly to be given."""
    confidence = confidence_of(solved, layout)
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
    if solved.converged == 0 and not confidence.any():
        return match.refused(
            f"no two starts of the search ended in the same labels of {name}: longer motion, or a "
            "model of more people, tells more"
        )
    return match


def confidence_of(solved: Solved, layout: Layout) -> Array:
    """Return 0…1 for each point, by the least rise of energy that changes its label.

    Where one start alone ended in the labels, those that another end denies have none.
    """
    problem, labels = solved.problem, solved.labels
    margin = solved.margins.copy()
    for move in layout.moves.every:
        changed = np.where(labels >= 0, move[labels], -1)
        rise = problem.energy(changed) - solved.energy
        moved = changed != labels
        margin[moved] = np.minimum(margin[moved], rise)
    for energy, other in solved.rivals:
        moved = other != labels
        rise = (energy - solved.energy) * min(1.0, ALONE / max(int(moved.sum()), 1))
        rise *= solved.converged  # what one start alone ended in is hardly the best
        margin[moved] = np.minimum(margin[moved], rise)
    return 1 - np.exp(-np.maximum(margin, 0.0) / MARGIN)
