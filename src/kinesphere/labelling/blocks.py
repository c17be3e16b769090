"""Exchanges of whole blocks of labels that distances can hardly tell from the truth.

Two legs, two arms from the elbow on, a head turned round: each looks almost right by distances
alone, and no exchange of two labels leads from one to the other.
"""

from collections.abc import Iterator
from itertools import combinations, islice, permutations
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from kinesphere.data import Array, TopologicalModel

LARGEST_SEGMENT = 6
"""Markers of a segment all of whose orders are looked at: 720. Of larger ones, those that exchange
up to three pairs."""
LARGEST_TURNED = 9
"""Markers of a segment beyond which it is not turned: it is no rigid body, or it is not alike."""
ALIKE = 0.4
"""Relative rms difference of distances up to which an order of a segment's markers is a turn of
it: a head is about twice as long as wide, the front of a trunk lower than its back."""
MOST_TURNS = 8
"""Turns kept of one segment, the most alike first."""


class Moves(NamedTuple):
    """Permutations of labels: label i gives its point to ``move[i]``."""

    every: NDArray[np.int64]
    """(n_moves, n_labels); the first mirrors the whole body, the identity where nothing does."""
    turns: NDArray[np.int64]
    """(n_turns, n_labels) those that turn a segment on the spot."""


def block_moves(model: TopologicalModel, labels: tuple[str, ...], mean: Array) -> Moves:
    """Return the exchanges of blocks of a layout.

    Mirrored limbs from every joint outward, every segment mirrored by itself, the whole body
    mirrored, and every segment turned on the spot.

    Parameters
    ----------
    labels
        In the order of the template.
    mean : (n_labels, n_labels)
        Mean distances, to tell which turns of a segment leave it alike.
    """
    at = {label: i for i, label in enumerate(labels)}
    twin = twins(model, labels)
    moves, turns = [], []
    owned = {s.name: [at[x] for x in s.markers if x in at] for s in model.segments}
    for joint in model.joints:
        outward = [x for limb in _beyond(model, joint.child) for x in owned[limb]]
        moves.append(_mirrored(outward, twin))
    for segment in model.segments:
        own = owned[segment.name]
        whole = own + [at[x] for x in segment.shared if x in at]
        moves.append(_mirrored(own, twin))
        turns += _turns(own, mean)
        if len(own) < len(whole) <= LARGEST_SEGMENT:
            turns += _turns(whole, mean)  # a foot turns with the ankle, which is the shank's
    known = {twin.tobytes(), np.arange(len(twin)).tobytes()}
    return Moves(
        np.array([twin, *_unlike(moves + turns, known)], dtype=np.int64),
        np.array(_unlike(turns, known), dtype=np.int64).reshape(-1, len(twin)),
    )


def _unlike(moves: list[NDArray[np.int64]], known: set[bytes]) -> list[NDArray[np.int64]]:
    """Return moves once each, without those known already."""
    unique = {move.tobytes(): move for move in moves}
    return [move for key, move in unique.items() if key not in known]


def twins(model: TopologicalModel, labels: tuple[str, ...]) -> NDArray[np.int64]:
    """Return the index of each label's twin on the other side, (n_labels,); else its own."""
    at = {label: i for i, label in enumerate(labels)}
    twin = np.arange(len(labels))
    for left, right in model.mirror:
        if left in at and right in at:
            twin[at[left]], twin[at[right]] = at[right], at[left]
    return twin


def _beyond(model: TopologicalModel, limb: str) -> list[str]:
    """Return a limb and all that hang from it."""
    below = [limb]
    for joint in model.joints_from_root:
        if joint.parent in below:
            below.append(joint.child)
    return below


def _mirrored(some: list[int], twin: NDArray[np.int64]) -> NDArray[np.int64]:
    """Return the exchange of these labels with their twins."""
    move = np.arange(len(twin))
    for label in some:
        move[label], move[twin[label]] = twin[label], label
    return move


def _turns(own: list[int], mean: Array) -> list[NDArray[np.int64]]:
    """Return the orders of one segment's markers that leave its distances about as they are."""
    n = len(own)
    if not 2 <= n <= LARGEST_TURNED:
        return []
    inner = mean[np.ix_(own, own)]
    size = np.nanmean(inner[~np.eye(n, dtype=bool)])
    found = []
    for order in _orders(n):
        off = np.sqrt(np.nanmean((inner[np.ix_(order, order)] - inner) ** 2)) / size
        if off <= ALIKE:
            move = np.arange(len(mean))
            move[own] = [own[x] for x in order]
            found.append((off, order, move))
    found.sort(key=lambda turn: turn[:2])
    return [move for _, _, move in found[:MOST_TURNS]]


def _orders(n: int) -> Iterator[tuple[int, ...]]:
    """Yield orders of n markers, all but the first one."""
    if n <= LARGEST_SEGMENT:
        yield from islice(permutations(range(n)), 1, None)
        return
    pairs = list(combinations(range(n), 2))
    for count in range(1, 4):
        for some in combinations(pairs, count):
            if len({x for pair in some for x in pair}) == 2 * count:
                order = list(range(n))
                for a, b in some:
                    order[a], order[b] = b, a
                yield tuple(order)
