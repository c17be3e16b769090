"""The labels of least energy: annealing from several starts, then exchanges of whole blocks."""

from typing import NamedTuple

import numpy as np

from kinesphere.data import Array
from kinesphere.labelling import kernels
from kinesphere.labelling.problem import Labels, Problem

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


def find_labels(
    problem: Problem, moves: Labels, near: Labels, *, nullable: bool, starts: int = STARTS
) -> Found:
    """Search for the labels of least energy.

    Parameters
    ----------
    moves : (n_moves, n_labels)
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
    return Found(labels, energy, len(ends), agreeing)


def exchange_blocks(
    problem: Problem, labels: Labels, moves: Labels, *, nullable: bool
) -> tuple[Labels, float]:
    """Return labels after exchanges of blocks, each followed by a descent, as long as that helps."""
    energy = problem.energy(labels)
    known = {labels.tobytes()}
    while len(moves):
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


def _promising(problem: Problem, labels: Labels, moves: Labels) -> list[Labels]:
    """Return what the most promising one or two moves lead to, further ones added greedily."""
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
    return found


def _greedy(problem: Problem, labels: Labels, moves: Labels, energy: float) -> Labels:
    while True:
        energies = np.empty(len(moves))
        every = np.arange(len(problem.quadruples))
        kernels.move_energies(labels, moves, problem.costs, *problem.handed, every, energies)
        best = int(energies.argmin())
        if not energies[best] < energy - 1e-6:
            return labels
        labels, energy = _moved(labels, moves[best]), float(energies[best])


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


def nearest_labels(mean: Array) -> Labels:
    """Return for each label all labels, the nearest first, by mean distances (n, n)."""
    known = np.where(np.isfinite(mean), mean, np.inf)
    np.fill_diagonal(known, 0.0)
    return np.argsort(known, axis=1, kind="stable").astype(np.int64)
