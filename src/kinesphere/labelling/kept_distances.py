"""The distances that a followed person keeps: measured as frames come, and asked about points.

What was steady in a few seconds need not be: other people's motion counts beside the person's own,
until there is enough of that.
"""

import numpy as np
from numpy.typing import NDArray

from kinesphere.data import Array
from kinesphere.kernels.jit import kernel
from kinesphere.labelling.own_distances import OwnDistances, from_moments, moments

WORST = 10.0
"""Most that a mean square deviation costs, and what a point costs that nothing can be said of."""
LEARNS = 4.0
"""Mean square deviation up to which a marker's distances are measured on."""
RENEWED_S = 1.0
"""s between two measurements of all distances."""
STEADY = 0.03
"""m, most that a distance may vary for a marker to be held to it."""
USUAL_S = 20.0
"""s of the person's own motion that count as much as that of other people."""
NEIGHBOURS = 6
"""Steadiest neighbours that a marker is held to."""
FEWEST_NEIGHBOURS = 3
"""Of them that must be seen: two distances leave a circle."""


class KeptDistances:
    """Distances between labels, from a labelled stretch and every frame that is learnt after it.

    Parameters
    ----------
    labelled : (n_frames, n_labels, 3) m
    rate
        Hz, frames a second.
    usual : (n_labels, n_labels) m
        Deviation of every distance in other people's movement; NaN where not known.
    """

    def __init__(self, labelled: Array, rate: float, usual: Array | None = None) -> None:
        n = labelled.shape[1]
        self._rate = rate
        self._usual = np.full((n, n), np.nan) if usual is None else usual
        self._sums = np.zeros((3, n, n))
        self._frame = 0
        moments(np.ascontiguousarray(labelled), 0, n, *self._sums)
        self._measure()

    def fit(self, here: Array) -> Array:
        """Return how badly each label's own distances fit, (n_labels,), at positions ``here``.

        Mean square of deviations, 1 where all is as usual; NaN where too few are known.
        """
        fit = np.empty(len(here))
        _fit_where_they_are(here, self._own.mean, self._own.deviation, self._ranked, fit)
        return fit

    def costs(self, points: Array, labels: NDArray[np.intp], here: Array) -> Array:
        """Return how badly each point would fit if it bore each of the labels.

        Parameters
        ----------
        points : (n_points, 3) m
        labels : (n,)
        here : (n_labels, 3) m
            Where the others are; NaN where that is not known.

        Returns
        -------
        (n, n_points)
            Mean squares of deviations, at most ``WORST``.
        """
        cost = np.empty((len(labels), len(points)))
        _fit_if_they_were(
            points, labels, here, self._own.mean, self._own.deviation, self._ranked, cost
        )
        return cost

    def learn(self, here: Array, fit: Array) -> None:
        """Measure on, by one more frame, the distances of markers that keep theirs."""
        self._frame += 1
        sure = np.where((fit <= LEARNS)[:, None], here, np.nan)
        moments(sure[None], 0, len(here), *self._sums)
        if self._frame >= RENEWED_S * self._rate:
            self._frame = 0
            self._measure()

    def _measure(self) -> None:
        own = from_moments(*self._sums)
        count, prior = self._sums[2], np.where(np.isnan(self._usual), 0.0, USUAL_S * self._rate)
        pooled = count * own.deviation**2 + prior * np.nan_to_num(self._usual) ** 2
        deviation = np.sqrt(pooled / np.maximum(count + prior, 1.0))
        self._ranked = np.argsort(np.where(np.isnan(deviation), np.inf, deviation), axis=1)
        # distances that vary much fit anything
        self._own = OwnDistances(own.mean, np.where(deviation > STEADY, np.nan, deviation))


@kernel
def _fit_where_they_are(
    here: Array, mean: Array, deviation: Array, ranked: NDArray[np.int64], fit: Array
) -> None:
    for i in range(here.shape[0]):
        fit[i] = _deviates(here[i], i, here, mean, deviation, ranked)


@kernel
def _fit_if_they_were(
    points: Array,
    labels: NDArray[np.int64],
    here: Array,
    mean: Array,
    deviation: Array,
    ranked: NDArray[np.int64],
    cost: Array,
) -> None:
    for r in range(labels.shape[0]):
        for k in range(points.shape[0]):
            fit = _deviates(points[k], labels[r], here, mean, deviation, ranked)
            cost[r, k] = WORST if np.isnan(fit) else min(fit, WORST)


@kernel
def _deviates(
    point: Array,
    label: int,
    here: Array,
    mean: Array,
    deviation: Array,
    ranked: NDArray[np.int64],
) -> float:
    """Return the mean square deviation of a point's distances to a label's steadiest neighbours."""
    total, used = 0.0, 0
    for s in range(ranked.shape[1]):
        j = ranked[label, s]
        if j == label or not np.isfinite(deviation[label, j]) or not np.isfinite(here[j, 0]):
            continue
        square = 0.0
        for x in range(3):
            square += (point[x] - here[j, x]) ** 2
        z = (np.sqrt(square) - mean[label, j]) / deviation[label, j]
        total += z * z
        used += 1
        if used == NEIGHBOURS:
            break
    if used < FEWEST_NEIGHBOURS or not np.isfinite(point[0]):
        return np.nan
    return total / used
