"""Whose marker is it: labels taken apart into subject and name.

``Justin:LFWT`` is Justin's LFWT, whatever comes before the last colon. ``Anna_LFWT`` is Anna's only
where many labels say so with words that layouts know: ``Knee_Marker1`` and ``L_IAS`` are whole
names.
"""

from collections.abc import Iterable
from functools import cache
from typing import NamedTuple

from kinesphere.data import Recording, TopologicalModel
from kinesphere.labelling.models import built_in_model, built_in_models

FEWEST_UNDERSCORED = 10
"""Known labels that must share a prefix before an underscore counts as its end: fewer could be
chance, a full-body layout has three times as many."""


class Name(NamedTuple):
    """One label of a recording, taken apart."""

    column: int
    """Where it is in the recording."""
    subject: str
    """Whose it is; empty where the label names nobody."""
    bare: str
    """The label without its subject and blanks."""


def parse_labels(labels: Iterable[str], model: TopologicalModel | None = None) -> tuple[Name, ...]:
    """Take labels apart; the words of ``model`` are known beside those of the built-in ones."""
    known = _built_in_words() | (_words(model) if model is not None else frozenset())
    names = [_at_colon(column, label) for column, label in enumerate(labels)]
    split = {n.column: parts for n in names if (parts := _at_underscore(n, known))}
    claims = [subject for subject, _ in split.values()]
    trusted = {subject for subject in claims if claims.count(subject) >= FEWEST_UNDERSCORED}
    return tuple(
        Name(n.column, *split[n.column]) if split.get(n.column, ("",))[0] in trusted else n
        for n in names
    )


def find_subjects(recording: Recording) -> tuple[str, ...]:
    """Return the subjects that the labels name, in the order of their first marker.

    Empty where no label has a prefix. A prop with a prefix of its own counts as a subject: only a
    model can tell it from a person.
    """
    names = parse_labels(recording.labels)
    return tuple(dict.fromkeys(name.subject for name in names if name.subject))


@cache
def _built_in_words() -> frozenset[str]:
    return frozenset().union(*(_words(built_in_model(name)) for name in built_in_models()))


def _words(model: TopologicalModel) -> frozenset[str]:
    return frozenset(word.casefold() for word in (*model.labels, *model.aliases))


def _at_colon(column: int, label: str) -> Name:
    subject, _, bare = label.rpartition(":")
    return Name(column, subject.strip(), bare.strip())


def _at_underscore(name: Name, known: frozenset[str]) -> tuple[str, str] | None:
    """Split a name that is no known word where the longest known word begins, if one does."""
    if name.subject or name.bare.casefold() in known:
        return None
    parts = name.bare.split("_")
    for i in range(1, len(parts)):
        subject, word = "_".join(parts[:i]), "_".join(parts[i:])
        if subject and word.casefold() in known:
            return subject, word
    return None
