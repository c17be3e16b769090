"""Trees of bodies: which meet, how sure each joint is, and what hangs from what."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

DOUBTFUL = 0.15
"""Confidence of an edge below which another one is about as likely."""
UNSURE = 0.3
"""Confidence of an edge below which the joint is not relied upon where limbs are measured."""
FAR_APART = 0.007
"""m, cost from which that is said of a joint without any rival: of such joints that cost less,
one in twenty-five is wrong, of those that cost more one in six."""

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

    @property
    def doubtful(self) -> bool:
        """Whether this joint is not to be relied upon."""
        return self.below(UNSURE)

    def below(self, limit: float) -> bool:
        """Return whether the joint is less sure, or has no rival and hardly fits."""
        alone = not np.isfinite(self.next_best)
        return self.cost > FAR_APART if alone else self.confidence < limit


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

    def amid(self, tree: Sequence[int]) -> list[int]:
        """Return the bodies of a tree, the nearest to all its markers first."""
        edges = [pair_of(edge) for edge in self.edges]
        return sorted(tree, key=_ways_to_all(edges, self.sizes))

    def edge(self, child: int) -> Edge:
        """Return the edge towards a body's parent."""
        return next(edge for edge in self.edges if edge.b == child)


def pair_of(edge: Edge) -> Pair:
    """Return the two bodies of an edge, the lower first."""
    return (min(edge.a, edge.b), max(edge.a, edge.b))


def forest_of(pairs: Sequence[Pair], costs: Mapping[Pair, float], sizes: tuple[int, ...]) -> Forest:
    """Return the trees that joints make of bodies, each from its root, with every joint's rival."""
    edges = []
    for pair in pairs:
        rivals = rivals_of(pairs, pair, costs, len(sizes))
        edges.append(Edge(*pair, costs[pair], costs[rivals[0]] if rivals else np.inf))
    return _rooted(edges, costs, sizes)


def rivals_of(
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
    return min(able, key=_ways_to_all(edges, sizes))


def _ways_to_all(
    edges: Sequence[Pair], sizes: Sequence[int]
) -> Callable[[int], tuple[int, int, int]]:
    """Return what tells how near a body is to all markers of its tree."""

    def way_to_all(body: int) -> tuple[int, int, int]:
        away = _reached(body, edges, len(sizes))
        return sum(sizes[b] * way for b, way in away.items()), -sizes[body], body

    return way_to_all


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
    pairs = [renamed(pair_of(edge)) for edge in forest.edges if {edge.a, edge.b} != {into, body}]
    made = forest_of(pairs, costs, sizes)
    return replace(made, trees=tuple(tree for tree in made.trees if body not in tree))
