"""How a foot must be shifted so that what stands on the ground stays where it stands."""

import itertools
from typing import Any

import numpy as np
from numpy.typing import NDArray

from kinesphere.data import Array, Mask
from kinesphere.editing.foot_contacts import BALL, HEEL, runs


def foot_shifts(
    points: Array, contacts: Mask, levels: Array, rate: float, blend: float
) -> tuple[Array, list[tuple[int, int, int, int]]]:
    """Return by how much to shift a foot in every frame, and which points stand when.

    A stance is a run of frames in which heel or ball stands. Within it the point that stands
    (the ball, where both do) is held where it is; where heel hands over to ball, the ball is held
    where it then is, so that nothing leaps. As a whole a stance is put where it costs least:
    the mean shift along the floor is zero, and the points stand at their levels on the mean. Before
    and after, the shift comes and goes by cubics with the speed it has at the stance's ends.

    Parameters
    ----------
    points : (n_frames, 2, 3) m
        Heel and ball as they would be.
    contacts : (n_frames, 2)
    levels : (n_frames, 2) m
        How high heel and ball are to stand where they do.
    blend
        s.

    Returns
    -------
    shifts : (n_frames, 3) m
    pins
        (point, first, last + 1, number of the stance) of each run of frames.
    """
    n = len(points)
    shifts = np.zeros((n, 3))
    pins: list[tuple[int, int, int, int]] = []
    stances = runs(np.asarray(contacts.any(axis=1)))
    for number, (first, end) in enumerate(stances):
        last = np.zeros(3)
        off: list[Array] = []
        for point, a, b in _standing(contacts, first, end):
            held = points[a, point] + last
            shifts[a:b] = held - points[a:b, point]
            # where the next point takes over, the foot stays as the frame before had it
            last = shifts[b - 1] if b == end else held - points[min(b, n - 1), point]
            off.append(levels[a:b, point] - held[1])
            pins.append((point, a, b, number))
        shifts[first:end] -= shifts[first:end].mean(axis=0) * [1.0, 0.0, 1.0]
        shifts[first:end, 1] += float(np.concatenate(off).mean())
    _blend(shifts, stances, max(2, round(blend * rate)))
    return shifts, pins


def _standing(contacts: Mask, first: int, end: int) -> list[tuple[int, int, int]]:
    """Return (point, first, last + 1) of the runs of a stance."""
    which = np.where(contacts[first:end, BALL], BALL, HEEL)
    cuts = [0, *(np.flatnonzero(np.diff(which)) + 1), end - first]
    return [(int(which[a]), first + int(a), first + int(b)) for a, b in itertools.pairwise(cuts)]


def _blend(shifts: Array, stances: list[tuple[int, int]], most: int) -> None:
    """Fill the frames between stances."""
    n = len(shifts)
    ends = [(0, 0), *stances, (n, n)]
    for (_, a), (b, _) in itertools.pairwise(ends):
        if b - a < 1:
            continue
        before = _rim(shifts, a - 1, -1, ends) if a > 0 else None
        after = _rim(shifts, b, 1, ends) if b < n else None
        t = np.arange(a, b)
        if before is not None and after is not None and b - a + 1 <= 2 * most:
            shifts[a:b] = _cubic(t, a - 1, b, *before, *after)
            continue
        still = (np.zeros(3), np.zeros(3))
        if before is not None:
            stop = min(a - 1 + most, n)
            t = np.arange(a, min(stop, b))
            shifts[t] = _cubic(t, a - 1, stop, *before, *still)
        if after is not None:
            start = max(b - most, -1)
            t = np.arange(max(start + 1, a), b)
            shifts[t] = _cubic(t, start, b, *still, *after)


def _rim(shifts: Array, at: int, way: int, stances: list[tuple[int, int]]) -> tuple[Array, Array]:
    """Return the shift at the rim of a stance and its change a frame there."""
    first, end = next((a, b) for a, b in stances if a <= at < b)
    inner = at + way
    if not first <= inner < end:
        return shifts[at], np.zeros(3)
    return shifts[at], way * (shifts[inner] - shifts[at])


def _cubic(
    t: NDArray[np.integer[Any]], a: int, b: int, pa: Array, va: Array, pb: Array, vb: Array
) -> Array:
    """Return the cubic through two points with given changes a frame, (n, 3)."""
    span = b - a
    s = ((t - a) / span)[:, None]
    return np.asarray(
        (2 * s**3 - 3 * s**2 + 1) * pa
        + (s**3 - 2 * s**2 + s) * span * va
        + (3 * s**2 - 2 * s**3) * pb
        + (s**3 - s**2) * span * vb
    )
