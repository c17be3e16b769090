"""The labels of least energy: annealing from several starts, then exchanges of whole blocks."""

from typing import NamedTuple

import numpy as np

from kinesphere.data import Array
from kinesphere.labelling import kernels
from kinesphere.labelling.blocks import Moves
from kinesphere.labelling.problem import INTO_FREE, Labels, Problem
from kinesphere.labelling.slides import slide

STEPS = 20_000
"""Exchanges tried in one annealing of 41 markers; in proportion to the square of their number."""
HOT, COLD = 15.0, 1.0
"""Temperatures in nats: from half of what a marker's label is worth to less than any exchange."""
STARTS = 12
"""Most annealings."""
AGREEING = 3
"""Starts that end in one place from which on no more are made."""
BLOCKS = 12
"""Exchanges of blocks that are followed to their end, the most promising first."""
SHAKES = 100
"""Neighbourhoods shuffled at the end."""
NEIGHBOURS = (4, 10)
"""Labels in one of them."""
SLIDING = 6
"""Nearest labels whose points might as well belong to a free one."""
SETTLING = 10
"""Labels around an exchange that settle anew."""
ROUNDS = 10
"""Most improvements followed while labels are doubted."""
SEED = 20100517
"""Same input, same labels."""


class Found(NamedTuple):
    """Labels, and how they came out."""

    labels: Labels
    energy: float
    starts: int
    """Annealings made."""
    agreeing: int
    """How many of them ended here."""
    rivals: tuple[tuple[float, Labels], ...]
    """Energy and labels of where the others ended."""


def find_labels(
    problem: Problem, moves: Moves, near: Labels, *, nullable: bool, starts: int = STARTS
) -> Found:
    """Search for the labels of least energy.

    Parameters
    ----------
    moves
        Exchanges of blocks, as ``block_moves`` returns them.
    near : (n_labels, n_labels)
        For each label all labels, the nearest first, itself included.
    nullable
        Whether points may stay without a label, and labels without a point, beyond what their
        numbers force.
    """
    rng = np.random.default_rng(SEED)
    n, m = problem.n_points, problem.n_labels
    n_steps = max(500, round(STEPS * max(n, m) * m / 41**2))
    ends: list[tuple[float, bytes, Labels]] = []
    for _ in range(starts):
        labels = np.full(n, -1, dtype=np.int64)
        labels[rng.permutation(n)[:m]] = rng.permutation(m)[:n]
        labels = problem.anneal(labels, rng.random((n_steps, 3)), HOT, COLD)
        labels = problem.descend(labels, nullable=nullable)
        labels, energy = exchange_blocks(problem, labels, moves, nullable=nullable)
        ends.append((energy, labels.tobytes(), labels))
        best = min(ends, key=lambda end: end[:2])
        agreeing = sum(end[1] == best[1] for end in ends)
        if agreeing >= AGREEING:
            break
    labels, energy = shake(problem, best[2], near, rng, nullable=nullable)
    labels, energy = exchange_blocks(problem, labels, moves, nullable=nullable)
    rivals = tuple((end[0], end[2]) for end in ends)
    return Found(labels, energy, len(ends), agreeing, rivals)


def exchange_blocks(
    problem: Problem, labels: Labels, moves: Moves, *, nullable: bool
) -> tuple[Labels, float]:
    """Return labels after exchanges of blocks, each followed by a descent, while that helps."""
    energy = problem.energy(labels)
    known = {labels.tobytes()}
    while True:
        best = None
        for tried in _promising(problem, labels, moves):
            changed = problem.descend(tried, nullable=nullable)
            if changed.tobytes() in known:
                continue
            known.add(changed.tobytes())
            reached = problem.energy(changed)
            if reached < energy - 1e-6 and (best is None or reached < best[0]):
                best = reached, changed
        if best is None:
            break
        energy, labels = best
    return labels, energy


def _promising(problem: Problem, labels: Labels, blocks: Moves) -> list[Labels]:
    """Return what the most promising one or two moves lead to, further ones added greedily."""
    moves = blocks.every
    n = len(moves)
    energies = np.full((n, n), np.inf)
    every = np.arange(len(problem.quadruples))
    kernels.block_energies(labels, moves, problem.costs, *problem.handed, every, energies)
    found = []
    for code in np.argsort(energies, axis=None, kind="stable")[:BLOCKS]:
        x, y = divmod(int(code), n)
        if not np.isfinite(energies[x, y]):
            break
        tried = _moved(labels, moves[x])
        tried = _moved(tried, moves[y]) if y > x else tried
        found.append(_greedy(problem, tried, moves, energies[x, y]))
    # a body taken for one that faces the other way: mirrored, and every segment turned
    mirrored = _moved(labels, blocks.every[0])
    found.append(_greedy(problem, mirrored, blocks.turns, problem.energy(mirrored)))
    return found


def _greedy(problem: Problem, labels: Labels, moves: Labels, energy: float) -> Labels:
    while len(moves):
        energies = np.empty(len(moves))
        every = np.arange(len(problem.quadruples))
        kernels.move_energies(labels, moves, problem.costs, *problem.handed, every, energies)
        best = int(energies.argmin())
        if not energies[best] < energy - 1e-6:
            return labels
        labels, energy = _moved(labels, moves[best]), float(energies[best])
    return labels


def _moved(labels: Labels, move: Labels) -> Labels:
    return np.where(labels >= 0, move[labels], -1)


def shake(
    problem: Problem, labels: Labels, near: Labels, rng: np.random.Generator, *, nullable: bool
) -> tuple[Labels, float]:
    """Return labels after shuffling neighbourhoods, each followed by a descent among its own."""
    energy = problem.energy(labels)
    for _ in range(SHAKES):
        size = int(rng.integers(NEIGHBOURS[0], NEIGHBOURS[1] + 1))
        targets = near[rng.integers(len(near)), :size]
        held = problem.holders(labels)[targets]
        points = held[held >= 0]
        changed = labels.copy()
        changed[points] = rng.permutation(targets)[: len(points)]
        changed = problem.descend(changed, nullable=nullable, points=points, targets=targets)
        reached = problem.energy(changed)
        if reached < energy - 1e-6:
            labels, energy = changed, reached
    return labels, energy


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


def nearest_labels(mean: Array) -> Labels:
    """Return for each label all labels, the nearest first, by mean distances (n, n)."""
    known = np.where(np.isfinite(mean), mean, np.inf)
    np.fill_diagonal(known, 0.0)
    return np.argsort(known, axis=1, kind="stable").astype(np.int64)
