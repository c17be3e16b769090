"""Labels frame by frame, once a body is known: points come in as a crowd, labels go out.

Each frame, markers are expected where they were heading and matched to the points as a whole
(Hungarian method). Every label is then held to its own distances: one that another point fits gives
way, so that two markers exchanged in passing are back in their places at once. One that went out of
sight comes back where its distances to its steadiest neighbours say it is, not where it was last
seen. Distances are measured on, as long as they fit.
"""

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import linear_sum_assignment

from kinesphere.data import Array
from kinesphere.errors import BadRecording
from kinesphere.kernels.jit import kernel
from kinesphere.labelling.crowd import FAR, expected_distances, reach_at
from kinesphere.labelling.own_distances import OwnDistances, from_moments, moments

SMOOTH = 1.0
"""How much of a new step enters the one that is expected next: at 120 Hz the last one is best."""
BACK = 2.5
"""Mean square deviation of distances up to which a point is a marker that comes back."""
CLEAR = 3.0
"""How much worse it must fit every other marker that is out of sight."""
DENIED = 9.0
"""Mean square deviation from which on a label may be exchanged for one that fits: a movement not
made before deviates as much, but fits no other label."""
LOST = 100.0
"""Mean square deviation from which on a point is no longer that marker: ten times the usual..."""
GONE_S = 0.25
"""...for so many seconds."""
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


class LiveLabels:
    """A body that is followed from frame to frame.

    Parameters
    ----------
    labelled : (n_frames, n_labels, 3) m
        A stretch of labelled motion that ends with the frame before the first live one: the
        person's distances are measured on it.
    labels
        Names of the columns.
    rate
        Hz, frames that will come a second.
    usual : (n_labels, n_labels) m
        Deviation of every distance in other people's movement; NaN where not known. What was
        steady in a few seconds need not be: it counts as ``USUAL_S`` of motion beside the person's
        own.

    Raises
    ------
    BadRecording
        If fewer than four markers were ever seen in it.
    """

    def __init__(
        self, labelled: Array, labels: tuple[str, ...], rate: float, usual: Array | None = None
    ) -> None:
        seen = np.asarray(np.isfinite(labelled).all(axis=2))
        if seen.any(axis=0).sum() < 4:
            raise BadRecording(
                f"{int(seen.any(axis=0).sum())} markers are seen in the stretch to lock on to; "
                "four at least are needed"
            )
        self.labels = labels
        n = len(labels)
        self._rate = rate
        self._reach = reach_at(rate)
        self._usual = np.full((n, n), np.nan) if usual is None else usual
        self._sums = np.zeros((3, n, n))
        moments(np.ascontiguousarray(labelled), 0, n, *self._sums)
        self._measure()
        self._here = np.where(seen[-1][:, None], labelled[-1], np.nan)
        step = labelled[-1] - labelled[-2] if len(labelled) > 1 else np.zeros_like(labelled[-1])
        self._step = np.nan_to_num(step)
        self._lost = np.zeros(n, dtype=np.int64)
        self._frame = 0

    def label(self, points: Array) -> NDArray[np.int64]:
        """Return the index of each point's label, (n_points,), −1 for none.

        Parameters
        ----------
        points : (n_points, 3) m
            Of one frame, in any order; NaN is no point.
        """
        n = len(points)
        given = np.full(n, -1, dtype=np.int64)
        points = np.ascontiguousarray(points, dtype=np.float64)
        apart = np.empty((len(self._here), n))
        expected_distances(self._here, self._step, points, self._reach, FAR, apart)
        rows, columns = linear_sum_assignment(apart)
        near = apart[rows, columns] < FAR
        given[columns[near]] = rows[near]
        here = np.full_like(self._here, np.nan)
        here[rows[near]] = points[columns[near]]
        fit = np.empty(len(here))
        self._fit(here, fit)
        if (fit > DENIED).any():
            self._hold(given, here, fit)
        if (given < 0).any() and (given >= 0).sum() < len(self.labels):
            self._bring_back(points, given, here)
        self._learn(here, fit)
        moved = here - self._here
        known = np.isfinite(moved[:, 0])
        self._step[known] += SMOOTH * (moved[known] - self._step[known])
        self._step[~known] = 0.0
        self._here = here
        return given

    def placed(self, points: Array) -> NDArray[np.int64]:
        """Return labels of points of the last frame, (n_points,), −1 for those that bear none."""
        same = (np.asarray(points)[:, None] == self._here).all(axis=2)
        return np.where(same.any(axis=1), same.argmax(axis=1), -1)

    def _fit(self, here: Array, fit: Array) -> None:
        _own_fit(here, self.own.mean, self.own.deviation, self._ranked, fit)

    def _hold(self, given: NDArray[np.int64], here: Array, fit: Array) -> None:
        """Exchange labels that fit each other's points, and take away what has long been lost."""
        doubted = np.flatnonzero(fit > DENIED)
        if len(doubted) > 1:
            held = np.full(len(here), -1, dtype=np.int64)
            held[given[given >= 0]] = np.flatnonzero(given >= 0)
            without = here.copy()
            without[doubted] = np.nan
            cost = np.empty((len(doubted), len(doubted)))
            self._costs(here[doubted], doubted, without, cost)
            rows, columns = linear_sum_assignment(cost)
            moved = rows[(rows != columns) & (cost[rows, columns] <= BACK)]
            # a label goes only where another one leaves: chains that end elsewhere stay
            while not np.isin(columns[moved], moved).all():
                moved = moved[np.isin(columns[moved], moved)]
            into = doubted[columns[moved]]
            places = here[into].copy()
            given[held[into]] = doubted[moved]
            here[doubted[moved]] = places
            self._fit(here, fit)
        self._lost = np.where(fit > LOST, self._lost + 1, 0)
        gone = self._lost > GONE_S * self._rate
        if gone.any():
            given[np.isin(given, np.flatnonzero(gone))] = -1
            here[gone] = np.nan

    def _costs(self, points: Array, labels: NDArray[np.intp], here: Array, cost: Array) -> None:
        _distance_costs(
            points, labels, here, self.own.mean, self.own.deviation, self._ranked, FAR, cost
        )

    def _bring_back(self, points: Array, given: NDArray[np.int64], here: Array) -> None:
        """Label points that are where an unseen marker must be."""
        loose = np.flatnonzero((given < 0) & np.isfinite(points).all(axis=1))
        gone = np.flatnonzero(np.isnan(here[:, 0]))
        if not len(loose) or not len(gone):
            return
        for k, label in self._returning(points[loose], gone, here):
            given[loose[k]] = label
            here[label] = points[loose[k]]

    def _returning(
        self, points: Array, gone: NDArray[np.intp], here: Array
    ) -> list[tuple[int, int]]:
        """Return which points are which of the markers out of sight, the clear cases only."""
        cost = np.empty((len(gone), len(points)))
        self._costs(points, gone, here, cost)
        rows, columns = linear_sum_assignment(cost)
        found = []
        for r, c in zip(rows, columns, strict=True):
            # of two that are out of sight, the nearer one would take the other's place
            others = np.delete(cost[:, c], r).min(initial=FAR)
            if cost[r, c] <= BACK and others >= min(cost[r, c] + CLEAR, FAR):
                found.append((int(c), int(gone[r])))
        return found

    def _learn(self, here: Array, fit: Array) -> None:
        """Measure distances on, of markers that keep theirs."""
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
        self.own: OwnDistances = replace(own, deviation=deviation)
        self._ranked = np.argsort(
            np.where(np.isnan(self.own.deviation), np.inf, self.own.deviation), axis=1
        )
        # distances that vary much fit anything
        loose = self.own.deviation > STEADY
        self.own = replace(self.own, deviation=np.where(loose, np.nan, self.own.deviation))


@kernel
def _own_fit(
    here: Array, mean: Array, deviation: Array, ranked: NDArray[np.int64], fit: Array
) -> None:
    """Fill the mean square deviation of each marker's distances, NaN where too few are known."""
    for i in range(here.shape[0]):
        total, used = 0.0, 0
        for s in range(ranked.shape[1]):
            j = ranked[i, s]
            if j == i or not np.isfinite(deviation[i, j]) or not np.isfinite(here[j, 0]):
                continue
            square = 0.0
            for x in range(3):
                square += (here[i, x] - here[j, x]) ** 2
            z = (np.sqrt(square) - mean[i, j]) / deviation[i, j]
            total += z * z
            used += 1
            if used == NEIGHBOURS:
                break
        fit[i] = total / used if used >= 3 and np.isfinite(here[i, 0]) else np.nan


@kernel
def _distance_costs(
    points: Array,
    gone: NDArray[np.int64],
    here: Array,
    mean: Array,
    deviation: Array,
    ranked: NDArray[np.int64],
    far: float,
    cost: Array,
) -> None:
    """Fill the mean square deviation of each point's distances if it were each gone marker."""
    for r in range(gone.shape[0]):
        i = gone[r]
        for k in range(points.shape[0]):
            total, used = 0.0, 0
            for s in range(ranked.shape[1]):
                j = ranked[i, s]
                if j == i or not np.isfinite(here[j, 0]) or not np.isfinite(deviation[i, j]):
                    continue
                square = 0.0
                for x in range(3):
                    square += (points[k, x] - here[j, x]) ** 2
                z = (np.sqrt(square) - mean[i, j]) / deviation[i, j]
                total += z * z
                used += 1
                if used == NEIGHBOURS:
                    break
            cost[r, k] = min(total / used, far) if used >= 3 else far
