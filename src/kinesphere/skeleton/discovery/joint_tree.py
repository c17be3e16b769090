"""Which bodies meet at joints: a spanning forest of joint costs."""

from collections.abc import Sequence
from itertools import combinations

import numpy as np

from kinesphere.skeleton.discovery.forest import Forest, Pair, forest_of
from kinesphere.skeleton.discovery.joint_costs import JointCosts, Members
from kinesphere.skeleton.topology import spanning_tree

APART = 0.06
"""m, least joint cost from which two bodies of a person's size may be no neighbours: on the
recordings at hand joints cost up to 24 mm, bodies of different people a tenth of their way."""
FAR_BEYOND = 3.0
"""Times the median cost of the cheaper joints from which on one is none."""


def find_forest(costs: JointCosts, bodies: Sequence[Members]) -> Forest:
    """Join bodies by the cheapest joints, unless those cost more than joints do.

    Parameters
    ----------
    costs
    bodies
        Columns of each body's markers.
    """
    n = len(bodies)
    between: dict[Pair, float] = {}
    for i, j in combinations(range(n), 2):
        between[i, j] = costs.between(bodies[i], bodies[j])
    names = tuple(str(i) for i in range(n))
    by_name = {(str(i), str(j)): cost for (i, j), cost in between.items()}
    chosen = [(int(a), int(b)) for a, b in spanning_tree(names, by_name)]
    kept: list[Pair] = []
    for pair in chosen:  # cheapest first: each is judged by those before it
        usual = float(np.median([between[other] for other in kept])) if kept else 0.0
        if between[pair] <= max(FAR_BEYOND * usual, APART):
            kept.append(pair)
    return forest_of(kept, between, tuple(len(members) for members in bodies))
