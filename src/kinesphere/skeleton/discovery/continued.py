"""One marker under several numbers, one after the other: a trajectory that was lost and found."""

from itertools import pairwise
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from kinesphere.data import Array, Mask
from kinesphere.geometry.even_frames import even_frames
from kinesphere.skeleton.discovery.followed import follow

FRAMES = 60
"""Frames of each life that are looked at, spread over it."""
SHOWN = 0.8
"""Least share of them that must show a fellow, too."""
STEADY, STEADIEST = 3.0, 0.008
"""A fellow's distance wanders at most so many times what is usual for the steadiest one of a
marker; and so much, in m at a person's size, in any case: skin brings more about."""
ALIKE = 0.005
"""m, at a person's size: how far apart a distance may be before and after. No two markers at hand
are nearer to each other than 0.007 m."""
SPEED, SLACK = 3.0, 0.02
"""m/s and m: how far a marker may get from where it was lost, beside its steadiest fellow."""
AT_ONCE = 0.1
"""s, gap over which one fellow is enough: two markers on one limb turn about each other freely."""


class Lives(NamedTuple):
    """What is known of each trajectory while it is seen."""

    first: NDArray[np.intp]
    last: NDArray[np.intp]
    """Frames."""
    usual: Array
    """(n, n) m, mean distance to each other trajectory while the first one lives."""
    wander: Array
    """(n, n) m, its standard deviation; NaN where it does not show for long enough."""


def find_continued(markers: Array, rate: float, order: NDArray[np.intp]) -> dict[int, int]:
    """Return which trajectories continue another one, of which they are pieces.

    What shares no frame is one marker if the second begins after the first has ended, keeps the
    distances that the first had from every marker both are steady with, two of them or one where no
    time is lost, begins about where the first was lost, and no other trajectory could be meant.
    Short gaps are closed first (`follow`), where it is enough that others show beside the gap.

    Parameters
    ----------
    markers : (n_frames, n, 3) m
        At a person's size, without copies; NaN where not seen.
    rate
        Hz.
    order : (n,)
        Their places in the file.

    Returns
    -------
    Column of a piece → column of the one of its pieces that is seen most often, of several the
    first in the file.
    """
    seen: Mask = np.asarray(np.isfinite(markers).all(axis=2))
    broken = seen.any(axis=0) & ~(seen[0] & seen[-1])
    if broken.sum() < 2:
        return {}
    often = seen.sum(axis=0)
    tracks, joined = follow(markers, rate)
    pieces: dict[int, int] = {}
    for chain in _chains(_follows(joined, rate), len(tracks)):
        group = [m for track in chain for m in tracks[track]]
        whole, *rest = sorted(group, key=lambda m: (-often[m], order[m]))
        pieces |= dict.fromkeys(rest, whole)
    return dict(sorted(pieces.items()))


def _follows(markers: Array, rate: float) -> tuple[list[tuple[int, int]], Lives]:
    """Return which trajectories follow which, whatever the gap."""
    seen: Mask = np.asarray(np.isfinite(markers).all(axis=2))
    broken = seen.any(axis=0) & ~(seen[0] & seen[-1])
    lives = _lives(markers, seen)
    steadiest = np.nanmin(np.where(np.isnan(lives.wander), np.inf, lives.wander), axis=1)
    known = steadiest[np.isfinite(steadiest)]
    if not len(known) or broken.sum() < 2:
        return [], lives
    limit = min(STEADY * float(np.median(known)), STEADIEST)
    steady = (lives.wander <= limit).astype(float)
    later = broken[:, None] & broken & (lives.first > lives.last[:, None])
    pairs = np.argwhere(later & (steady @ steady.T > 0)).tolist()
    return [(a, b) for a, b in pairs if _is_one(markers, rate, lives, a, b, limit)], lives


def _lives(markers: Array, seen: Mask) -> Lives:
    n = markers.shape[1]
    usual, wander = np.full((n, n), np.nan), np.full((n, n), np.nan)
    first, last = np.zeros(n, dtype=np.intp), np.zeros(n, dtype=np.intp)
    for m in range(n):
        alive = np.flatnonzero(seen[:, m])
        if not len(alive):
            continue
        first[m], last[m] = alive[0], alive[-1]
        few = markers[alive[even_frames(len(alive), FRAMES)]]
        away = np.linalg.norm(few - few[:, m : m + 1], axis=2)
        shown = np.isfinite(away).mean(axis=0) >= SHOWN
        shown[m] = False
        usual[m, shown] = np.nanmean(away[:, shown], axis=0)
        wander[m, shown] = np.nanstd(away[:, shown], axis=0)
    return Lives(first, last, usual, wander)


def _is_one(markers: Array, rate: float, lives: Lives, a: int, b: int, limit: float) -> bool:
    """Return whether the second trajectory is the first one, found again."""
    steady = np.fmax(lives.wander[a], lives.wander[b])
    both = np.isfinite(lives.wander[a]) & np.isfinite(lives.wander[b])
    fellows = np.flatnonzero(both & (steady <= limit))
    gap = (lives.first[b] - lives.last[a]) / rate
    if len(fellows) < (1 if gap <= AT_ONCE else 2):
        return False
    if np.abs(lives.usual[a, fellows] - lives.usual[b, fellows]).max() > ALIKE:
        return False
    fellow = fellows[steady[fellows].argmin()]
    beside = [
        markers[t, m] - markers[t, fellow] for t, m in ((lives.last[a], a), (lives.first[b], b))
    ]
    way = float(np.linalg.norm(beside[1] - beside[0]))
    return not way > SLACK + SPEED * gap  # not known where the fellow is hidden just then


def _chains(found: tuple[list[tuple[int, int]], Lives], n: int) -> list[list[int]]:
    """Return groups of trajectories that all follow on each other; alone where two live at once."""
    follows, lives = found
    groups = {m: {m} for m in range(n)}
    for a, b in follows:
        joined = groups[a] | groups[b]
        groups |= dict.fromkeys(joined, joined)
    chains = []
    for group in {id(group): group for group in groups.values()}.values():
        chain = sorted(group, key=lambda m: lives.first[m])
        if all(lives.last[a] < lives.first[b] for a, b in pairwise(chain)):
            chains.append(chain)
        else:
            chains += [[m] for m in chain]
    return chains
