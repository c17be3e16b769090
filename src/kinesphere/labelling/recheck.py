"""Labelled tracks judged by what the others say: a wrong label is believed by itself alone.

A window that shifts the labels of an arm by one teaches wrong distances, and its tracks keep those
they taught. Without themselves they are seen to be what they are.
"""

import numpy as np

from kinesphere.data import Array
from kinesphere.labelling.labelled import Labelled, frames_of, give, take
from kinesphere.labelling.own_distances import OwnDistances, costs_of, measured_anew, own_distances

FITS = 2.0
"""Mean square deviation up to which a track is what it is taken for."""
CLEAR = 2.0
"""How much worse the label it bears must fit."""


def recheck(state: Labelled, markers: Array, fixed: set[int]) -> int:
    """Give tracks the label that fits better than theirs without them does; return how many."""
    own = own_distances(state.points)
    offers = []
    for k, of in enumerate(state.labels):
        if of >= 0 and k not in fixed:
            other, gain = _better(state, markers, k, own)
            if other >= 0:
                offers.append((-gain, k))
    changed = 0
    for _, k in sorted(offers):
        other, gain = _better(state, markers, k, own_distances(state.points))
        if other < 0:
            continue
        sure = 1 - float(np.exp(-min(gain, 20.0) / 2))
        take(state, k)
        give(state, markers, k, other, sure)
        changed += 1
    return changed


def _better(state: Labelled, markers: Array, k: int, own: OwnDistances) -> tuple[int, float]:
    """Return the label that track k fits clearly better than its own, and by how much; or −1."""
    label = state.labels[k]
    frames, columns = frames_of(state.tracks[k])
    positions = markers[frames, columns]
    state.points[frames, label] = np.nan
    without = measured_anew(own, state.points, label)
    cost, width = costs_of(positions, frames, state.points, without)
    taken = np.isfinite(state.points[frames, :, 0]).any(axis=0)
    state.points[frames, label] = positions
    score = np.where(np.isfinite(cost), cost + width, np.inf)
    free = np.where(taken | ~(cost <= FITS), np.inf, score)
    free[label] = np.inf
    other = int(free.argmin())
    if not np.isfinite(free[other]):
        return -1, 0.0
    gain = float(score[label] - free[other])
    return (other, gain) if gain > CLEAR else (-1, 0.0)
