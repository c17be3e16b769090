"""Which label of a model a marker's name stands for: exact, then any case, then an alias."""

from collections.abc import Callable, Iterable
from typing import NamedTuple

from kinesphere.data import TopologicalModel
from kinesphere.errors import BadRecording
from kinesphere.labelling.subjects import Name

_EXACT, _OTHER_CASE, _ALIAS, _ALIAS_OTHER_CASE = range(4)


class _Reading(NamedTuple):
    """One way to read a name: the better, the lower its rank."""

    rank: int
    label: str


def spelled(names: Iterable[Name], model: TopologicalModel) -> dict[str, tuple[Name, ...]]:
    """Return, for each label of the model, the names that spell it best; two names are a clash.

    A name that spells a label worse than another one does not count: where ``RBAC`` is there, its
    alias ``RBAK`` stays what it is.
    """
    best: dict[str, tuple[int, tuple[Name, ...]]] = {}
    readings = _readings(model)
    for name in names:
        reading = readings(name.bare)
        if reading is None:
            continue
        rank, so_far = best.get(reading.label, (reading.rank, ()))
        if reading.rank < rank:
            rank, so_far = reading.rank, ()
        if reading.rank == rank:
            best[reading.label] = (rank, (*so_far, name))
    return {label: found for label, (_, found) in best.items()}


def columns_by_label(names: Iterable[Name], model: TopologicalModel) -> dict[str, int]:
    """Return the column of every label of the model that is there.

    Raises
    ------
    BadRecording
        If two markers claim one label, naming both.
    """
    columns = {}
    for label, found in spelled(names, model).items():
        if len(found) > 1:
            claims = " and ".join(_shown(name) for name in found)
            raise BadRecording(
                f"markers {claims} both stand for {label} of model {model.name}; rename one of them"
            )
        columns[label] = found[0].column
    return columns


def _readings(model: TopologicalModel) -> Callable[[str], _Reading | None]:
    labels = set(model.labels)
    any_case = {label.casefold(): label for label in model.labels}
    aliases_any_case = {alias.casefold(): label for alias, label in model.aliases.items()}

    def read(bare: str) -> _Reading | None:
        if bare in labels:
            return _Reading(_EXACT, bare)
        if label := any_case.get(bare.casefold()):
            return _Reading(_OTHER_CASE, label)
        if label := model.aliases.get(bare):
            return _Reading(_ALIAS, label)
        if label := aliases_any_case.get(bare.casefold()):
            return _Reading(_ALIAS_OTHER_CASE, label)
        return None

    return read


def _shown(name: Name) -> str:
    return f"{name.subject}:{name.bare}" if name.subject else name.bare
