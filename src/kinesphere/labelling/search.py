"""The labels of least energy: many starts annealed, the best of them mended where they fit worst.

Annealed from random labels, a body ends in one of many labellings that are right in parts and that
no exchange of two labels leads out of. Two things help: starts that have the body's shape
(``labelling.shapes``), and annealing anew only the points that fit worst beside the others (large
neighbourhood search [1]_), for the wrong ones are among those.

References
----------
.. [1] Shaw (1998), Principles and Practice of Constraint Programming, LNCS 1520, 417-431.
"""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from kinesphere.data import Array
from kinesphere.labelling.blocks import Moves
from kinesphere.labelling.exchanging import exchange_blocks
from kinesphere.labelling.problem import Labels, Problem

STEPS = 20_000
"""Exchanges tried in one annealing of 41 markers; in proportion to the square of their number."""
HOT, WARM, COLD = 15.0, 8.0, 1.0
"""Temperatures in nats: from half of what a marker's label is worth (from labels at random) or a
quarter (from labels that are right in parts) to less than any exchange."""
STARTS = (24, 6)
"""Annealings from starts that are given, the best first, and from labels at random."""
GLANCES = (6, 2)
"""And of those that only tell whether a search is worth it."""
GLANCED = 2
"""Ends that are mended then."""
MENDED = 16
"""Most ends of one round that are mended, the best first."""
AGREEING = 4
"""Ends that are mended into one place from which on no more are."""
ROUNDS = 3
"""Most rounds of annealings, while ends do not agree: a second finds what the first found once."""
MENDINGS = 20
"""Annealings of what fits worst, of one end."""
WORST = (5, 25)
"""Points in one of them."""
STEPS_A_POINT = 200
"""Exchanges tried for each."""
NOISE = (3.0, 10.0, 30.0)
"""Nats by which it is left to chance which points fit worst; one of these each time."""
SLACK = 15.0
"""Nats that a descent after such an annealing gains at most, next to always."""
SEED = 20100517
"""Same input, same labels."""


class End(NamedTuple):
    """Where a search ended, and how often it did."""

    energy: float
    labels: Labels
    times: int


class Found(NamedTuple):
    """Labels, and how they came out."""

    labels: Labels
    energy: float
    starts: int
    """Annealings made."""
    agreeing: int
    """How many of those mended ended here."""
    rivals: tuple[tuple[float, Labels], ...]
    """Energy and labels of where all of them ended, these included."""


def find_labels(
    problem: Problem, moves: Moves, begin: Sequence[Labels], *, nullable: bool
) -> Found:
    """Search for the labels of least energy.

    Parameters
    ----------
    moves
        Exchanges of blocks, as ``block_moves`` returns them.
    begin
        Labels to start from, in any order; may be none.
    nullable
        Whether points may stay without a label, and labels without a point, beyond what their
        numbers force.
    """
    rng = np.random.default_rng(SEED)
    reached: dict[bytes, End] = {}
    rivals: dict[bytes, tuple[float, Labels]] = {}
    starts = 0
    for _ in range(ROUNDS):
        ends = _annealed(problem, begin, rng, nullable=nullable)
        starts += sum(end.times for end in ends)
        rivals |= {end.labels.tobytes(): (end.energy, end.labels) for end in ends}
        for end in ends[:MENDED]:
            labels, _ = exchange_blocks(problem, end.labels, moves, nullable=nullable)
            labels = mended(problem, labels, rng, nullable=nullable)
            labels, energy = exchange_blocks(problem, labels, moves, nullable=nullable)
            before = reached.get(labels.tobytes())
            times = end.times + (before.times if before else 0)
            reached[labels.tobytes()] = End(energy, labels, times)
            best = min(reached.values(), key=_order)
            if best.times >= AGREEING:
                break
        if best.times >= AGREEING:
            break
    rivals |= {key: (end.energy, end.labels) for key, end in reached.items()}
    return Found(best.labels, best.energy, starts, best.times, tuple(rivals.values()))


def glance(problem: Problem, moves: Moves, begin: Sequence[Labels], *, nullable: bool) -> End:
    """Return the best end of few annealings: what a search in this problem is likely to find."""
    rng = np.random.default_rng(SEED)
    ends = _annealed(problem, begin, rng, starts=GLANCES, nullable=nullable)
    tried = []
    for end in ends[:GLANCED]:
        labels = mended(problem, end.labels, rng, nullable=nullable)
        labels, energy = exchange_blocks(problem, labels, moves, nullable=nullable)
        tried.append(End(energy, labels, end.times))
    return min(tried, key=_order)


def _annealed(
    problem: Problem,
    begin: Sequence[Labels],
    rng: np.random.Generator,
    *,
    nullable: bool,
    starts: tuple[int, int] = STARTS,
) -> list[End]:
    """Return where annealings end, the best first."""
    n, m = problem.n_points, problem.n_labels
    n_steps = max(500, round(STEPS * max(n, m) * m / 41**2))
    first = [(labels, WARM) for labels in sorted(begin, key=problem.energy)[: starts[0]]]
    for _ in range(sum(starts) - len(first)):
        labels = np.full(n, -1, dtype=np.int64)
        labels[rng.permutation(n)[:m]] = rng.permutation(m)[:n]
        first.append((labels, HOT))
    ends: dict[bytes, End] = {}
    for labels, hot in first:
        labels = problem.anneal(labels, rng.random((n_steps, 3)), hot, COLD)
        labels = problem.descend(labels, nullable=nullable)
        before = ends.get(labels.tobytes())
        times = before.times + 1 if before else 1
        ends[labels.tobytes()] = End(problem.energy(labels), labels, times)
    return sorted(ends.values(), key=_order)


def _order(end: End) -> tuple[float, bytes]:
    return end.energy, end.labels.tobytes()


def mended(problem: Problem, labels: Labels, rng: np.random.Generator, *, nullable: bool) -> Labels:
    """Return labels after annealing the points that fit worst, again and again."""
    energy, n = problem.energy(labels), problem.n_points
    for _ in range(MENDINGS):
        size = int(rng.integers(WORST[0], WORST[1] + 1))
        noise = rng.choice(NOISE) * rng.gumbel(size=n)
        points = np.argsort(-(_misfit(problem, labels) + noise), kind="stable")[:size]
        holder = problem.holders(labels)
        targets = np.union1d(labels[points][labels[points] >= 0], np.flatnonzero(holder < 0))
        draws = rng.random((STEPS_A_POINT * len(points), 3))
        changed = problem.anneal(labels, draws, WARM, COLD, points=points, targets=targets)
        if (changed == labels).all() or problem.energy(changed) > energy + SLACK:
            continue
        changed = problem.descend(changed, nullable=nullable)
        reached = problem.energy(changed)
        if reached < energy - 1e-6:
            labels, energy = changed, reached
    return labels


def _misfit(problem: Problem, labels: Labels) -> Array:
    """Return how badly each point fits; one without label as the middle one of those with."""
    energies = problem.energies(labels)
    labelled = labels >= 0
    energies[~labelled] = np.median(energies[labelled]) if labelled.any() else 0.0
    return energies


def nearest_labels(mean: Array) -> Labels:
    """Return for each label all labels, the nearest first, by mean distances (n, n)."""
    known = np.where(np.isfinite(mean), mean, np.inf)
    np.fill_diagonal(known, 0.0)
    return np.argsort(known, axis=1, kind="stable").astype(np.int64)
