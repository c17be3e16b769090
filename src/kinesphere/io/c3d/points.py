"""Which point of the file each marker and output becomes, and the numbers stored for it."""

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from kinesphere.data import Array, Mask, Recording
from kinesphere.io.c3d.frames import as_doubles, unseen
from kinesphere.io.c3d.parameters import MOST
from kinesphere.io.c3d.source import Source


@dataclass(frozen=True)
class Point:
    """One point of the file to be written."""

    label: str
    marker: int | None
    """Column of the marker, or None for an output."""
    output: int | None
    """Number of the output, or None for a marker."""
    origin: int | None
    """Which point of the source it was, if any."""


def points_of(recording: Recording, source: Source | None) -> tuple[Point, ...]:
    """Return the points in the order of the source, those it does not know at the end.

    A point is known by its name; a marker that was given another name, by its place among the
    markers as long as none has come or gone. Where there are more points than one POINT:LABELS
    names, what is new comes right after the source's markers and the source's outputs come last:
    many readers know no LABELS2, and to them the last points have no names.
    """
    origins: dict[str, int] = {}
    if source is not None:
        origins = {label: i for i, label in enumerate(source.labels)}
    markers = [origins.get(label) for label in recording.labels]
    if source is not None and source.is_marker.count(True) == recording.n_markers:
        places = [i for i, is_marker in enumerate(source.is_marker) if is_marker]
        taken = {i for i in markers if i is not None}
        markers = [
            place if origin is None and place not in taken else origin
            for origin, place in zip(markers, places, strict=True)
        ]
    points = [Point(label, i, None, markers[i]) for i, label in enumerate(recording.labels)] + [
        Point(o.label, None, i, origins.get(o.label)) for i, o in enumerate(recording.outputs)
    ]
    last = len(origins)
    points.sort(key=lambda p: last if p.origin is None else p.origin)
    if len(points) > MOST and any(p.origin is None for p in points):
        points.sort(key=lambda p: p.output is not None and p.origin is not None)
        points.sort(key=lambda p: p.output is not None)
    return tuple(points)


def coordinates(recording: Recording, points: tuple[Point, ...], metres: float) -> Array:
    """Return what to store, (n_frames, n_points, 3): markers in the file's axes and unit."""
    values = np.full((recording.n_frames, len(points), 3), np.nan)
    in_file = recording.markers / metres
    if not np.array_equal(recording.world_from_file, np.eye(3)):
        in_file = in_file @ recording.world_from_file  # p_file = world_from_fileᵀ p_world
    for i, point in enumerate(points):
        if point.marker is not None:
            values[:, i] = in_file[:, point.marker]
        elif point.output is not None:
            values[:, i] = recording.outputs[point.output].values
    return values


def residuals(recording: Recording, points: tuple[Point, ...], metres: float) -> Array:
    """Return residuals in the file's unit, (n_frames, n_points); NaN where unknown or unseen."""
    values = np.full((recording.n_frames, len(points)), np.nan)
    for i, point in enumerate(points):
        if point.marker is not None and recording.residuals is not None:
            values[:, i] = recording.residuals[:, point.marker] / metres
        elif point.output is not None:
            of_output = recording.outputs[point.output].residuals
            if of_output is not None:
                values[:, i] = of_output
    return values


def source_rows(recording: Recording, source: Source) -> slice | None:
    """Return which frames of the source the recording consists of; None if it is not so simple."""
    first = recording.first_frame - source.first_frame
    last = first + recording.n_frames
    if recording.rate != source.layout.rate or first < 0 or last > source.layout.n_frames:
        return None
    return slice(first, last)


def restore(
    values: Array,
    fourth: NDArray[Any],
    gone: Mask,
    points: tuple[Point, ...],
    source: Source,
    rows: slice,
) -> tuple[Array, NDArray[Any]]:
    """Put back what the file held that a recording has no room for.

    That is the coordinates of points not seen, and the cameras' masks: a fourth word of the file
    stays wherever it says the same as the new one.

    Parameters
    ----------
    values : (n_frames, n_points, 3)
        Coordinates to store.
    fourth : (n_frames, n_points)
        Words to store, from residuals alone.
    gone : (n_frames, n_points)
        Where the recording has no position.
    points, source, rows
        Of the file to be written, and what they were in the source.
    """
    known = [i for i, p in enumerate(points) if p.origin is not None]
    origins = [p.origin for p in points if p.origin is not None]
    old_values = as_doubles(source.frames.points[rows][:, origins])
    old = as_doubles(source.frames.fourth[rows][:, origins])
    if not source.layout.is_float:
        old_values *= source.layout.scale
    new, gone = fourth[:, known].astype(np.float64), gone[:, known]
    was_gone = unseen(old) | ~np.isfinite(old_values).all(axis=2)
    sensible = np.isfinite(old) & (np.abs(old) <= np.iinfo(np.int16).max)
    byte = np.where(sensible, old, 0).astype(np.int16) & 0xFF
    same = np.where(gone | was_gone, gone & was_gone, byte == new)
    values, fourth = values.copy(), fourth.astype(np.float64)
    fourth[:, known] = np.where(same, old, new)
    values[:, known] = np.where((gone & was_gone)[..., None], old_values, values[:, known])
    return values, fourth
