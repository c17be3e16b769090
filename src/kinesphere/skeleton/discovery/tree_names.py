"""Which of the trees that are about as likely is a person, and what its limbs are called."""

from dataclasses import replace

import numpy as np

from kinesphere.data import Array
from kinesphere.skeleton.discovery.animal import cost_of_animal
from kinesphere.skeleton.discovery.figure import make_figure
from kinesphere.skeleton.discovery.forest import Forest
from kinesphere.skeleton.discovery.joint_costs import JointCosts
from kinesphere.skeleton.discovery.names import Names, find_names, no_names
from kinesphere.skeleton.discovery.partition import Partition
from kinesphere.skeleton.discovery.rival_trees import similar_forests
from kinesphere.skeleton.discovery.settings import DiscoverySettings
from kinesphere.skeleton.discovery.steadiness import owners

UNLIKELY = 20.0
"""What a doubtful edge's rival costs for each e-fold that its own cost is larger: 15 % more cost as
much as three squared standard deviations of a person's proportions."""


def named_tree(
    partition: Partition, costs: JointCosts, settings: DiscoverySettings
) -> tuple[Partition, tuple[int, ...], Names]:
    """Name the limbs of the tree that was asked for.

    Where an edge is doubtful and the next best one makes a person of the tree, that one counts:
    people are what is mostly recorded.
    """
    at = settings.tree - 1
    tree = partition.forest.trees[at]
    if not settings.names:
        return partition, tree, no_names(tree)
    over: dict[frozenset[int], list[int]] = {}
    owner = owners(partition.bodies, len(partition.rigidity.mean))
    for m in partition.shared:
        pair = frozenset((int(owner[m]), int(partition.belonging.neighbour[m])))
        over.setdefault(pair, []).append(m)
    places: dict[frozenset[int], Array] = {}

    ways = []
    for forest, unlikely in similar_forests(partition.forest, at):
        there = next(t for t in forest.trees if tree[0] in t)
        pairs = [(edge.a, edge.b) for edge in forest.edges if edge.a in there]
        figure = make_figure(costs, partition.bodies, pairs, over, places)
        ways.append((UNLIKELY * unlikely, forest, there, figure))
    animal = min(off + cost_of_animal(figure, there) for off, _, there, figure in ways)
    best: tuple[float, Forest, tuple[int, ...], Names] | None = None
    for off, forest, there, figure in ways:
        names = find_names(figure, there, animal - off)
        cost = names.cost + off if names.given else np.inf
        if best is None or cost < best[0]:
            best = cost, forest, there, names
    assert best is not None  # the forest itself is the first
    _, forest, there, names = best
    return replace(partition, forest=forest), there, names
