"""Two bodies that are one: what the clustering took apart though it hardly moves."""

from collections.abc import Sequence

import numpy as np

from kinesphere.data import Array
from kinesphere.skeleton.discovery.chains import widest
from kinesphere.skeleton.discovery.joint_costs import JointCosts, Members
from kinesphere.skeleton.discovery.joint_tree import find_forest


def rejoined(
    bodies: Sequence[Members], wander: Array, usual: float, costs: JointCosts, ratio: float
) -> list[Members]:
    """Return the bodies, neighbours that are as steady together as bodies are made one.

    A pelvis under soft clothes comes out as three pairs of markers, each far steadier than they are
    together; yet together they are as steady as bodies of this recording are. Bodies that do not
    plainly move together stay apart: two feet on the floor are steady with each other as well.

    Parameters
    ----------
    bodies
    wander : (n, n) m
    usual
        m, what a distance within a body wanders.
    costs
    ratio
        How many times more two bodies may wander together.
    """
    kept = list(bodies)
    while True:
        pieces = [
            (together, edge.a, edge.b)
            for edge in find_forest(costs, kept).edges
            if (together := widest(wander, np.concatenate([kept[edge.a], kept[edge.b]])))
            <= ratio * usual
            and costs.plain(kept[edge.a], kept[edge.b])
        ]
        if not pieces:
            return kept
        _, a, b = min(pieces)
        kept[min(a, b)] = np.sort(np.concatenate([kept[a], kept[b]]))
        del kept[max(a, b)]
