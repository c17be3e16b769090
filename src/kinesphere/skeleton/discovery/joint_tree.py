"""Which bodies meet at joints: a spanning forest of joint costs, and the root of each tree."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from itertools import combinations

import numpy as np
from numpy.typing import NDArray

from kinesphere.data import Array
from kinesphere.geometry.rigid import RigidFit
from kinesphere.skeleton.topology import joint_cost, limb_poses, spanning_tree

FRAMES = 300
"""Frames that joints are looked for on."""
APART = 0.06
"""m, least joint cost from which two bodies of a person's size may be no neighbours: on the
recordings at hand real joints cost 3 to 38 mm, bodies of different people a tenth of their way."""
FAR_BEYOND = 3.0
"""Times the median cost of the joints from which on one is none."""

DOUBTFUL = 0.15
"""Confidence of an edge below which another one is about as likely: wrong joints of the recordings
at hand have at most .12."""

MOST_SWAPPED = 6
"""Doubtful edges that are tried with their rivals, the most doubtful ones."""

Members = NDArray[np.intp]
Pair = tuple[int, int]


@dataclass(frozen=True)
class Edge:
    """Two bodies that meet, ``a`` nearer to the root."""

    a: int
    b: int
    cost: float
    """m, how badly they look like neighbours."""
    next_best: float = np.inf
    """m, cost of the best other joint that would hold the tree together without this one; infinite
    if there is none."""
    instead: Pair | None = None
    """The bodies of that joint."""

    @property
    def confidence(self) -> float:
        """0…1: 1 where any other tree costs far more, 0 where another one costs the same."""
        if not np.isfinite(self.next_best) or self.next_best <= 0:
            return 1.0
        return float(np.clip(1 - self.cost / self.next_best, 0.0, 1.0))


@dataclass(frozen=True)
class Forest:
    """Trees of bodies, the one with most markers first."""

    trees: tuple[tuple[int, ...], ...]
    """Bodies of each tree, root first, parents before children."""
    edges: tuple[Edge, ...]

    def parent(self, body: int) -> int | None:
        """Return the body's parent, None for a root."""
        return next((edge.a for edge in self.edges if edge.b == body), None)

    def children(self, body: int) -> list[int]:
        """Return the bodies that hang from this one."""
        return [edge.b for edge in self.edges if edge.a == body]

    def neighbours(self, body: int) -> list[int]:
        """Return the bodies that meet this one."""
        parent = self.parent(body)
        return self.children(body) if parent is None else [parent, *self.children(body)]

    def edge(self, child: int) -> Edge:
        """Return the edge towards a body's parent."""
        return next(edge for edge in self.edges if edge.b == child)


class JointCosts:
    """Joint costs between sets of markers, each computed once."""

    def __init__(self, points: Array, share: float) -> None:
        """Take (n_sample, n, 3) m and the subject's size as a share of a person's."""
        count = min(FRAMES, len(points))
        self.points = points[np.unique(np.linspace(0, len(points) - 1, count).astype(int))]
        self.share = share
        self._poses: dict[tuple[int, ...], RigidFit | None] = {}
        self._costs: dict[tuple[tuple[int, ...], tuple[int, ...]], float] = {}

    def between(self, a: Members, b: Members) -> float:
        """Return the cost in m of a joint between two bodies."""
        key = (tuple(map(int, a)), tuple(map(int, b)))
        if key not in self._costs:
            self._costs[key] = joint_cost(
                self.points[:, a], self.points[:, b], self.pose(a), self.pose(b)
            )
        return self._costs[key]

    def pose(self, members: Members) -> RigidFit | None:
        """Return the poses of a body in the frames of ``points``; None if it has none."""
        key = tuple(map(int, members))
        if key not in self._poses:
            self._poses[key] = limb_poses({"": self.points[:, members]}).get("")
        return self._poses[key]


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
    usual = float(np.median([between[pair] for pair in chosen])) if chosen else 0.0
    limit = max(FAR_BEYOND * usual, APART * costs.share)
    kept = [pair for pair in chosen if between[pair] <= limit]
    edges = []
    for pair in kept:
        instead = _replacement(kept, pair, between, n)
        next_best = np.inf if instead is None else between[instead]
        edges.append(Edge(*pair, between[pair], next_best, instead))
    return _rooted(edges, [len(members) for members in bodies])


def similar_forests(
    forest: Forest, sizes: Sequence[int], tree: int, most: int = 2
) -> Iterator[tuple[Forest, float]]:
    """Yield the forest, then those that differ in up to ``most`` doubtful edges of a tree.

    Parameters
    ----------
    sizes
        Markers of each body.
    tree
        Index of the tree.

    Yields
    ------
    Forest
    float
        How much less likely it is: the sum of log(cost of the other edge / cost of the edge).
    """
    yield forest, 0.0
    inside = set(forest.trees[tree])
    doubtful = [
        edge
        for edge in sorted(forest.edges, key=lambda edge: edge.confidence)
        if edge.a in inside and edge.instead is not None and edge.confidence < DOUBTFUL
    ][:MOST_SWAPPED]
    for count in range(1, most + 1):
        for swapped in combinations(doubtful, count):
            kept = [edge for edge in forest.edges if edge not in swapped]
            new = [
                Edge(*edge.instead, edge.next_best, edge.cost, (edge.a, edge.b))
                for edge in swapped
                if edge.instead is not None
            ]
            together = _rooted([*kept, *new], sizes)
            if len(together.trees) == len(forest.trees):  # else the swaps made a ring
                yield together, sum(float(np.log(e.next_best / e.cost)) for e in swapped)


def _replacement(
    kept: Sequence[Pair], without: Pair, costs: dict[Pair, float], n: int
) -> Pair | None:
    """Return the cheapest other joint between the two sides that one edge holds together."""
    rest = [pair for pair in kept if pair != without]
    side, other = _reached(without[0], rest, n), _reached(without[1], rest, n)
    across = [
        pair
        for pair, cost in costs.items()
        if pair != without
        and np.isfinite(cost)
        and ((pair[0] in side and pair[1] in other) or (pair[1] in side and pair[0] in other))
    ]
    return min(across, key=lambda pair: costs[pair], default=None)


def _reached(start: int, edges: Sequence[Pair], n: int) -> dict[int, int]:
    """Return the bodies that edges lead to from one, with the number of edges on the way."""
    beside: list[list[int]] = [[] for _ in range(n)]
    for a, b in edges:
        beside[a].append(b)
        beside[b].append(a)
    away, todo = {start: 0}, [start]
    for body in todo:
        for next_one in sorted(beside[body]):
            if next_one not in away:
                away[next_one] = away[body] + 1
                todo.append(next_one)
    return away


def _rooted(edges: Sequence[Edge], sizes: Sequence[int]) -> Forest:
    plain = [(edge.a, edge.b) for edge in edges]
    n, left = len(sizes), set(range(len(sizes)))
    trees: list[tuple[int, ...]] = []
    turned: list[Edge] = []
    while left:
        tree = sorted(_reached(min(left), plain, n))
        left -= set(tree)
        away = _reached(_root(tree, plain, sizes), plain, n)
        trees.append(tuple(away))
        turned += [
            edge if away[edge.a] < away[edge.b] else replace(edge, a=edge.b, b=edge.a)
            for edge in edges
            if edge.a in away
        ]
    trees.sort(key=lambda tree: (-sum(sizes[b] for b in tree), min(tree)))
    return Forest(tuple(trees), tuple(turned))


def _root(tree: Sequence[int], edges: Sequence[Pair], sizes: Sequence[int]) -> int:
    """Return the body nearest to all markers of its tree, of those that have a pose of their own.

    Closeness centrality, weighed by markers: a torso rather than the middle of a long chain.
    """
    able = [body for body in tree if sizes[body] > 2] or list(tree)

    def way_to_all(body: int) -> tuple[int, int, int]:
        away = _reached(body, edges, len(sizes))
        return sum(sizes[b] * way for b, way in away.items()), -sizes[body], body

    return min(able, key=way_to_all)


def rerooted(forest: Forest, root: int, sizes: Sequence[int]) -> Forest:
    """Return the forest with another body as the root of its tree."""
    plain = [(edge.a, edge.b) for edge in forest.edges]
    away = _reached(root, plain, len(sizes))
    trees = tuple(tuple(away) if root in tree else tree for tree in forest.trees)
    edges = tuple(
        edge
        if edge.a not in away or away[edge.a] < away[edge.b]
        else replace(edge, a=edge.b, b=edge.a)
        for edge in forest.edges
    )
    return Forest(trees, edges)
