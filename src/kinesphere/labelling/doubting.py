"""Every label doubted: what else it could be, and what that would cost."""

import numpy as np

from kinesphere.data import Array
from kinesphere.labelling.problem import INTO_FREE, Labels, Problem
from kinesphere.labelling.slides import slide

SLIDING = 6
"""Nearest labels whose points might as well belong to a free one."""
SETTLING = 10
"""Labels around an exchange that settle anew."""
NEIGHBOURHOODS = 40
"""Neighbourhoods annealed from the labels that are to be doubted."""
LABELS = (4, 10)
"""Labels in one of them."""
STEPS_A_LABEL = 150
"""Exchanges tried for each."""
HOT, COLD = 8.0, 1.0
"""Their temperatures in nats."""
ROUNDS = 10
"""Most improvements followed while labels are doubted."""


def doubt(
    problem: Problem, labels: Labels, near: Labels, twin: Labels, *, nullable: bool
) -> tuple[Labels, float, Array]:
    """Ask of every label what else could be, and go there if it is better.

    Each point is given its best other label, and each free label each point nearby, while the
    neighbours settle anew around it; and chains of markers slide by one, where one is missing.

    Returns
    -------
    labels, energy, margins
        Margins (n_points,): the least rise of energy found that changes a point's label.
    """
    energy = problem.energy(labels)
    for _ in range(ROUNDS):
        margins, rivals = problem.least_changes(labels)
        rises, slid, reached = slide(problem, labels, near, twin)
        margins = np.minimum(margins, INTO_FREE * rises)
        best = (reached, slid) if reached < energy - 1e-6 else None
        tries = [(a, int(j)) for a, j in enumerate(rivals) if j >= 0]
        for free in np.flatnonzero(problem.holders(labels) < 0):
            held = problem.holders(labels)[near[free, 1:SLIDING]]
            tries += [(int(a), int(free)) for a in held if a >= 0]
        for a, j in tries:
            changed = _settled(problem, labels, a, j, near, nullable=nullable)
            reached = problem.energy(changed)
            moved = changed != labels
            same = (np.sort(changed) == np.sort(labels)).all()
            rise = (reached - energy) * (1.0 if same else INTO_FREE)
            margins[moved] = np.minimum(margins[moved], rise)
            if reached < energy - 1e-6 and (best is None or reached < best[0]):
                best = reached, changed
        if best is None:
            return labels, energy, margins
        energy, labels = best[0], problem.descend(best[1], nullable=nullable)
        energy = problem.energy(labels)
    return labels, energy, margins


def _settled(
    problem: Problem, labels: Labels, a: int, j: int, near: Labels, *, nullable: bool
) -> Labels:
    """Return labels with point a bearing j whatever happens, its neighbours having settled."""
    changed = labels.copy()
    holder = problem.holders(labels)
    old, b = labels[a], holder[j]
    changed[a] = j
    if b >= 0:
        changed[b] = old
    around = near[j, :SETTLING]
    if old >= 0:
        around = np.union1d(around, near[old, :SETTLING])
    targets = around[around != j]
    held = problem.holders(changed)[targets]
    points = held[held >= 0]
    return problem.descend(changed, nullable=nullable, points=points, targets=targets)


def shaken(
    problem: Problem, labels: Labels, energy: float, margins: Array, near: Labels
) -> tuple[Labels, float, Array]:
    """Anneal neighbourhoods anew and see where they end: what ``doubt`` does not lead to.

    Markers that take each other's label in rings of three and more are reached by no exchange of
    two, and may fit nearly as well.

    Returns
    -------
    labels, energy, margins
        As ``doubt`` does. Where a neighbourhood ends lower, its labels are taken, and margins are
        those of the labels before: they are to be doubted once more.
    """
    rng = np.random.default_rng(0)
    margins, best = margins.copy(), (energy, labels)
    for k in range(NEIGHBOURHOODS):
        size = int(rng.integers(LABELS[0], LABELS[1] + 1))
        targets = near[k * len(near) // NEIGHBOURHOODS, :size]
        held = problem.holders(labels)[targets]
        points = held[held >= 0]
        if len(points) < 2:
            continue
        draws = rng.random((STEPS_A_LABEL * len(points), 3))
        changed = problem.anneal(labels, draws, HOT, COLD, points=points, targets=targets)
        if (changed == labels).all():
            continue
        reached = problem.energy(changed)
        moved = changed != labels
        same = (np.sort(changed) == np.sort(labels)).all()
        rise = (reached - energy) * (1.0 if same else INTO_FREE)
        margins[moved] = np.minimum(margins[moved], max(rise, 0.0))
        if reached < best[0] - 1e-6:
            best = reached, changed
    return best[1], best[0], margins
