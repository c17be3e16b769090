"""Which bodies meet at joints: a spanning forest of joint costs, and the root of each tree."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import combinations, product

import numpy as np
from numpy.typing import NDArray

from kinesphere.data import Array
from kinesphere.geometry.rigid import RigidFit
from kinesphere.skeleton.averages import median_seen
from kinesphere.skeleton.topology import JointView, joint_view, limb_poses, spanning_tree

FRAMES = 300
"""Frames that joints are looked for on."""
APART = 0.06
"""m, least joint cost from which two bodies of a person's size may be no neighbours: on the
recordings at hand joints cost up to 24 mm, bodies of different people a tenth of their way."""
FAR_BEYOND = 3.0
"""Times the median cost of the cheaper joints from which on one is none."""

PLAIN, SHARED = 0.25, 0.5
"""Share of the lesser of two bodies' movements in the world, each direction, by which their images
of a joint may be apart: plainly moving together (recordings at hand have up to 0.19), and more so
than each by itself."""
STEADY = 0.01
"""m, most that noise and skin alone take the images apart; beyond it only the first will do."""
ADJOINING = 0.3
"""m between the nearest markers of two bodies up to which steady ones may meet though neither
shows: a foot that stands still and its shank."""

DOUBTFUL = 0.15
"""Confidence of an edge below which another one is called about as likely: 5 of 15 wrong joints of
the recordings at hand have less, 11 less than twice that."""

SWAPPED = 0.3
"""Confidence of an edge below which its rival is tried where that could make a person of a tree."""
MOST_SWAPPED = 5
"""Edges that are tried so, the most doubtful ones."""
MOST_RIVALS = 3
"""Rivals of each."""

Members = NDArray[np.intp]
Pair = tuple[int, int]


@dataclass(frozen=True)
class Edge:
    """Two bodies that meet, ``a`` nearer to the root."""

    a: int
    b: int
    cost: float
    """m, how badly they look like neighbours."""
    next_best: float
    """m, cost of the best other joint that would hold the tree together without this one; infinite
    if there is none."""

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
    costs: Mapping[Pair, float]
    """Two bodies, the lower first → m, cost of a joint between them."""
    sizes: tuple[int, ...]
    """Markers of each body."""

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
        """Return the cost in m of a joint between two bodies; infinite where nothing shows one."""
        key = (tuple(map(int, a)), tuple(map(int, b)))
        if key not in self._costs:
            view = joint_view(self.points[:, a], self.points[:, b], self.pose(a), self.pose(b))
            self._costs[key] = view.cost if self._may_meet(a, b, view) else np.inf
        return self._costs[key]

    def plain(self, a: Members, b: Members) -> bool:
        """Return whether two bodies plainly move together, rather than each standing about."""
        view = joint_view(self.points[:, a], self.points[:, b], self.pose(a), self.pose(b))
        return view.unsteady < PLAIN * self._moved(a, b)

    def _moved(self, a: Members, b: Members) -> float:
        """Return how far the one moves that moves less, m."""
        return min(_moved(self.points[:, a]), _moved(self.points[:, b]))

    def _may_meet(self, a: Members, b: Members, view: JointView) -> bool:
        """Return whether two bodies move together, or are near enough to meet all the same.

        A point that stays where it is in both shows a joint only if it goes about with them: two
        people who stand still, a foot and a thing on the floor have many.
        """
        moved = self._moved(a, b)
        if view.unsteady < PLAIN * moved:
            return True
        if view.unsteady > STEADY * self.share:
            return False
        if view.unsteady < SHARED * moved:
            return True
        apart = np.linalg.norm(self.points[:, a, None] - self.points[:, None, b], axis=-1)
        return bool(np.nanmin(median_seen(apart), initial=np.inf) <= ADJOINING * self.share)

    def pose(self, members: Members) -> RigidFit | None:
        """Return the poses of a body in the frames of ``points``; None if it has none."""
        key = tuple(map(int, members))
        if key not in self._poses:
            self._poses[key] = limb_poses({"": self.points[:, members]}).get("")
        return self._poses[key]


def _moved(points: Array) -> float:
    """Return how far a body's markers move in the world, rms in each direction, m."""
    off = points - median_seen(points)
    return float(np.sqrt(np.mean(off[np.isfinite(off)] ** 2))) if np.isfinite(off).any() else 0.0


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
        if between[pair] <= max(FAR_BEYOND * usual, APART * costs.share):
            kept.append(pair)
    return _forest(kept, between, tuple(len(members) for members in bodies))


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
        _pair(edge)
        for edge in sorted(forest.edges, key=lambda edge: edge.confidence)
        if edge.a in inside and edge.confidence < SWAPPED
    ][:MOST_SWAPPED]
    pairs, n = [_pair(edge) for edge in forest.edges], len(forest.sizes)
    ways = {
        pair: [
            rival
            for rival in _rivals(pairs, pair, forest.costs, n)[:MOST_RIVALS]
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
                swapped = _forest([*kept, *taken], forest.costs, forest.sizes)
                if len(swapped.trees) == len(forest.trees):  # else the two made a ring
                    yield (
                        swapped,
                        sum(
                            float(np.log(forest.costs[new] / forest.costs[old]))
                            for old, new in zip(given_up, taken, strict=True)
                        ),
                    )


def _pair(edge: Edge) -> Pair:
    return (min(edge.a, edge.b), max(edge.a, edge.b))


def _forest(pairs: Sequence[Pair], costs: Mapping[Pair, float], sizes: tuple[int, ...]) -> Forest:
    edges = []
    for pair in pairs:
        rivals = _rivals(pairs, pair, costs, len(sizes))
        edges.append(Edge(*pair, costs[pair], costs[rivals[0]] if rivals else np.inf))
    return _rooted(edges, costs, sizes)


def _rivals(
    pairs: Sequence[Pair], without: Pair, costs: Mapping[Pair, float], n: int
) -> list[Pair]:
    """Return the other joints between the two sides that one holds together, cheapest first."""
    rest = [pair for pair in pairs if pair != without]
    side, other = _reached(without[0], rest, n), _reached(without[1], rest, n)
    across = [
        pair
        for pair, cost in costs.items()
        if pair != without
        and np.isfinite(cost)
        and ((pair[0] in side and pair[1] in other) or (pair[1] in side and pair[0] in other))
    ]
    return sorted(across, key=lambda pair: costs[pair])


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


def _rooted(edges: Sequence[Edge], costs: Mapping[Pair, float], sizes: tuple[int, ...]) -> Forest:
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
    return Forest(tuple(trees), tuple(turned), costs, sizes)


def _root(tree: Sequence[int], edges: Sequence[Pair], sizes: Sequence[int]) -> int:
    """Return the body nearest to all markers of its tree, of those that have a pose of their own.

    Closeness centrality, weighed by markers: a torso rather than the middle of a long chain.
    """
    able = [body for body in tree if sizes[body] > 2] or list(tree)

    def way_to_all(body: int) -> tuple[int, int, int]:
        away = _reached(body, edges, len(sizes))
        return sum(sizes[b] * way for b, way in away.items()), -sizes[body], body

    return min(able, key=way_to_all)


def rerooted(forest: Forest, root: int) -> Forest:
    """Return the forest with another body as the root of its tree."""
    plain = [(edge.a, edge.b) for edge in forest.edges]
    away = _reached(root, plain, len(forest.sizes))
    trees = tuple(tuple(away) if root in tree else tree for tree in forest.trees)
    edges = tuple(
        edge
        if edge.a not in away or away[edge.a] < away[edge.b]
        else replace(edge, a=edge.b, b=edge.a)
        for edge in forest.edges
    )
    return replace(forest, trees=trees, edges=edges)


def contracted(forest: Forest, into: int, body: int, sizes: tuple[int, ...]) -> Forest:
    """Return the forest with two bodies that meet made one; the second is in no tree any more.

    What the second would have met for less, the first now does: rivals are found anew.
    """

    def renamed(pair: Pair) -> Pair:
        a, b = (into if other == body else other for other in pair)
        return (min(a, b), max(a, b))

    costs: dict[Pair, float] = {}
    for pair, cost in forest.costs.items():
        a, b = renamed(pair)
        if a != b:
            costs[a, b] = min(cost, costs.get((a, b), np.inf))
    pairs = [renamed(_pair(edge)) for edge in forest.edges if {edge.a, edge.b} != {into, body}]
    made = _forest(pairs, costs, sizes)
    return replace(made, trees=tuple(tree for tree in made.trees if body not in tree))
