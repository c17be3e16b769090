"""Chains of points that slide by one label, into the place of a marker that is not there.

Where a marker is missing, a neighbour fits its label nearly as well, that one's label is fitted by
the next one, and so on: each step may cost more than the whole chain. So chains are followed as
wholes, the least costly first.
"""

import heapq

import numpy as np

from kinesphere.data import Array
from kinesphere.labelling.problem import Labels, Problem

SOURCES = 8
"""Nearest labels whose points might as well belong to a free one."""
HIGHEST = 40.0
"""Nats by which the energy may rise on the way."""
FOLLOWED = 150
"""Chains that are continued by a further point."""
MOST = 3000
"""Chains whose energy is looked at."""


def slide(
    problem: Problem, labels: Labels, near: Labels, twin: Labels
) -> tuple[Array, Labels, float]:
    """Let points slide into labels that nobody bears, one after another, none of them twice.

    Parameters
    ----------
    near : (n_labels, n_labels)
        For each label all labels, the nearest first, itself included.
    twin : (n_labels,)
        The label of the other side: with one leg missing half, its markers take the other's.

    Returns
    -------
    rises : (n_points,)
        The least rise of energy among the chains that move a point; inf where none does.
    best, energy
        The labels of least energy among all chains, those given included.
    """
    start = problem.energy(labels)
    rises = np.full(len(labels), np.inf)
    best, lowest = labels, 0.0
    waiting = [(0.0, 0, labels)]
    known = {labels.tobytes()}
    followed = 0
    while waiting and followed < FOLLOWED and len(known) < MOST:
        rise, _, chain = heapq.heappop(waiting)
        followed += 1
        if rise < lowest - 1e-6:
            best, lowest = chain, rise
        moved = chain != labels
        rises[moved] = np.minimum(rises[moved], rise)
        holder = problem.holders(chain)
        for free in np.flatnonzero(holder < 0):
            for source in sorted({*near[free, 1:SOURCES].tolist(), int(twin[free])}):
                point = int(holder[source])
                if point < 0 or moved[point]:
                    continue
                longer = chain.copy()
                longer[point] = free
                key = longer.tobytes()
                if key in known:
                    continue
                known.add(key)
                risen = problem.energy(longer) - start
                if risen < HIGHEST:
                    heapq.heappush(waiting, (risen, len(known), longer))
    return rises, best, start + lowest
