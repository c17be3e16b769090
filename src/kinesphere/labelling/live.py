"""Labels frame by frame, once a body is known: points come in as a crowd, labels go out.

Each frame, markers are expected where they were heading and matched to the points as a whole
(Hungarian method). Every label is then held to its own distances: one that another point fits gives
way, so that two markers exchanged in passing are back in their places at once. One that went out of
sight comes back where its distances to its steadiest neighbours say it is, not where it was last
seen. Distances are measured on, as long as they fit.
"""

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import linear_sum_assignment

from kinesphere.data import Array
from kinesphere.errors import BadRecording
from kinesphere.labelling.crowd import FAR, expected_distances, reach_at
from kinesphere.labelling.kept_distances import WORST, KeptDistances

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
        self._rate = rate
        self._reach = reach_at(rate)
        self._kept = KeptDistances(labelled, rate, usual)
        self._here = np.where(seen[-1][:, None], labelled[-1], np.nan)
        step = labelled[-1] - labelled[-2] if len(labelled) > 1 else np.zeros_like(labelled[-1])
        self._step = np.nan_to_num(step)
        self._lost = np.zeros(len(labels), dtype=np.int64)

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
        fit = self._kept.fit(here)
        if (fit > DENIED).any():
            fit = self._hold(given, here, fit)
        if (given < 0).any() and (given >= 0).sum() < len(self.labels):
            self._bring_back(points, given, here)
        self._kept.learn(here, fit)
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

    def _hold(self, given: NDArray[np.int64], here: Array, fit: Array) -> Array:
        """Exchange labels that fit each other's points, take away what has long been lost.

        Returns how they fit then.
        """
        doubted = np.flatnonzero(fit > DENIED)
        if len(doubted) > 1:
            held = np.full(len(here), -1, dtype=np.int64)
            held[given[given >= 0]] = np.flatnonzero(given >= 0)
            without = here.copy()
            without[doubted] = np.nan
            cost = self._kept.costs(here[doubted], doubted, without)
            rows, columns = linear_sum_assignment(cost)
            moved = rows[(rows != columns) & (cost[rows, columns] <= BACK)]
            # a label goes only where another one leaves: chains that end elsewhere stay
            while not np.isin(columns[moved], moved).all():
                moved = moved[np.isin(columns[moved], moved)]
            into = doubted[columns[moved]]
            places = here[into].copy()
            given[held[into]] = doubted[moved]
            here[doubted[moved]] = places
            fit = self._kept.fit(here)
        self._lost = np.where(fit > LOST, self._lost + 1, 0)
        gone = self._lost > GONE_S * self._rate
        if gone.any():
            given[np.isin(given, np.flatnonzero(gone))] = -1
            here[gone] = np.nan
        return fit

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
        cost = self._kept.costs(points, gone, here)
        rows, columns = linear_sum_assignment(cost)
        found = []
        for r, c in zip(rows, columns, strict=True):
            # of two that are out of sight, the nearer one would take the other's place
            others = np.delete(cost[:, c], r).min(initial=WORST)
            if cost[r, c] <= BACK and others >= min(cost[r, c] + CLEAR, WORST):
                found.append((int(c), int(gone[r])))
        return found
