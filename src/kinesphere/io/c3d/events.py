"""Events: the group EVENT, or the eighteen places in the header that came before it."""

import math
from collections.abc import Sequence

import numpy as np

from kinesphere.data import Event
from kinesphere.io.c3d.header import Header
from kinesphere.io.c3d.parameters import Section, float_list, words


def start_time(first_frame: int, rate: float) -> float:
    """Return the file's time, in s, of the first stored frame: frame 1 of the trial is at 0."""
    return (max(first_frame, 1) - 1) / rate


def events_from_file(
    header: Header, section: Section, start: float, warnings: list[str]
) -> tuple[Event, ...]:
    """Return the events of the parameters, or of the header if those have none.

    Parameters
    ----------
    header, section
        Of the file.
    start
        s, the file's time of the first stored frame.
    warnings
        What is doubtful is added here.
    """
    labels = section.texts("EVENT", "LABELS")
    times = section.numbers("EVENT", "TIMES")
    count = min(len(labels), len(times) // 2)
    used = section.count("EVENT", "USED")
    if used is not None:
        count = min(count, max(used, 0))
    found = [
        (60.0 * times[2 * i] + times[2 * i + 1], label, i) for i, label in enumerate(labels[:count])
    ] or [(time, label, -1) for time, label in header.events]
    contexts, subjects, descriptions = (
        section.texts("EVENT", name) for name in ("CONTEXTS", "SUBJECTS", "DESCRIPTIONS")
    )
    events = []
    for time, label, i in found:
        if not math.isfinite(time):
            warnings.append(f"event {label!r} has no time; left out")
            continue
        events.append(
            Event(
                float(time) - start,
                label,
                _at(contexts, i),
                _at(subjects, i),
                _at(descriptions, i),
            )
        )
    return tuple(events)


def with_events(section: Section, events: Sequence[Event], start: float) -> Section:
    """Return the parameters with the group EVENT saying this; ``start`` as in reading."""
    times = np.array([event.time + start for event in events])
    minutes = np.floor(times / 60.0)
    for name in ("ICON_IDS", "GENERIC_FLAGS"):  # one a event, of events that are no more
        section = section.without("EVENT", name)
    return (
        section.with_parameters("EVENT", words("USED", len(events)))
        .with_texts("EVENT", "CONTEXTS", [event.context for event in events])
        .with_texts("EVENT", "LABELS", [event.label for event in events])
        .with_texts("EVENT", "DESCRIPTIONS", [event.description for event in events])
        .with_texts("EVENT", "SUBJECTS", [event.subject for event in events])
        .with_list(
            "EVENT", *float_list("TIMES", np.column_stack([minutes, times - 60.0 * minutes]))
        )
    )


def _at(values: Sequence[str], i: int) -> str:
    return values[i] if 0 <= i < len(values) else ""
