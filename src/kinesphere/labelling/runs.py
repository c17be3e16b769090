"""Trajectories as runs of frames, and which of them continue each other.

A run is a stretch of frames in which one column of a recording is seen without a break. Raw
captures cut one marker into many; where the next piece begins where the last one was heading, the
two are one track.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import linear_sum_assignment

from kinesphere.data import Array

GAP_S = 0.03
"""s, longest gap that a straight prediction bridges. Over longer ones a neighbour that comes into
view is easily taken for the marker that went; the body's distances join those better."""
GATE = 0.012
"""m, farthest a prediction may miss; grows by ``ACCELERATION`` with the gap."""
ACCELERATION = 20.0
"""m/s², of hands and feet in fast movements: a prediction over t misses by half of it times t²."""
VELOCITY_S = 0.05
"""s over which a velocity is measured."""
CLEAR = 2.0
"""How many times farther the next candidate must be."""


@dataclass(frozen=True)
class Run:
    """Frames start ≤ t < end of one column."""

    column: int
    start: int
    end: int


Track = tuple[Run, ...]
"""Runs of one marker, in the order of time."""


def runs_of(seen: NDArray[np.bool_]) -> list[Run]:
    """Return every stretch of True, (n_frames, n_columns), ordered by start, then column."""
    padded = np.zeros((len(seen) + 2, seen.shape[1]), dtype=np.int8)
    padded[1:-1] = seen
    edges = np.diff(padded, axis=0)
    found = []
    for column in range(seen.shape[1]):
        starts, ends = np.flatnonzero(edges[:, column] == 1), np.flatnonzero(edges[:, column] == -1)
        found += [Run(column, int(a), int(b)) for a, b in zip(starts, ends, strict=True)]
    return sorted(found, key=lambda run: (run.start, run.column))


def tracks_of(markers: Array, rate: float, *, keep_columns: bool) -> list[Track]:
    """Return the runs of all columns, joined where one continues another.

    Parameters
    ----------
    markers : (n_frames, n_columns, 3) m
    rate
        Hz.
    keep_columns
        Whether a column is one marker throughout, gaps and all; else identity ends with a run.
    """
    runs = runs_of(np.asarray(np.isfinite(markers).all(axis=2)))
    if keep_columns:
        by_column: dict[int, list[Run]] = {}
        for run in runs:
            by_column.setdefault(run.column, []).append(run)
        return [tuple(by_column[column]) for column in sorted(by_column)]
    follower = _followers(markers, rate, runs)
    followed = set(follower.values())
    tracks = []
    for i, run in enumerate(runs):
        if i in followed:
            continue
        chain, k = [run], i
        while k in follower:
            k = follower[k]
            chain.append(runs[k])
        tracks.append(tuple(chain))
    return tracks


def _followers(markers: Array, rate: float, runs: list[Run]) -> dict[int, int]:
    """Return run → the run that continues it, by straight prediction, clear cases only."""
    longest = max(1, round(GAP_S * rate))
    starts: dict[int, list[int]] = {}
    for k, run in enumerate(runs):
        starts.setdefault(run.start, []).append(k)
    ends: dict[int, list[int]] = {}
    for k, run in enumerate(runs):
        ends.setdefault(run.end, []).append(k)
    follower: dict[int, int] = {}
    taken: set[int] = set()
    for end in sorted(ends):
        later = [k for gap in range(longest + 1) for k in starts.get(end + gap, ())]
        later = [k for k in later if k not in taken]
        if not later:
            continue
        mine = ends[end]
        miss = np.array([[_miss(markers, rate, runs[a], runs[b]) for b in later] for a in mine])
        rows, columns = linear_sum_assignment(np.minimum(miss, 10.0))
        for r, c in zip(rows, columns, strict=True):
            if miss[r, c] > 1:
                continue
            rivals = np.r_[np.delete(miss[r], c), np.delete(miss[:, c], r)]
            if len(rivals) and rivals.min() < CLEAR * max(miss[r, c], 0.1):
                continue
            follower[mine[r]] = later[c]
            taken.add(later[c])
    return follower


def _miss(markers: Array, rate: float, a: Run, b: Run) -> float:
    """Return how far b's start is from where a was heading, and a's end from where b came from.

    In shares of what is allowed: 1 and more is no continuation.
    """
    dt = (b.start - a.end + 1) / rate
    there = markers[a.end - 1, a.column] + dt * _velocity(markers, rate, a, last=True)
    back = markers[b.start, b.column] - dt * _velocity(markers, rate, b, last=False)
    miss = np.linalg.norm(there - markers[b.start, b.column])
    other = np.linalg.norm(back - markers[a.end - 1, a.column])
    return float((miss + other) / 2 / (GATE + ACCELERATION * dt**2 / 2))


def _velocity(markers: Array, rate: float, run: Run, *, last: bool) -> Array:
    n = min(run.end - run.start, max(2, round(VELOCITY_S * rate)))
    if n < 2:
        return np.zeros(3)
    piece = markers[run.end - n : run.end] if last else markers[run.start : run.start + n]
    times = (np.arange(n) - (n - 1) / 2) / rate
    return np.asarray(times @ piece[:, run.column] / (times @ times))


def points_of(markers: Array, tracks: list[Track]) -> Array:
    """Return the tracks as columns of their own, (n_frames, n_tracks, 3)."""
    points = np.full((len(markers), len(tracks), 3), np.nan)
    for k, track in enumerate(tracks):
        for run in track:
            points[run.start : run.end, k] = markers[run.start : run.end, run.column]
    return points
