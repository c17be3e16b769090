"""Whether lengths are a person's, or a unit was taken for another one."""

from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from kinesphere.data import Array, Recording
from kinesphere.geometry.even_frames import even_frames
from kinesphere.geometry.length_units import times_too_large
from kinesphere.geometry.vectors import lengths
from kinesphere.quality.body import (
    ENOUGH_FRAMES,
    HEAD,
    HEELS,
    SHOULDERS,
    TOES,
    Body,
    find_bodies,
    thinned,
)
from kinesphere.quality.findings import Finding

BODY_HEIGHT = (0.3, 2.5)
"""m between feet and head (or shoulders), from a crouching child to a giant on tiptoe."""
SCENE = (0.01, 50.0)
"""m across all markers of a frame, from a finger to a hall."""
GIANT = (2.0, 0.4)
"""m, rms from the middle of all markers and from each to the nearest: beyond both it is nobody; of
people they are 0.40 to 0.69 and 0.06 to 0.20 m, and of several only the former is larger."""
WHOLE = 20
"""Markers, at least, of a body that no labels name: fewer may be those of a limb."""
STATURES = 3.0
"""rms distances of a person's markers from their middle in a stature."""
_FRAMES = 30  # that tell how far markers are apart
_OF_ONE = (2.0, 12.0)  # of these two distances, the one in the other: 2.4 to 9.5 of one person
_DIGITS = 4


def check_unit(recording: Recording) -> Iterator[Finding]:
    """Yield bodies and clouds of markers that are too large or too small, and how many times."""
    if not recording.seen.any():
        return
    heights = _heights(recording)
    low, high = BODY_HEIGHT
    for height in heights:
        if not low <= height <= high:
            yield _finding(
                f"feet and head are {height:.3g} m apart, a person's are {low} to {high} m",
                ("height_m", height),
                times_too_large(height) if height > 0 else 1.0,
            )
    if heights or recording.n_markers < 2:
        return
    across = _across(recording)
    low, high = SCENE
    from_middle, from_nearest = _distances(recording)
    times = _times_of_one(recording, from_middle, from_nearest)
    if not low <= across <= high:
        yield _finding(
            f"the markers of a frame are {across:.3g} m across, {low} to {high} m is likely",
            ("across_m", across),
            times,
        )
    elif from_middle >= GIANT[0] and from_nearest >= GIANT[1]:
        yield _finding(
            f"markers are {from_nearest:.3g} m from the nearest other and {from_middle:.3g} m from "
            "their middle, a person's are 0.06 to 0.2 and 0.4 to 0.7 m",
            ("across_m", across),
            times,
        )


def told_unit(found: tuple[Finding, ...]) -> float:
    """Return how many times too large lengths are by what was found, 1 where nothing tells."""
    told = [dict(f.numbers).get("times_too_large", 1.0) for f in found if f.rule == "unit"]
    return told[0] if told and all(times == told[0] for times in told) else 1.0


def sized(recording: Recording, times: float) -> Recording:
    """Return the recording with lengths that are ``times`` too large brought to their size."""
    return recording if times == 1 else replace(recording, markers=recording.markers / times)


def _finding(what: str, told: tuple[str, float], times: float) -> Finding:
    name, value = told
    numbers: tuple[tuple[str, float], ...] = ((name, round(value, 6)),)
    remedy = "check the length unit of the file"
    if times != 1:
        numbers = (*numbers, ("times_too_large", float(f"{times:.{_DIGITS}g}")))
        remedy += f"; lengths of a person would be {times_in_words(times)}"
    return Finding("unit", "warning", what, remedy, numbers=numbers)


def times_in_words(times: float) -> str:
    """Return "25.4 times too large", or "10 times too small" of 0.1."""
    if times >= 1:
        return f"{times:.{_DIGITS}g} times too large"
    return f"{1 / times:.{_DIGITS}g} times too small"


def _heights(recording: Recording) -> list[float]:
    few = thinned(recording, ENOUGH_FRAMES)
    return [h for body in find_bodies(few) if np.isfinite(h := _height(body))]


def _height(body: Body) -> float:
    """Return the median distance between feet and head, in m; NaN where either is missing."""
    head, shoulders, feet = body.middle(*HEAD), body.middle(*SHOULDERS), body.middle(*TOES, *HEELS)
    upper = shoulders if head is None else head
    if upper is None or feet is None:
        return float("nan")
    found = lengths(upper - feet)
    found = found[np.isfinite(found)]
    return float(np.median(found)) if len(found) else np.nan


def _across(recording: Recording) -> float:
    # marker by marker in memory: extremes of rows come in a tenth of the time
    points = np.moveaxis(recording.markers[recording.seen.any(axis=1)], 1, 0).copy()
    extent = np.fmax.reduce(points) - np.fmin.reduce(points)
    return float(np.linalg.norm(np.median(extent, axis=0)))


def _distances(recording: Recording) -> tuple[float, float]:
    """Return how far markers usually are from their middle, rms, and from the nearest other, m."""
    seen = np.flatnonzero(recording.seen.sum(axis=1) > 1)
    of_frames = []
    for frame in seen[even_frames(len(seen), _FRAMES)] if len(seen) else ():
        points: Array = recording.markers[frame, recording.seen[frame]]
        away = lengths(points[:, None] - points)
        np.fill_diagonal(away, np.inf)
        from_middle = lengths(points - points.mean(axis=0))
        of_frames.append((np.sqrt((from_middle**2).mean()), np.median(away.min(axis=1))))
    if not of_frames:
        return np.nan, np.nan
    middle, nearest = np.median(of_frames, axis=0)
    return float(middle), float(nearest)


def _times_of_one(recording: Recording, from_middle: float, from_nearest: float) -> float:
    """Return how many times too large lengths are if one whole person is seen; 1 if not so."""
    low, high = _OF_ONE
    one = from_nearest > 0 and low <= from_middle / from_nearest <= high
    if not one or recording.n_markers < WHOLE:
        return 1.0
    return times_too_large(STATURES * from_middle)
