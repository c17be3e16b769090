"""Events: the group EVENT, or the eighteen places in the header that came before it."""

import math
from collections.abc import Sequence

import numpy as np

from kinesphere.data import Event
from kinesphere.io.c3d.header import Header
from kinesphere.io.c3d.parameters import Parameter, Section, floats, texts, words


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


def event_parameters(events: Sequence[Event], start: float) -> tuple[Parameter, ...]:
    """Return the parameters of the group EVENT; ``start`` as in ``events_from_file``."""
    times = np.array([event.time + start for event in events])
    minutes = np.floor(times / 60.0)
    n = len(events)
    return (
        words("USED", n),
        *texts("CONTEXTS", [event.context for event in events]),
        *texts("LABELS", [event.label for event in events]),
        *texts("DESCRIPTIONS", [event.description for event in events]),
        *texts("SUBJECTS", [event.subject for event in events]),
        floats("TIMES", np.column_stack([minutes, times - 60.0 * minutes]), 2, n),
    )


def _at(values: Sequence[str], i: int) -> str:
    return values[i] if 0 <= i < len(values) else ""
