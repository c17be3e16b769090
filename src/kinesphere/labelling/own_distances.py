"""The person's own distances, learnt from what is labelled, label what is not.

Once most markers have labels in some stretch of time, nobody else's statistics are needed: a piece
of trajectory is the marker whose distances to its steadiest neighbours it keeps.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from kinesphere.data import Array
from kinesphere.kernels.jit import kernel

NEIGHBOURS = 8
"""Steadiest labelled neighbours that a piece is measured against."""
FEWEST_NEIGHBOURS = 3
"""Of them that must be seen: two distances leave a circle."""
FRAMES = 48
"""Most frames of a piece looked at."""
FLOOR = 0.006
"""m, least deviation a distance is granted: noise and skin in movements not seen yet."""
WORST = 9.0
"""Square of deviations that one distance counts at most."""
FEWEST_FRAMES = 20
"""Frames together from which on a pair's own distance is known."""


@dataclass(frozen=True)
class OwnDistances:
    """Mean and deviation of the distances between a person's labelled markers."""

    mean: Array
    """(n_labels, n_labels) m; NaN where not known."""
    deviation: Array
    """(n_labels, n_labels) m, the floor included."""


def own_distances(points: Array, floor: float = FLOOR) -> OwnDistances:
    """Measure the distances of labelled points (n_frames, n_labels, 3) m, NaN where not seen."""
    n = points.shape[1]
    mean, square, count = np.zeros((n, n)), np.zeros((n, n)), np.zeros((n, n))
    moments(np.ascontiguousarray(points), 0, n, mean, square, count)
    return from_moments(mean, square, count, floor)


def measured_anew(
    own: OwnDistances, points: Array, label: int, floor: float = FLOOR
) -> OwnDistances:
    """Return the distances with those of one label measured on other points."""
    n = points.shape[1]
    mean, square, count = np.zeros((n, n)), np.zeros((n, n)), np.zeros((n, n))
    moments(np.ascontiguousarray(points), label, label + 1, mean, square, count)
    anew = from_moments(mean, square, count, floor)
    middle, deviation = own.mean.copy(), own.deviation.copy()
    for one, other in ((middle, anew.mean), (deviation, anew.deviation)):
        one[label] = one[:, label] = other[label]
    return OwnDistances(middle, deviation)


def from_moments(mean: Array, square: Array, count: Array, floor: float = FLOOR) -> OwnDistances:
    """Return distances from their sums, their squares' and how many they are, (n, n) each."""
    enough = count >= FEWEST_FRAMES
    middle = np.where(enough, mean / np.maximum(count, 1), np.nan)
    variance = np.maximum(square / np.maximum(count, 1) - np.nan_to_num(middle) ** 2, 0.0)
    return OwnDistances(middle, np.where(enough, np.sqrt(variance + floor**2), np.nan))


@kernel
def moments(
    points: Array, first: int, last: int, total: Array, square: Array, count: Array
) -> None:
    """Add the distances of labels first ≤ i < last, and their squares, to what is there."""
    n_frames, n = points.shape[0], points.shape[1]
    step = max(1, n_frames // 2000)
    for t in range(0, n_frames, step):
        for i in range(first, last):
            if not np.isfinite(points[t, i, 0]):
                continue
            for j in range(i if last - first == n else n):
                if j == i:
                    continue
                d = 0.0
                for x in range(3):
                    d += (points[t, i, x] - points[t, j, x]) ** 2
                if np.isfinite(d):
                    d = np.sqrt(d)
                    total[i, j] += d
                    total[j, i] += d
                    square[i, j] += d * d
                    square[j, i] += d * d
                    count[i, j] += 1
                    count[j, i] += 1


def costs_of(
    piece: Array, frames: NDArray[np.intp], labelled: Array, own: OwnDistances
) -> tuple[Array, Array]:
    """Return how badly a piece of trajectory fits each label, and how wide that label's fit is.

    Parameters
    ----------
    piece : (n, 3) m
        Positions at ``frames``.
    labelled : (n_frames, n_labels, 3) m
        What is labelled so far, without the piece itself.

    Returns
    -------
    cost : (n_labels,)
        Mean square of deviations, 1 where all is as usual; NaN where nothing can be said.
    width : (n_labels,)
        Twice the mean logarithm of the deviations, in floors: a label whose distances vary much
        fits anything, and must not win by that.
    """
    n_labels = labelled.shape[1]
    cost, width = np.full(n_labels, np.nan), np.zeros(n_labels)
    if len(frames) > FRAMES:
        chosen = np.linspace(0, len(frames) - 1, FRAMES).round().astype(np.intp)
        piece, frames = piece[chosen], frames[chosen]
    ranked = np.argsort(np.where(np.isnan(own.deviation), np.inf, own.deviation), axis=1)
    _fit_kernel(
        np.ascontiguousarray(piece),
        np.ascontiguousarray(labelled[frames]),
        own.mean,
        own.deviation,
        ranked,
        cost,
        width,
    )
    return cost, width


@kernel
def _fit_kernel(
    piece: Array,
    labelled: Array,
    mean: Array,
    deviation: Array,
    ranked: NDArray[np.int64],
    cost: Array,
    width: Array,
) -> None:
    n, m = labelled.shape[0], labelled.shape[1]
    for i in range(m):
        total, frames, wide = 0.0, 0, 0.0
        for t in range(n):
            part, broad, used = 0.0, 0.0, 0
            for r in range(m):
                j = ranked[i, r]
                if j == i or not np.isfinite(deviation[i, j]) or not np.isfinite(labelled[t, j, 0]):
                    continue
                d = 0.0
                for x in range(3):
                    d += (piece[t, x] - labelled[t, j, x]) ** 2
                z = (np.sqrt(d) - mean[i, j]) / deviation[i, j]
                part += min(z * z, WORST)
                broad += 2 * np.log(deviation[i, j] / FLOOR)
                used += 1
                if used == NEIGHBOURS:
                    break
            if used >= FEWEST_NEIGHBOURS:
                total += part / used
                wide += broad / used
                frames += 1
        if frames > 0:
            cost[i] = total / frames
            width[i] = wide / frames
