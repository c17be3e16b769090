"""Markers lost and found again where most are: who goes on in whom is settled near each break."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from kinesphere.data import Array, Mask
from kinesphere.skeleton.discovery.breaks import least_of, near_of, stray_of, wander_of

GAPS = (0.1, 0.3, 0.6, 1.0, 1.6, 2.5, 4.0)
"""s, gaps that are closed, short ones first: what is joined serves as a fellow for the longer."""
SHORTEST = 1.5
"""s that either life must last: in less, what moves by itself seems steady. Lives of 0.8 to 1.4 s
were joined wrongly."""
STEADY, STEADIEST = 3.0, 0.008
"""As where few are broken."""
ALIKE = 0.005
"""m, at a person's size."""
OFF = 3.0
"""A distance that changes by more than so many times its own wander speaks against."""
LONG = 0.3
"""s, gap over which two are enough only if their distances change by no more than they wander."""
SPEED, SLACK = 3.0, 0.02
"""m/s and m."""
SMOOTH = 0.3
"""s, longest gap over which motion alone may tell."""
STRAYS = 0.015
"""m, and so far from where it would be, at most."""
BLOCK = 1 << 20
"""Distances that are looked at at a time: thousands of pieces need no more memory than hundreds."""
SURE = 3.0
"""What could be meant else must be so many times farther than a marker strays from its way."""


class Candidate(NamedTuple):
    """Two trajectories that may be one."""

    a: int
    b: int
    """Begins after the first has ended."""
    good: bool
    agree: int
    """Fellows that are as far away after the gap as before."""
    stray: float
    """m; NaN where not known."""


def follow(markers: Array, rate: float) -> tuple[list[list[int]], Array]:
    """Return chains of trajectories that are one marker each, in order of time, and them joined.

    Gaps are closed from the shortest to the longest, again and again until nothing changes at one
    length. At each break the distances from all that are steady with both, close before and after,
    must be the same.

    Parameters
    ----------
    markers : (n_frames, n, 3) m
        At a person's size.
    rate
        Hz.
    """
    tracks = [[m] for m in range(markers.shape[1])]
    points = markers
    for gap in GAPS:
        while True:
            links = _links(points, rate, gap)
            if not links:
                break
            tracks, points = _joined(tracks, points, links)
    return tracks, points


def _joined(
    tracks: list[list[int]], points: Array, links: dict[int, int]
) -> tuple[list[list[int]], Array]:
    gone = set(links.values())
    kept = [m for m in range(len(tracks)) if m not in gone]
    joined = np.ascontiguousarray(points[:, kept])
    for at, a in enumerate(kept):
        b, whole = links.get(a), list(tracks[a])
        while b is not None:
            whole += tracks[b]
            lost = np.isnan(joined[:, at])
            joined[:, at] = np.where(lost, points[:, b], joined[:, at])
            b = links.get(b)
        tracks[a] = whole
    return [tracks[m] for m in kept], joined


def _links(points: Array, rate: float, longest: float) -> dict[int, int]:
    """Return who goes on in whom, of those about whom there is no doubt."""
    seen: Mask = np.asarray(np.isfinite(points).all(axis=2))
    n_frames = len(seen)
    first, last = seen.argmax(axis=0), n_frames - 1 - seen[::-1].argmax(axis=0)
    wait = (first[None] - last[:, None]) / rate
    lasts = seen.sum(axis=0) >= SHORTEST * rate
    possible = lasts[:, None] & lasts & (wait > 0) & (wait <= longest + 1.5 / rate)
    a, b = np.nonzero(possible)
    away = np.linalg.norm(points[first[b], b] - points[last[a], a], axis=1)
    close = away <= SLACK + SPEED * wait[a, b]
    a, b = a[close], b[close]
    if not len(a):
        return {}
    wander = wander_of(points, rate)
    steadiest = np.nanmin(np.where(np.isnan(wander), np.inf, wander), axis=1)
    known = steadiest[np.isfinite(steadiest)]
    limit = min(STEADY * float(np.median(known)), STEADIEST) if len(known) else 0.0
    before = near_of(points, last, rate, -1, np.unique(a))
    after = near_of(points, first, rate, 1, np.unique(b))
    block = max(1, BLOCK // points.shape[1])
    parts = []
    for at in range(0, len(a), block):
        pair = a[at : at + block], b[at : at + block]
        steady = np.fmax(wander[pair[0]], wander[pair[1]])
        steady[np.isnan(wander[pair[0]]) | np.isnan(wander[pair[1]])] = np.nan
        change = np.abs(before[pair[0]] - after[pair[1]])
        fellow = (steady <= limit) & np.isfinite(change)
        agreeing = fellow & (change <= ALIKE)
        against = (fellow & (change > np.fmax(ALIKE, OFF * steady))).sum(axis=1)
        closely = (fellow & (change <= np.fmin(ALIKE, steady))).sum(axis=1)
        far = np.where(np.isfinite(change), 1 + before[pair[0]], np.inf)
        beside = np.where(agreeing, steady, far)
        ends = (pair[0], last[pair[0]]), (pair[1], first[pair[1]])
        stray = stray_of(points, *ends, beside, rate)
        room = np.fmin(least_of(before[pair[0]]), least_of(after[pair[1]]))
        parts.append((agreeing.sum(axis=1), against, closely, stray, room))
    agree, against, closely, stray, room = (np.concatenate(x) for x in zip(*parts, strict=True))
    smooth = (wait[a, b] <= SMOOTH) & (stray <= np.fmin(room / SURE, STRAYS))
    rigid = (agree >= 3) | (np.where(wait[a, b] > LONG, closely, agree) >= 2)
    good = (rigid | smooth) & (against == 0)
    maybe = good | (agree > against) | ((stray <= room) & (wait[a, b] <= SMOOTH))
    candidates = [
        Candidate(*each)
        for each in zip(
            a.tolist(), b.tolist(), good.tolist(), agree.tolist(), stray.tolist(), strict=True
        )
    ]
    return _undoubted([c for c, m in zip(candidates, maybe, strict=True) if m], first, last)


def _undoubted(
    candidates: list[Candidate], first: NDArray[np.intp], last: NDArray[np.intp]
) -> dict[int, int]:
    """Return the good ones that have no rival: none at the same time that is nearly as likely."""
    nexts: dict[int, list[Candidate]] = {}
    befores: dict[int, list[Candidate]] = {}
    for c in candidates:
        nexts.setdefault(c.a, []).append(c)
        befores.setdefault(c.b, []).append(c)
    return {
        c.a: c.b
        for c in candidates
        if c.good
        and all(o is c or first[o.b] > last[c.b] or _outdone(o, c) for o in nexts[c.a])
        and all(o is c or last[o.a] < first[c.a] or _outdone(o, c) for o in befores[c.b])
    }


def _outdone(rival: Candidate, by: Candidate) -> bool:
    """Return whether fellows, or the way itself, speak far more for the other one."""
    return not rival.good and (
        by.agree > 2 * rival.agree or (by.agree >= rival.agree and rival.stray > SURE * by.stray)
    )
