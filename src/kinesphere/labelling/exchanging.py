"""Whole blocks of labels exchanged, and neighbourhoods shuffled, while that helps."""

import numpy as np

from kinesphere.labelling import kernels
from kinesphere.labelling.blocks import Moves
from kinesphere.labelling.problem import Labels, Problem

BLOCKS = 12
"""Exchanges of blocks that are followed to their end, the most promising first."""
SHAKES = 100
"""Neighbourhoods shuffled at the end."""
NEIGHBOURS = (4, 10)
"""Labels in one of them."""


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
    some, weights = problem.thinned
    every = np.arange(len(some))
    kernels.block_energies(
        labels, moves, problem.costs, some, weights, problem.table, every, energies
    )
    found = []
    for code in np.argsort(energies, axis=None, kind="stable")[:BLOCKS]:
        x, y = divmod(int(code), n)
        if not np.isfinite(energies[x, y]):
            break
        tried = _moved(labels, moves[x])
        tried = _moved(tried, moves[y]) if y > x else tried
        found.append(_greedy(problem, tried, moves, problem.energy(tried)))
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
