"""The history of a solution: what each step found, doubted and was told."""

from dataclasses import dataclass
from typing import Any

from kinesphere.data import Json, Solution, Step
from kinesphere.report.notices import Notice, names_of, notices
from kinesphere.report.wording import finding_in_words, in_words, number_in_words


@dataclass(frozen=True)
class FindingTable:
    """What a step found of each joint or limb."""

    name: str
    header: tuple[str, ...]
    rows: tuple[tuple[str, ...], ...]


@dataclass(frozen=True)
class StepCard:
    """One step of the history."""

    name: str
    seconds: str
    findings: tuple[tuple[str, str], ...]
    tables: tuple[FindingTable, ...]
    warnings: tuple[Notice, ...]
    settings: tuple[tuple[str, str], ...]
    version: str


def step_cards(solution: Solution) -> list[StepCard]:
    """Return one card a step, in the order things were done."""
    cards = []
    for step in solution.history:
        seconds = solution.seconds.get(step.name)
        cards.append(
            StepCard(
                name=in_words(step.name),
                seconds="" if seconds is None else number_in_words(seconds, "s"),
                findings=tuple(
                    finding_in_words(k, v) for k, v in step.findings.items() if not _is_table(v)
                ),
                tables=tuple(_table(k, v) for k, v in step.findings.items() if _is_table(v)),
                warnings=tuple(notices(step.warnings, names_of(solution.skeleton))),
                settings=settings_rows(step),
                version=step.version,
            )
        )
    return cards


def settings_rows(step: Step) -> tuple[tuple[str, str], ...]:
    """Return every setting of a step as text, nested ones as ``stage.key``."""
    return tuple(_flat(step.settings))


def _is_table(value: Json) -> bool:
    return isinstance(value, dict) and any(isinstance(row, dict) for row in value.values())


def _table(name: str, found: Any) -> FindingTable:
    """Return a dictionary of dictionaries as rows; lists and further dictionaries stay out."""
    entries = {key: row for key, row in found.items() if isinstance(row, dict)}
    keys = dict.fromkeys(
        key
        for row in entries.values()
        for key, value in row.items()
        if not isinstance(value, dict | list)
    )
    return FindingTable(
        name=in_words(name),
        header=tuple(finding_in_words(key, None)[0] for key in keys),
        rows=tuple(
            (in_words(entry), *(finding_in_words(key, row.get(key))[1] for key in keys))
            for entry, row in entries.items()
        ),
    )


def _flat(settings: Any, above: str = "") -> list[tuple[str, str]]:
    rows: list[tuple[str, str]] = []
    for key, value in settings.items():
        if isinstance(value, dict):
            rows += _flat(value, f"{above}{key}.")
        else:
            rows.append((f"{above}{key}", finding_in_words("", value, listed=20)[1]))
    return rows
