"""Labels by the person's own distances, backwards and forwards in time from what has some."""

import numpy as np
from numpy.typing import NDArray

from kinesphere.data import Array
from kinesphere.labelling.cutting import cut_foreign
from kinesphere.labelling.labelled import Labelled, frames_of, give, length_of, overlapping, take
from kinesphere.labelling.own_distances import (
    FEWEST_NEIGHBOURS,
    OwnDistances,
    costs_of,
    own_distances,
)

FITS = (2.0, 5.5)
"""Mean square deviation up to which a piece keeps a label's distances: 1 is usual, strangers have
6 to 9. The second is for the end, when the distances are known from all movement."""
LONG_S = 1.0
"""s from which on a piece is measured by the second: what lasts shortly may be there by chance."""
CLEAR = (2.0, 1.5)
"""How much worse the next label must fit, in the same terms."""
SWEEPS = 40
"""Most rounds of labelling what has become decidable."""


def propagate(
    state: Labelled,
    markers: Array,
    rate: float,
    fixed: set[int],
    kin: NDArray[np.bool_],
    *,
    late: bool,
) -> None:
    """Label by the person's own distances whatever can be, cutting what stops fitting.

    Parameters
    ----------
    kin : (n_labels, n_labels)
        Labels of one segment: while one of them has no distances yet, its points fit the others.
    late
        Whether the distances are known from all movement by now.
    """
    own = own_distances(state.points)
    cut_foreign(state, markers, rate, own, fixed)
    for sweep in range(SWEEPS):
        if not _sweep(state, markers, rate, own, fixed, kin, late=late):
            break
        if sweep % 3 == 2:
            own = own_distances(state.points)
    own = own_distances(state.points)
    if cut_foreign(state, markers, rate, own, fixed):
        for _ in range(SWEEPS):
            if not _sweep(state, markers, rate, own, fixed, kin, late=late):
                break


def _sweep(
    state: Labelled,
    markers: Array,
    rate: float,
    own: OwnDistances,
    fixed: set[int],
    kin: NDArray[np.bool_],
    *,
    late: bool,
) -> bool:
    """Label all tracks that have become decidable; return whether there were any."""
    offers: list[tuple[float, float, int, int]] = []
    unknown = np.isfinite(own.mean).sum(axis=1) <= FEWEST_NEIGHBOURS
    settled = ~(kin & unknown).any(axis=1) & late
    for k, track in enumerate(state.tracks):
        if state.labels[k] >= 0:
            continue
        frames, columns = frames_of(track)
        cost, width = costs_of(markers[frames, columns], frames, state.points, own)
        long = min(1.0, len(frames) / rate / LONG_S)
        taken = _blocked(state, k, frames, fixed)
        known = np.isfinite(cost)
        if not known.any():
            continue
        cost = np.where(known, cost, np.inf)
        score = np.where(known, cost + width, np.inf)
        limit = np.where(settled, FITS[0] + (FITS[1] - FITS[0]) * long, FITS[0])
        free = np.where(taken | (cost > limit), np.inf, score)
        label = int(free.argmin())
        if not np.isfinite(free[label]):
            continue
        # a taken label still competes: what fits it best is a copy of it, no other marker
        lead = np.where(taken & late, score + CLEAR[late], score)
        second = float(np.delete(lead, label).min(initial=np.inf))
        if second < free[label] + CLEAR[late]:
            continue
        offers.append((float(free[label]), second, k, label))
    given = False
    for cost_, second, k, label in sorted(offers):
        before = state.labels[k]
        for other in overlapping(state, k, label):
            if other not in fixed and length_of(state, other) < length_of(state, k):
                take(state, other)
        give(state, markers, k, label, 1 - float(np.exp(-(second - cost_) / 2)))
        given = given or state.labels[k] != before
    return given


def _blocked(
    state: Labelled, k: int, frames: NDArray[np.intp], fixed: set[int]
) -> NDArray[np.bool_]:
    """Return which labels track k cannot have: something longer has them at the same time."""
    blocked = np.array(np.isfinite(state.points[frames, :, 0]).any(axis=0))
    for label in np.flatnonzero(blocked):
        rivals = overlapping(state, k, int(label))
        longer = [o in fixed or length_of(state, o) >= length_of(state, k) for o in rivals]
        blocked[label] = not rivals or any(longer)
    return blocked
