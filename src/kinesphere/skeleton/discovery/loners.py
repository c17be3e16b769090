"""Bodies that are one marker find company, or fall out."""

from collections.abc import Sequence

import numpy as np

from kinesphere.data import Array
from kinesphere.skeleton.discovery.forest import Forest
from kinesphere.skeleton.discovery.joint_costs import JointCosts, Members
from kinesphere.skeleton.discovery.joint_tree import find_forest
from kinesphere.skeleton.discovery.rigidity import Rigidity
from kinesphere.skeleton.discovery.steadiness import steadiness, usual_wander


def resettle(
    rigidity: Rigidity,
    bodies: Sequence[Members],
    costs: JointCosts,
    ratio: float,
    chain_ratio: float,
) -> tuple[list[Members], list[int]]:
    """Find each body of one marker company, or let it fall out.

    A single marker between two joints (a shin's) takes the marker of the farther joint from the
    limb beyond, if it is steady with that and not with the rest there: markers over knee, elbow and
    ankle sit on the bone above. Any other joins the neighbour whose markers it is steady with all
    in all, or is loose.

    Returns
    -------
    bodies
    loose
        Markers that belong to none.
    """
    kept = _without_strays(rigidity, bodies, chain_ratio)
    loose: list[int] = []
    for _ in range(2 * len(rigidity.mean)):
        alone = [b for b, members in enumerate(kept) if len(members) == 1]
        if not alone:
            break
        usual = usual_wander(rigidity.wander, kept) or rigidity.noise
        forest = find_forest(costs, kept)
        moves = [
            move
            for b in alone
            if (move := _linked(b, kept, forest, rigidity.wander, usual, chain_ratio))
            or (move := _joined(b, kept, forest, rigidity.wander, usual, ratio))
        ]
        if moves:
            _, marker, source, target = min(moves)
            kept[source] = kept[source][kept[source] != marker]
            kept[target] = np.sort(np.append(kept[target], marker))
        else:  # the least steady one first: it may have been in the way of others
            steady = steadiness(rigidity.wander, kept)
            out = max(alone, key=lambda b: _least(steady[kept[b][0]]))
            loose.append(int(kept[out][0]))
            kept[out] = kept[out][:0]
        kept = [members for members in kept if len(members)]
    return kept, sorted(loose)


_Move = tuple[float, int, int, int]
"""(wander in m, marker, from body, to body)"""


def _without_strays(
    rigidity: Rigidity, bodies: Sequence[Members], chain_ratio: float
) -> list[Members]:
    """Make bodies of their own of markers that are far from steady with all of a steady body."""
    usual = usual_wander(rigidity.wander, bodies) or rigidity.noise
    kept: list[Members] = []
    for members in bodies:
        body = members
        while len(body) > 2:
            inner = rigidity.wander[np.ix_(body, body)] + np.diag(np.full(len(body), np.nan))
            reach = np.array([_least(row) for row in inner])
            worst = int(reach.argmax())
            rest = np.delete(np.delete(inner, worst, 0), worst, 1)
            rest = rest[np.isfinite(rest)]
            if reach[worst] <= chain_ratio * max(usual, float(rest.max(initial=0.0))):
                break
            kept.append(body[worst : worst + 1])
            body = np.delete(body, worst)
        kept.append(body)
    return sorted(kept, key=lambda body: int(body[0]))


def _linked(
    b: int,
    bodies: Sequence[Members],
    forest: Forest,
    wander: Array,
    usual: float,
    chain_ratio: float,
) -> _Move | None:
    """Return the marker that a loner between two joints takes from the limb beyond."""
    (m,) = (int(marker) for marker in bodies[b])
    if forest.parent(b) is None:
        return None
    takes = []
    for child in forest.children(b):
        there = wander[m, bodies[child]]
        known = there[np.isfinite(there)]
        if len(known) > 1 and known.max() > chain_ratio * max(usual, float(known.min())):
            takes.append((float(known.min()), int(bodies[child][np.nanargmin(there)]), child, b))
    return min(takes, default=None)


def _joined(
    b: int, bodies: Sequence[Members], forest: Forest, wander: Array, usual: float, ratio: float
) -> _Move | None:
    """Return the neighbour that a loner is steady with, as steady as its markers are."""
    (m,) = (int(marker) for marker in bodies[b])
    steady = steadiness(wander, bodies)
    joins = []
    for other in forest.neighbours(b):
        inner = steady[bodies[other], other]
        inner = inner[np.isfinite(inner)]
        own = float(np.sqrt(np.mean(inner**2))) if len(inner) else 0.0
        if steady[m, other] < ratio * max(usual, own):
            joins.append((float(steady[m, other]), m, b, other))
    return min(joins, default=None)


def _least(values: Array) -> float:
    known = values[np.isfinite(values)]
    return float(known.min()) if len(known) else np.inf
