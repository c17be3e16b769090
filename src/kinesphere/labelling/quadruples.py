"""Fours of markers that no movement turns inside out: they tell a body from its mirror image."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from kinesphere.data import Array, MarkerStatistics

MOST = 2000
"""Most quadruples looked at: the tightest."""
AGREEING = 0.9
"""How much of their signs recordings must have in common."""


def stable_quadruples(
    statistics: Sequence[MarkerStatistics], labels: tuple[str, ...], mean: Array
) -> tuple[NDArray[np.int64], Array]:
    """Return the quadruples that every recording which has the four labels finds stable.

    Parameters
    ----------
    labels
        Those that count; quadruples are told by their numbers here.
    mean : (n_labels, n_labels)
        Mean distances: the tightest quadruples come first, and only so many are taken.

    Returns
    -------
    quadruples : (n_quads, 4)
    handedness : (n_quads,) −1…1
    """
    at = {label: i for i, label in enumerate(labels)}
    signs: dict[tuple[int, ...], list[float]] = {}
    able: list[set[int]] = []
    for one in statistics:
        number = np.array([at.get(label, -1) for label in one.labels], dtype=np.int64)
        seen = np.isfinite(one.mean).sum(axis=1) > 1
        able.append({int(number[i]) for i in np.flatnonzero(seen) if number[i] >= 0})
        if not len(one.quadruples):
            continue
        fours = number[one.quadruples]
        order = np.argsort(fours, axis=1, kind="stable")
        turned = one.handedness * _parity(order)
        for four, sign, raw in zip(np.sort(fours, axis=1), turned, fours, strict=True):
            if (raw >= 0).all():
                signs.setdefault(tuple(int(x) for x in four), []).append(float(sign))
    kept = []
    for four, found in signs.items():
        could = sum(set(four) <= some for some in able)
        if len(found) == could and abs(sum(found)) > AGREEING * len(found):
            around = sum(mean[a, b] for i, a in enumerate(four) for b in four[i + 1 :])
            kept.append((around, four, sum(found) / len(found)))
    kept = sorted(kept)[:MOST]
    fours = np.array([four for _, four, _ in kept], dtype=np.int64).reshape(-1, 4)
    return fours, np.array([sign for _, _, sign in kept], dtype=np.float64)


def _parity(order: NDArray[np.intp]) -> Array:
    """Return +1 or −1 for each row's permutation of four."""
    inversions = sum(
        (order[:, i] > order[:, j]).astype(int) for i in range(4) for j in range(i + 1, 4)
    )
    return np.where(np.asarray(inversions) % 2 == 0, 1.0, -1.0)
