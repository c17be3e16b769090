"""Whose marker is it: labels taken apart into subject and name.

``Justin:LFWT`` is Justin's LFWT, whatever comes before the last colon. ``Anna_LFWT`` is Anna's only
where many labels say so in the vocabulary of one layout: ``Knee_Marker1`` and ``L_IAS`` are whole
names.
"""

from collections.abc import Iterable
from typing import NamedTuple

from kinesphere.data import Recording
from kinesphere.labelling.models import built_in_model, built_in_models

FEWEST_UNDERSCORED = 10
"""Labels of one layout that must share a prefix before an underscore counts as its end: fewer
could be chance, a full-body layout has three times as many."""


class Name(NamedTuple):
    """One label of a recording, taken apart."""

    column: int
    """Where it is in the recording."""
    subject: str
    """Whose it is; empty where the label names nobody."""
    bare: str
    """The label without its subject and blanks."""


def parse_labels(labels: Iterable[str], vocabulary: Iterable[str]) -> tuple[Name, ...]:
    """Take labels apart; ``vocabulary`` are the labels and aliases that a layout knows."""
    names = [_at_colon(column, label) for column, label in enumerate(labels)]
    known = {word.casefold() for word in vocabulary}
    underscored = {n.column: tuple(n.bare.split("_", 1)) for n in names if _may_split(n, known)}
    subjects = [subject for subject, _ in underscored.values()]
    trusted = {s for s in subjects if subjects.count(s) >= FEWEST_UNDERSCORED}
    return tuple(
        Name(n.column, *underscored[n.column])
        if n.column in underscored and underscored[n.column][0] in trusted
        else n
        for n in names
    )


def find_subjects(recording: Recording) -> tuple[str, ...]:
    """Return the subjects that the labels name, in the order of their first marker.

    Empty where no label has a prefix. A prop with a prefix of its own counts as a subject: only a
    model can tell it from a person.
    """
    found: dict[str, None] = {}
    for model in map(built_in_model, built_in_models()):
        for name in parse_labels(recording.labels, (*model.labels, *model.aliases)):
            if name.subject:
                found.setdefault(name.subject)
    return tuple(found)


def _at_colon(column: int, label: str) -> Name:
    subject, _, bare = label.rpartition(":")
    return Name(column, subject.strip(), bare.strip())


def _may_split(name: Name, known: set[str]) -> bool:
    subject, _, bare = name.bare.partition("_")
    return not name.subject and bool(subject) and bare.casefold() in known
