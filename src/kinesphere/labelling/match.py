"""One person's labels brought to those of a model."""

from collections.abc import Mapping, Sequence
from dataclasses import replace

from kinesphere.data import Json, Recording, Step, TopologicalModel
from kinesphere.errors import BadRecording
from kinesphere.labelling.choice import (
    COVERED,
    PERSON,
    choose_subject,
    covered_share,
    names_by_subject,
    names_of,
)
from kinesphere.labelling.spelling import columns_by_label
from kinesphere.labelling.subjects import Name


def match_labels(
    recording: Recording, model: TopologicalModel, subject: str | None = None
) -> Recording:
    """Return the recording with the model's own labels for one person's markers.

    The subject's prefix goes, other spellings become the model's. Points that the model does not
    know stay, unlabelled ones and props with a prefix of their own as well; markers of other
    people, who wear at least half of the layout, are dropped: to every later stage they would be
    ghosts. Markers keep their order and their values.

    Parameters
    ----------
    subject
        Prefix of the person wanted; may be left out where only one wears the layout.

    Raises
    ------
    BadRecording
        If the subject is unknown, several people wear the layout and none was picked, no label of
        the model is there, or two markers claim one label.
    """
    groups = names_by_subject(recording, model)
    chosen = choose_subject(groups, model) if subject is None else subject
    names = names_of(groups, chosen)
    columns = columns_by_label(names, model)
    if not columns:
        shown = ", ".join(recording.labels[:8]) + (", …" if len(recording.labels) > 8 else "")
        raise BadRecording(f"no marker of model {model.name} is there; the labels are {shown}")
    others = {
        other: [name.column for name in theirs]
        for other, theirs in groups.items()
        if other != chosen and covered_share(theirs, model) >= PERSON
    }
    dropped = {column for theirs in others.values() for column in theirs}
    kept = [column for column in range(recording.n_markers) if column not in dropped]
    labels = _new_labels(recording, names, columns, kept)
    step = _step(recording, model, subject, chosen, columns, names, tuple(others))
    return replace(
        recording,
        markers=recording.markers[:, kept] if dropped else recording.markers,
        labels=tuple(labels[column] for column in kept),
        residuals=recording.residuals[:, kept]
        if dropped and recording.residuals is not None
        else recording.residuals,
        confidence=None if recording.confidence is None else recording.confidence[kept],
        history=(*recording.history, step),
    )


def _new_labels(
    recording: Recording, names: Sequence[Name], columns: Mapping[str, int], kept: Sequence[int]
) -> dict[int, str]:
    """Give the subject's markers their new labels; a bare name that is taken stays prefixed."""
    new = {column: label for label, column in columns.items()}
    old = {column: recording.labels[column] for column in kept if column not in new}
    for label in old.values():
        if label in columns:
            raise BadRecording(
                f"markers {recording.labels[columns[label]]} and {label} would both be called "
                f"{label}; rename one of them"
            )
    taken = {*new.values(), *old.values()}
    for name in names:
        if name.column in old and name.bare not in taken:
            old[name.column] = name.bare
            taken.add(name.bare)
    return {**old, **new}


def _step(
    recording: Recording,
    model: TopologicalModel,
    asked: str | None,
    chosen: str,
    columns: Mapping[str, int],
    names: Sequence[Name],
    others: tuple[str, ...],
) -> Step:
    required = model.required or model.labels
    missing: list[Json] = [label for label in required if label not in columns]
    used = set(columns.values())
    extra: list[Json] = [
        n.bare for n in names if n.column not in used and not n.bare.startswith("*")
    ]
    respelled: dict[str, Json] = {
        n.bare: label
        for label, column in columns.items()
        for n in names
        if n.column == column and n.bare != label
    }
    unseen: list[Json] = [
        label for label, column in columns.items() if not recording.seen[:, column].any()
    ]
    found = len(required) - len(missing)
    warnings = []
    if found < COVERED * len(required):
        warnings.append(
            f"only {found} of {len(required)} markers of model {model.name} are there; "
            f"missing: {', '.join(map(str, missing))}"
        )
    if others:
        warnings.append(
            f"markers of other people were dropped: {', '.join(o or '(no prefix)' for o in others)}"
        )
    return Step(
        name="labelling",
        settings={"model": model.name, "subject": asked},
        findings={
            "subject": chosen,
            "required": len(required),
            "required_found": found,
            "labels_found": len(columns),
            "missing": missing,
            "never_seen": unseen,
            "extra": extra,
            "respelled": respelled,
            "other_people": list(others),
        },
        warnings=tuple(warnings),
    )
