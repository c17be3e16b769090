"""Which person and which layout: how much of a model the labels of each subject cover."""

from collections.abc import Mapping, Sequence
from typing import TypeAlias

from kinesphere.data import Recording, TopologicalModel
from kinesphere.errors import BadRecording
from kinesphere.labelling.models import built_in_model, built_in_models
from kinesphere.labelling.spelling import spelled
from kinesphere.labelling.subjects import Name, parse_labels

COVERED = 0.9
"""Share of a model's required labels from which on a recording counts as wearing that layout."""
PERSON = 0.5
"""Share from which on names count as a person's rather than a prop's: half a body is no wand."""

Groups: TypeAlias = Mapping[str, Sequence[Name]]
"""Subject → the names that are theirs; the empty subject has those without a prefix."""


def coverage(recording: Recording, model: TopologicalModel, subject: str | None = None) -> float:
    """Return the share of the model's required labels that the recording has, 0…1.

    Without ``subject``, that of the subject who has most of them. A model that requires nothing
    counts all its labels. A label is there even if its marker was never seen.

    Raises
    ------
    BadRecording
        If no label names that subject.
    """
    groups = names_by_subject(recording, model)
    if subject is not None:
        return covered_share(names_of(groups, subject), model)
    return max(covered_share(names, model) for names in groups.values())


def choose_model(recording: Recording, subject: str | None = None) -> TopologicalModel | None:
    """Return the built-in model whose layout the recording wears, or None.

    The one with the highest coverage from 90 % on; of equals, the one that names more markers.
    """

    def fit(model: TopologicalModel) -> tuple[float, int]:
        groups = names_by_subject(recording, model)
        chosen = groups.values() if subject is None else [names_of(groups, subject)]
        return max((covered_share(names, model), len(spelled(names, model))) for names in chosen)

    best = max(map(built_in_model, built_in_models()), key=fit)
    return best if fit(best)[0] >= COVERED else None


def names_by_subject(recording: Recording, model: TopologicalModel) -> Groups:
    """Group names by subject.

    Where a single prefix is in the file, bare names are that subject's as well, unless they are
    another person's or it is a prop's: whoever covers half of the layout alone is a person.
    """
    groups: dict[str, list[Name]] = {}
    for name in parse_labels(recording.labels, model):
        groups.setdefault(name.subject, []).append(name)
    if len(groups) == 2 and "" in groups and covered_share(groups[""], model) < PERSON:
        (subject,) = (known for known in groups if known)
        if covered_share(groups[subject], model) >= covered_share(groups[""], model):
            return {subject: [*groups[subject], *groups[""]]}
    return groups or {"": []}


def names_of(groups: Groups, subject: str) -> Sequence[Name]:
    """Return one subject's names; BadRecording, listing the subjects, if there is no such one."""
    if subject not in groups:
        there = ", ".join(repr(known) for known in groups if known) or "none: labels have no prefix"
        raise BadRecording(f"no marker belongs to subject {subject!r}; subjects are {there}")
    return groups[subject]


def covered_share(names: Sequence[Name], model: TopologicalModel) -> float:
    """Return the share of the required labels that these names spell, 0…1."""
    wanted = model.required or model.labels
    found = spelled(names, model)
    return sum(label in found for label in wanted) / len(wanted) if wanted else 0.0


def choose_subject(groups: Groups, model: TopologicalModel) -> str:
    """Return the one subject who wears the layout; BadRecording if several do."""
    shares = {subject: covered_share(names, model) for subject, names in groups.items()}
    wearing = [subject for subject, share in shares.items() if share > 0]
    covered = [subject for subject in wearing if shares[subject] >= COVERED] or wearing
    if len(covered) > 1:
        people = ", ".join(f"{s or '(no prefix)'} ({shares[s]:.0%})" for s in covered)
        nameless = ', "" is who has no prefix' if "" in covered else ""
        raise BadRecording(
            f"several subjects wear layout {model.name}: {people}; pick a subject "
            f"(--subject NAME{nameless})"
        )
    return covered[0] if covered else next(iter(groups))
