"""A recording from a C3D file."""

import re
from collections import Counter
from collections.abc import Sequence
from pathlib import Path

import numpy as np

from kinesphere.data import Array, Output, OutputKind, Recording, Step, UpAxis
from kinesphere.data.history import Json
from kinesphere.errors import UnreadableFile
from kinesphere.io.c3d.analog import analog_from_samples
from kinesphere.io.c3d.events import events_from_file, start_time
from kinesphere.io.c3d.frames import (
    Frames,
    as_doubles,
    frames_from_bytes,
    residuals_from_fourth,
    unseen,
)
from kinesphere.io.c3d.layout import Layout, first_frame_of, layout_of
from kinesphere.io.c3d.parameters import Section
from kinesphere.io.c3d.rotations import rotations_from_bytes
from kinesphere.io.c3d.source import KEY, Source
from kinesphere.io.registry import read_bytes
from kinesphere.io.units import length_unit
from kinesphere.io.vendor import kind_of_type, output_kinds

_AXIS = re.compile(r"([+-]?)([XYZ])([+-]?)", re.IGNORECASE)
_BEGINNING = 2**26
"""Bytes; the parameters end before the data, which start in one of 65,535 blocks of 512."""
_BEHIND = 2**26
"""Bytes kept behind the last frame: rotations lie there, and padding that is no data."""
_STANDARD_GROUPS = ("ANGLES", "FORCES", "MOMENTS", "POWERS", "SCALARS")


def read_c3d(path: str | Path) -> Recording:
    """Read a C3D file of any of the six encodings.

    Markers are in metres and in the axes of the file. Points that a vendor's software computed
    (angles, forces, segment frames …) become ``outputs``, in the file's units. A point with a
    negative residual is not seen, whatever its coordinates; nor is one that is not finite.

    Raises
    ------
    UnreadableFile
        Naming what is missing, cut short or impossible.
    """
    path = Path(path)
    content = read_bytes(path, _BEGINNING)
    try:
        size = path.stat().st_size
        layout = layout_of(content, size)
        if size > len(content):
            content = read_bytes(path, layout.end + _BEHIND)
            layout = layout_of(content)
    except UnreadableFile as error:
        raise UnreadableFile(f"{path}: {error}") from None
    return _recording(path, content, layout, frames_from_bytes(content, layout))


def _recording(path: Path, content: bytes, layout: Layout, frames: Frames) -> Recording:
    warnings = list(layout.warnings)
    points = _points(layout, frames, warnings)
    labels = _labels(layout, warnings)
    kinds = output_kinds(labels, points, _typed(layout.section, labels))
    marker = np.array([kind is None for kind in kinds], dtype=bool)
    unit, metres, doubts = length_unit(layout.section.text("POINT", "UNITS"), points[:, marker])
    warnings.extend(doubts)
    residuals = residuals_from_fourth(frames.fourth, layout.scale)
    in_metres = residuals[:, marker] * metres
    first_frame = first_frame_of(layout)
    analog = analog_from_samples(layout, frames.analog, warnings)
    start = start_time(first_frame, layout.rate)
    events = events_from_file(layout.header, layout.section, start, warnings)
    outputs = tuple(
        Output(label, kind, points[:, i], _unit(layout.section, kind, unit), residuals[:, i])
        for i, (label, kind) in enumerate(zip(labels, kinds, strict=True))
        if kind is not None
    )
    source = Source(
        layout,
        frames,
        labels,
        tuple(marker.tolist()),
        first_frame,
        metres,
        events,
        analog,
        is_padded=len(content) > layout.end,
        rotations=rotations_from_bytes(content, layout, warnings),
    )
    findings: dict[str, Json] = {
        "encoding": f"{layout.processor.name} {'real' if layout.is_float else 'integer'}",
        "unit": unit,
        "rate_hz": layout.rate,
        "up": _up(layout.section),
        "n_frames": layout.n_frames,
        "n_markers": int(marker.sum()),
        "n_outputs": len(outputs),
        "n_analog_channels": layout.n_channels,
        "n_events": len(events),
    }
    names = tuple(label for label, kind in zip(labels, kinds, strict=True) if kind is None)
    return Recording(
        markers=points[:, marker] * metres,
        labels=names,
        rate=layout.rate,
        first_frame=first_frame,
        residuals=in_metres if np.nan_to_num(in_metres).any() else None,
        confidence=_confidence(layout, names),
        outputs=outputs,
        analog=analog,
        events=events,
        up=_up(layout.section),
        details={KEY: source},
        history=(
            Step(
                name="read",
                settings={"format": "c3d", "file": path.name},
                findings=findings,
                warnings=tuple(warnings),
            ),
        ),
    )


def _confidence(layout: Layout, labels: tuple[str, ...]) -> Array | None:
    """Return how sure labels are, where labelling has written it; None where it has not."""
    names = layout.section.texts("LABELLING", "LABELS")
    values = layout.section.numbers("LABELLING", "CONFIDENCE")
    if not names or len(names) != len(values):
        return None
    sure = dict(zip(names, values, strict=True))
    found = np.array([float(sure.get(label, np.nan)) for label in labels])
    return found if ((found >= 0) & (found <= 1)).any() else None


def _points(layout: Layout, frames: Frames, warnings: list[str]) -> Array:
    points = as_doubles(frames.points)
    if not layout.is_float:
        points *= layout.scale
    hidden = unseen(frames.fourth)
    infinite = np.isinf(points).any(axis=2) & ~hidden
    if infinite.any():
        frame, point = np.argwhere(infinite)[0]
        warnings.append(
            f"{infinite.sum()} points have infinite coordinates (first: point {point + 1} of "
            f"stored frame {frame}); taken as not seen"
        )
    points[hidden | ~np.isfinite(points).all(axis=2)] = np.nan
    return points


def _labels(layout: Layout, warnings: list[str]) -> tuple[str, ...]:
    """Return one unique name a point; labels beyond the points in use name nothing."""
    said = list(layout.section.texts("POINT", "LABELS")[: layout.n_points])
    said += [""] * (layout.n_points - len(said))
    taken = set(said)
    times: Counter[str] = Counter()
    labels = []
    for i, label in enumerate(said):
        times[label] += 1
        if not label:
            label = _free(f"*{i}", taken)
        elif times[label] > 1:
            new = _free(f"{label}_{times[label]}", taken)
            warnings.append(f"label {label} is there more than once; point {i + 1} is called {new}")
            label = new
        labels.append(label)
    return tuple(labels)


def _free(label: str, taken: set[str]) -> str:
    while label in taken:
        label += "'"
    taken.add(label)
    return label


def _typed(section: Section, labels: Sequence[str]) -> dict[str, OutputKind]:
    """Return the kind of every point that a typed group of the file lists."""
    pairs = section.texts("POINT", "TYPE_GROUPS")
    groups = dict(zip(pairs[::2], pairs[1::2], strict=False))
    for name in _STANDARD_GROUPS:
        groups.setdefault(name, name)
    present = set(labels)
    return {
        label: kind_of_type(type_name)
        for group, type_name in groups.items()
        for label in section.texts("POINT", group)
        if label in present
    }


def _unit(section: Section, kind: OutputKind, length: str) -> str:
    if kind in ("segment_frame", "centre_of_mass", "other"):
        return length
    return section.text("POINT", f"{kind.upper()}_UNITS")


def _up(section: Section) -> UpAxis | None:
    """Return the axis that points up on a screen, as POINT:Y_SCREEN says (``+Z``, ``Z+``)."""
    match = _AXIS.fullmatch(section.text("POINT", "Y_SCREEN"))
    if match is None:
        return None
    sign = "-" if "-" in (match[1], match[3]) else "+"
    up: UpAxis = f"{sign}{match[2].lower()}"  # type: ignore[assignment]
    return up
