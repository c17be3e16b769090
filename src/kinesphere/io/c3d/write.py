"""A recording into a C3D file, without loss."""

from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from kinesphere.data import Array, Mask, Recording
from kinesphere.errors import BadRecording
from kinesphere.io.atomic import replacing
from kinesphere.io.c3d.analog import raw_samples, samples_from_analog
from kinesphere.io.c3d.frames import Frames, bytes_from_frames, fourth_from_residuals
from kinesphere.io.c3d.header import (
    BLOCK,
    LARGEST_WORD,
    Header,
    bytes_from_header,
    without_events,
)
from kinesphere.io.c3d.parameters import MOST, Section, floats, words
from kinesphere.io.c3d.points import Point, coordinates, points_of, residuals, restore, source_rows
from kinesphere.io.c3d.renew import renewed
from kinesphere.io.c3d.rotations import with_rotations
from kinesphere.io.c3d.section import bytes_from_section
from kinesphere.io.c3d.source import KEY, Source

_MILLIMETRE = 1e-3
_SCALE = 0.1
"""mm, the step of the residuals in files of our own: 255 of them reach 25.5 mm."""
_EXACT = 1e-3
"""Share of a step by which a number may miss a whole one and still be it: rounding leaves 1e-9."""


def write_c3d(recording: Recording, path: str | Path) -> None:
    """Write a C3D file as an INTEL processor does, whole or not at all.

    What came from a C3D file goes back as it was, in the file's axes, unit and order: parameters
    with their descriptions and locks, residuals, camera masks, analog channels, events, vendor
    outputs, the first frame's number. Integers stay integers where every coordinate is still a
    whole multiple of POINT:SCALE; else all numbers are 32-bit floats.

    Raises
    ------
    BadRecording
        If the format has no room for it: no frames, too many points, labels too long, analog
        samples that do not share out among the frames.
    UnwritableFile
        If the place cannot be written to.
    """
    content = _bytes_from_recording(recording)
    with replacing(path) as temporary:
        temporary.write_bytes(content)


def _bytes_from_recording(recording: Recording) -> bytes:
    source = recording.details.get(KEY)
    if not isinstance(source, Source):
        source = None
    _check(recording)
    points = points_of(recording, source)
    section = renewed(recording, points, source).with_unique_names()
    numbers = _numbers(recording, points, source, section)
    if section.number("POINT", "SCALE") != np.float32(numbers.scale):
        section = section.with_parameters("POINT", floats("SCALE", numbers.scale))
    section = section.with_parameters("POINT", words("DATA_START", 0))  # takes its room
    data_block = 2 + len(bytes_from_section(section)) // BLOCK
    section = section.with_parameters("POINT", words("DATA_START", data_block))
    data = bytes_from_frames(numbers.frames)
    rotations = b""
    if source is not None and recording.n_frames == source.layout.n_frames:
        rotations = source.rotations
    if source is None or source.is_padded:
        data += bytes(-len(data) % BLOCK)
    section = with_rotations(section, rotations, data_block + len(data) // BLOCK)
    header = Header(
        n_points=len(points),
        n_analog=numbers.frames.analog.size // recording.n_frames,
        first_frame=recording.first_frame,
        last_frame=recording.first_frame + recording.n_frames - 1,
        scale=numbers.scale,
        data_block=data_block,
        samples_per_frame=numbers.samples_per_frame,
        rate=recording.rate,
        raw=_raw_header(recording, source),
    )
    return bytes_from_header(header) + bytes_from_section(section) + data + rotations


@dataclass(frozen=True, eq=False)
class _Numbers:
    """The data section to be written."""

    frames: Frames
    scale: float
    """Negative for floats, as in the file."""
    samples_per_frame: int


def _numbers(
    recording: Recording, points: tuple[Point, ...], source: Source | None, section: Section
) -> _Numbers:
    metres = source.metres if source else _MILLIMETRE
    scale = source.layout.scale if source else _SCALE
    values = coordinates(recording, points, metres)
    gone: Mask = np.asarray(np.isnan(values).any(axis=2))
    fourth: NDArray[Any] = fourth_from_residuals(residuals(recording, points, metres), ~gone, scale)
    values = np.where(gone[..., None], 0.0, values)
    rows = source_rows(recording, source) if source else None
    if source is not None and rows is not None:
        values, fourth = restore(values, fourth, gone, points, source, rows)
    analog, per_frame = _analog(recording, source, section)
    if source is not None and not source.layout.is_float:
        steps = values / scale
        words = np.iinfo(np.int16).max
        if _fits(steps, words) and _fits(fourth, words) and _fits(analog, LARGEST_WORD):
            frames = Frames(_integers(steps), _integers(fourth), _integers(analog))
            return _Numbers(frames, scale, per_frame)
    with np.errstate(over="ignore", invalid="ignore"):
        frames = Frames(*(np.asarray(a, dtype=np.float32) for a in (values, fourth, analog)))
    if not np.isfinite(frames.points[~gone]).all():
        raise BadRecording(f"a coordinate is {np.abs(values[~gone]).max():g}, too large for C3D")
    return _Numbers(frames, -scale, per_frame)


def _analog(recording: Recording, source: Source | None, section: Section) -> tuple[Array, int]:
    """Return the samples to store, (n_samples, n_channels), and how many there are a frame."""
    analog, n_frames = recording.analog, recording.n_frames
    if source is not None and analog is source.analog and n_frames == source.layout.n_frames:
        samples = raw_samples(source.layout, source.frames.analog)
        return samples, source.layout.header.samples_per_frame
    if analog is None:
        return np.empty((0, 0)), source.layout.header.samples_per_frame if source else 0
    per_frame = len(analog.values) // n_frames
    if per_frame * n_frames != len(analog.values) or per_frame == 0:
        raise BadRecording(
            f"{len(analog.values)} analog samples do not share out among {n_frames} frames; "
            "a C3D file holds the same number of them in every frame"
        )
    return samples_from_analog(analog, section), per_frame


def _fits(values: NDArray[Any], largest: int) -> bool:
    """Tell whether every number is whole, but for rounding, and has room in 16 bits."""
    nearest = np.round(values)
    return bool(
        (np.abs(values - nearest) <= _EXACT).all()  # not so where it is NaN
        and (nearest >= np.iinfo(np.int16).min).all()
        and (nearest <= largest).all()
    )


def _integers(values: NDArray[Any]) -> NDArray[np.int16]:
    return np.round(values).astype(np.int64).astype(np.uint16).view(np.int16)


def _raw_header(recording: Recording, source: Source | None) -> bytes:
    if source is None:
        return bytes(BLOCK)
    raw = source.layout.header.raw
    return raw if recording.events == source.events else without_events(raw)


def _check(recording: Recording) -> None:
    if recording.n_frames == 0:
        raise BadRecording("a recording without frames cannot be a C3D file")
    n_points = recording.n_markers + len(recording.outputs)
    if n_points == 0 and recording.analog is None:
        raise BadRecording("a recording without points or channels cannot be a C3D file")
    if n_points > LARGEST_WORD:
        raise BadRecording(f"{n_points} points; a C3D file holds at most {LARGEST_WORD}")
    if recording.first_frame < 0:
        raise BadRecording(f"the first frame is {recording.first_frame}; C3D counts from 0")
    labels = [*recording.labels, *(output.label for output in recording.outputs)]
    for label in labels:
        if len(label.encode()) > MOST:
            raise BadRecording(f"label {label[:40]!r}… is longer than the {MOST} bytes of C3D")
