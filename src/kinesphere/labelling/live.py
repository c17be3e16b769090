"""Labels frame by frame, once a body is known: points come in as a crowd, labels go out.

Each frame, markers are expected where they were heading and matched to the points as a whole
(Hungarian method). One that went out of sight comes back where its distances to its steadiest
neighbours say it is, not where it was last seen.
"""

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import linear_sum_assignment

from kinesphere.data import Array
from kinesphere.errors import BadRecording
from kinesphere.kernels.jit import kernel
from kinesphere.labelling.own_distances import OwnDistances, own_distances

REACH = 0.04
"""m, farthest a point may lie from where its marker is expected, beside what acceleration adds."""
ACCELERATION = 150.0
"""m/s², of feet that strike and fists: from step to step a marker strays by it times dt²."""
FAR = 10.0
"""m, stands for never in the assignment."""
SMOOTH = 1.0
"""How much of a new step enters the one that is expected next: at 120 Hz the last one is best."""
BACK = 2.5
"""Mean square deviation of distances up to which a point is a marker that comes back."""


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

    Raises
    ------
    BadRecording
        If fewer than four markers were ever seen in it.
    """

    def __init__(self, labelled: Array, labels: tuple[str, ...], rate: float) -> None:
        seen = np.asarray(np.isfinite(labelled).all(axis=2))
        if seen.any(axis=0).sum() < 4:
            raise BadRecording(
                f"{int(seen.any(axis=0).sum())} markers are seen in the stretch to lock on to; "
                "four at least are needed"
            )
        self.labels = labels
        self._reach = REACH + ACCELERATION / rate**2
        self.own: OwnDistances = own_distances(labelled)
        self._ranked = np.argsort(
            np.where(np.isnan(self.own.deviation), np.inf, self.own.deviation), axis=1
        )
        self._here = np.where(seen[-1][:, None], labelled[-1], np.nan)
        step = labelled[-1] - labelled[-2] if len(labelled) > 1 else np.zeros_like(labelled[-1])
        self._step = np.nan_to_num(step)

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
        _expected_distances(self._here, self._step, points, self._reach, FAR, apart)
        rows, columns = linear_sum_assignment(apart)
        near = apart[rows, columns] < FAR
        given[columns[near]] = rows[near]
        here = np.full_like(self._here, np.nan)
        here[rows[near]] = points[columns[near]]
        if (given < 0).any() and len(rows[near]) < len(self.labels):
            self._bring_back(points, given, here)
        moved = here - self._here
        known = np.isfinite(moved[:, 0])
        self._step[known] += SMOOTH * (moved[known] - self._step[known])
        self._step[~known] = 0.0
        self._here = here
        return given

    def _bring_back(self, points: Array, given: NDArray[np.int64], here: Array) -> None:
        """Label points that are where an unseen marker must be."""
        loose = np.flatnonzero((given < 0) & np.isfinite(points).all(axis=1))
        gone = np.flatnonzero(np.isnan(here[:, 0]))
        if not len(loose) or not len(gone):
            return
        cost = np.empty((len(gone), len(loose)))
        _distance_costs(
            points[loose], gone, here, self.own.mean, self.own.deviation, self._ranked, FAR, cost
        )
        rows, columns = linear_sum_assignment(cost)
        for r, c in zip(rows, columns, strict=True):
            if cost[r, c] <= BACK:
                given[loose[c]] = gone[r]
                here[gone[r]] = points[loose[c]]


@kernel
def _expected_distances(
    here: Array, step: Array, points: Array, reach: float, far: float, apart: Array
) -> None:
    """Fill how far each point is from where each marker is expected, ``far`` beyond reach."""
    for i in range(here.shape[0]):
        for k in range(points.shape[0]):
            square = 0.0
            for x in range(3):
                square += (points[k, x] - here[i, x] - step[i, x]) ** 2
            apart[i, k] = np.sqrt(square) if square <= reach * reach else far


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
                if used == 6:
                    break
            cost[r, k] = min(total / used, far) if used >= 3 else far
