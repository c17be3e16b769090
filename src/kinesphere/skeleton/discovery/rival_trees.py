"""Trees that are about as likely as the one that was found."""

from collections.abc import Iterator
from itertools import combinations, product

import numpy as np

from kinesphere.skeleton.discovery.forest import Forest, forest_of, pair_of, rivals_of

SWAPPED = 0.3
"""Confidence of an edge below which its rival is tried where that could make a person of a tree."""
MOST_SWAPPED = 5
"""Edges that are tried so, the most doubtful ones."""
MOST_RIVALS = 3
"""Rivals of each."""


def similar_forests(forest: Forest, tree: int) -> Iterator[tuple[Forest, float]]:
    """Yield the forest, then those that differ from it in one or two doubtful edges of a tree.

    Yields
    ------
    Forest
    float
        How much less likely it is: the sum of log(cost of the other edge / cost of the edge).
    """
    yield forest, 0.0
    inside = set(forest.trees[tree])
    doubtful = [
        pair_of(edge)
        for edge in sorted(forest.edges, key=lambda edge: edge.confidence)
        if edge.a in inside and edge.confidence < SWAPPED
    ][:MOST_SWAPPED]
    pairs, n = [pair_of(edge) for edge in forest.edges], len(forest.sizes)
    ways = {
        pair: [
            rival
            for rival in rivals_of(pairs, pair, forest.costs, n)[:MOST_RIVALS]
            if forest.costs[rival] * (1 - SWAPPED) <= forest.costs[pair]
        ]
        for pair in doubtful
    }
    for count in (1, 2):
        for given_up in combinations(doubtful, count):
            for taken in product(*(ways[pair] for pair in given_up)):
                kept = [pair for pair in pairs if pair not in given_up]
                if len({*kept, *taken}) < len(pairs):
                    continue
                swapped = forest_of([*kept, *taken], forest.costs, forest.sizes)
                if len(swapped.trees) == len(forest.trees):  # else the two made a ring
                    yield (
                        swapped,
                        sum(
                            float(np.log(forest.costs[new] / forest.costs[old]))
                            for old, new in zip(given_up, taken, strict=True)
                        ),
                    )
