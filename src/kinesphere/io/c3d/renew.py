"""The parameters of a file to be written: those of its source, made to agree with the recording.

Only what no longer agrees is touched, so that a recording nobody changed takes every parameter
along as it was: spelling, order, descriptions, locks.
"""

from collections.abc import Mapping

import numpy as np

from kinesphere import __version__
from kinesphere.data import Analog, Output, Recording, vector_from_direction
from kinesphere.io.c3d.events import start_time, with_events
from kinesphere.io.c3d.header import LARGEST_WORD
from kinesphere.io.c3d.parameters import (
    Section,
    float_list,
    floats,
    text,
    text_pairs,
    word_list,
    words,
)
from kinesphere.io.c3d.points import Point
from kinesphere.io.c3d.source import Source

DESCRIPTIONS = "c3d.descriptions"
"""In ``Recording.details``: label → text, of points that no file describes yet."""
NOTES = "c3d.notes"
"""In ``Recording.details``: sentences for a group of our own."""
OURS = "KINESPHERE"
"""That group."""
_SCREEN = {"x": ("+Y", "X"), "y": ("+X", "Y"), "z": ("+X", "Z")}
"""Up → what POINT:X_SCREEN and Y_SCREEN say of a right-handed room."""
_TYPES = {
    "angle": "ANGLE",
    "force": "FORCE",
    "moment": "MOMENT",
    "power": "POWER",
    "scalar": "SCALAR",
}


def renewed(recording: Recording, points: tuple[Point, ...], source: Source | None) -> Section:
    """Return the parameters of the recording; POINT:SCALE and DATA_START are still to be set."""
    section = source.layout.section if source else _new_section(recording)
    section = _with_points(section, recording, points, source)
    section = _with_frames(section, recording, source)
    section = _with_confidence(section, recording)
    if notes := recording.details.get(NOTES):
        section = section.with_texts(OURS, "CONVENTIONS", notes)
    if source is None or recording.analog is not source.analog:
        section = _with_analog(section, recording.analog, source.analog if source else None)
    return _with_events(section, recording, source)


def _new_section(recording: Recording) -> Section:
    section = (
        Section()
        .with_parameters("POINT", words("USED", 0), words("FRAMES", 0), words("DATA_START", 0))
        .with_parameters("POINT", floats("SCALE", 0.0), floats("RATE", recording.rate))
        .with_texts("POINT", "LABELS", ())
        .with_texts("POINT", "DESCRIPTIONS", ())
        .with_parameters("POINT", text("UNITS", "mm"))
        .with_parameters("ANALOG", words("USED", 0), floats("GEN_SCALE", 1.0))
        .with_parameters("FORCE_PLATFORM", words("USED", 0))
        .with_parameters("TRIAL", floats("CAMERA_RATE", recording.rate))
        .with_parameters("MANUFACTURER", text("COMPANY", "Kinesphere"))
        .with_parameters("MANUFACTURER", text("SOFTWARE", "Kinesphere"))
        .with_parameters("MANUFACTURER", text("VERSION_LABEL", __version__))
    )
    if (up := _up_in_file(recording)) is not None:
        x_screen, y_screen = _SCREEN[up[1]]
        section = section.with_parameters(
            "POINT", text("X_SCREEN", x_screen), text("Y_SCREEN", up[0] + y_screen)
        )
    return section


def _up_in_file(recording: Recording) -> str | None:
    """Return the direction that is up in the axes of the file, if it is one of those axes."""
    if recording.up is None:
        return None
    in_file = vector_from_direction(recording.up) @ recording.world_from_file
    axis = int(np.argmax(np.abs(in_file)))
    if not np.isclose(abs(in_file[axis]), 1.0):
        return None
    return ("+" if in_file[axis] > 0 else "-") + "xyz"[axis]


def _with_points(
    section: Section,
    recording: Recording,
    points: tuple[Point, ...],
    source: Source | None,
) -> Section:
    n_points = len(points)
    if source is None or n_points != source.layout.n_points:
        section = section.with_parameters("POINT", words("USED", n_points))
    if section.number("POINT", "RATE") != np.float32(recording.rate):
        section = section.with_parameters("POINT", floats("RATE", recording.rate))
    unchanged = source is not None and source.labels == tuple(point.label for point in points)
    if not unchanged:
        section = _with_labels(section, points, source, recording.details.get(DESCRIPTIONS, {}))
        if source is not None:
            section = _without_gone(section, {point.label for point in points}, source)
        section = _with_types(section, recording.outputs)
    return section


def _with_labels(
    section: Section,
    points: tuple[Point, ...],
    source: Source | None,
    told: Mapping[str, str],
) -> Section:
    n_old = source.layout.n_points if source else 0
    said = _filled(section.texts("POINT", "LABELS"), n_old)
    described = _filled(section.texts("POINT", "DESCRIPTIONS"), n_old)
    labels, descriptions, renamed = [], [], {}
    for point in points:
        label, description = point.label, told.get(point.label, "")
        if source is not None and point.origin is not None:
            if source.labels[point.origin] == label:  # the file's own, not our unique spelling
                label = said[point.origin]
            else:
                renamed[said[point.origin]] = label
            description = description or described[point.origin]
        labels.append(label)
        descriptions.append(description)
    section = section.with_texts("POINT", "LABELS", (*labels, *said[n_old:]))
    if any(descriptions) or described:
        section = section.with_texts("POINT", "DESCRIPTIONS", (*descriptions, *described[n_old:]))
    if renamed:
        section = _rename(section, renamed, labels)
    return section


def _rename(section: Section, renamed: dict[str, str], labels: list[str]) -> Section:
    """Let what else speaks of labels follow: typed groups, and whether prefixes are in use."""
    for group in section.texts("POINT", "TYPE_GROUPS")[::2]:
        if listed := section.texts("POINT", group):
            follows = [renamed.get(label, label) for label in listed]
            section = section.with_texts("POINT", group, follows)
    prefixes = tuple(prefix for prefix in section.texts("SUBJECTS", "LABEL_PREFIXES") if prefix)
    uses = section.find("SUBJECTS", "USES_PREFIXES")
    if uses is not None and prefixes and not any(label.startswith(prefixes) for label in labels):
        none = words("USES_PREFIXES", np.zeros(len(uses.numbers)), *uses.dims)
        section = section.with_parameters("SUBJECTS", none)
    return section


def _without_gone(section: Section, labels: set[str], source: Source) -> Section:
    """Take labels of the source that are no points any more out of the typed groups."""
    gone = set(source.labels) - labels
    for group in section.texts("POINT", "TYPE_GROUPS")[::2]:
        listed = section.texts("POINT", group)
        if kept := [label for label in listed if label not in gone]:
            if len(kept) < len(listed):
                section = section.with_texts("POINT", group, kept)
        elif listed:
            section = section.without("POINT", group)
    return section


def _with_types(section: Section, outputs: tuple[Output, ...]) -> Section:
    """List the outputs of a kind in their typed group, unless they are listed already."""
    pairs = list(section.texts("POINT", "TYPE_GROUPS"))
    for kind, name in _TYPES.items():
        group = f"{name}S"
        of_kind = [output for output in outputs if output.kind == kind]
        listed = section.texts("POINT", group)
        new = [output.label for output in of_kind if output.label not in listed]
        if not new:
            continue
        section = section.with_texts("POINT", group, (*listed, *new))
        if section.find("POINT", f"{name}_UNITS") is None:
            section = section.with_parameters("POINT", text(f"{name}_UNITS", of_kind[0].unit))
        if group not in pairs[::2]:
            pairs += [group, name]
    if tuple(pairs) != section.texts("POINT", "TYPE_GROUPS"):
        section = section.with_parameters("POINT", text_pairs("TYPE_GROUPS", pairs))
    return section


def _with_frames(section: Section, recording: Recording, source: Source | None) -> Section:
    n, first = recording.n_frames, recording.first_frame
    if source is not None and (n, first) == (source.layout.n_frames, source.first_frame):
        return section
    section = section.with_parameters("POINT", words("FRAMES", min(n, LARGEST_WORD)))
    if n > LARGEST_WORD or section.find("POINT", "LONG_FRAMES") is not None:
        section = section.with_parameters("POINT", floats("LONG_FRAMES", n))
    start, end = (
        words(name, [number % 65536, number // 65536], 2)
        for name, number in (("ACTUAL_START_FIELD", first), ("ACTUAL_END_FIELD", first + n - 1))
    )
    return section.with_parameters("TRIAL", start, end)


def _with_confidence(section: Section, recording: Recording) -> Section:
    """Say in a group of our own how sure the labels are that labelling gave."""
    if recording.confidence is None:
        return section
    given = np.flatnonzero(np.isfinite(recording.confidence))
    if not len(given):
        return section
    return section.with_texts(
        "LABELLING", "LABELS", [recording.labels[i] for i in given]
    ).with_list("LABELLING", *float_list("CONFIDENCE", recording.confidence[given]))


def _with_analog(section: Section, analog: Analog | None, was: Analog | None) -> Section:
    if analog is None:
        return section.with_parameters("ANALOG", words("USED", 0))
    n = len(analog.labels)
    section = section.with_parameters("ANALOG", words("USED", n), floats("RATE", analog.rate))
    if was is not None and (was.labels, was.units) == (analog.labels, analog.units):
        return section
    if was is None or len(was.labels) != n:
        for name in ("GAIN", "FORMAT", "BITS"):
            section = section.without("ANALOG", name)
        section = (
            section.with_parameters("ANALOG", floats("GEN_SCALE", 1.0))
            .with_list("ANALOG", *float_list("SCALE", np.ones(n)))
            .with_list("ANALOG", *word_list("OFFSET", np.zeros(n)))
        )
    return (
        section.with_texts("ANALOG", "LABELS", analog.labels)
        .with_texts("ANALOG", "DESCRIPTIONS", [""] * n)
        .with_texts("ANALOG", "UNITS", analog.units)
    )


def _with_events(section: Section, recording: Recording, source: Source | None) -> Section:
    start = start_time(recording.first_frame, recording.rate)
    if source is not None:
        was = start_time(source.first_frame, source.layout.rate)
        if recording.events == source.events and start == was:
            return section
    elif not recording.events:
        return section
    return with_events(section, recording.events, start)


def _filled(values: tuple[str, ...], n: int) -> tuple[str, ...]:
    return (*values, *("" for _ in range(len(values), n)))
