"""Warnings as a person reads them: one line a reason, joints in few words."""

import re
from collections.abc import Collection, Iterable, Iterator, Sequence
from dataclasses import dataclass

from kinesphere.data import Skeleton
from kinesphere.report.wording import unique

_PLURALS = {"foot": "feet"}
# which axis is no figure of it, nor how many there are: joints with unlike counts are no range
_NUMBER = re.compile(r"(?<!axis )(?<!only \d of )(?!\d of \d main movements)\d+(?:\.\d+)?")
_BRACKETED = re.compile(r"(\w+) \(([^()]*)\)(?:, |$)")
_SUFFIX = re.compile(r"\.\w")
_JOINERS = frozenset("'\"`=/\\.-")
_RUN = re.compile(r"\w+(?:, \w+)*")


def names_of(skeleton: Skeleton) -> frozenset[str]:
    """Return the names of all joints and limbs."""
    return frozenset((*skeleton.joint_names, *skeleton.limb_names))


@dataclass(frozen=True)
class Notice:
    """A warning; where it gives each joint a reason, reasons are told apart."""

    text: str
    reasons: tuple[tuple[str, str], ...] = ()
    """(reason, the joints it is about)."""


def notices(warnings: Sequence[str], names: Collection[str] = ()) -> list[Notice]:
    """Return warnings once each, in the order they came up.

    Parameters
    ----------
    warnings
        Sentences, with lists like ``left_hip, right_hip`` or
        ``left_hip (hardly moves; …), right_hip (…)``.
    names
        The joints and limbs that may be put in few words; whatever else a list names stays.
    """
    return [_notice(warning, frozenset(names)) for warning in unique(warnings)]


def names_in_words(names: Iterable[str]) -> str:
    """Return names as a person would list them: ``left_hip, right_hip, neck`` → hips, neck."""
    names = list(dict.fromkeys(names))
    said: list[str] = []
    for name in names:
        side, _, kind = name.partition("_")
        twin = {"left": f"right_{kind}", "right": f"left_{kind}"}.get(side)
        if twin not in names:
            said.append(name.replace("_", " "))
        elif names.index(name) < names.index(twin):
            *first, last = kind.split("_")
            said.append(" ".join([*first, _PLURALS.get(last, f"{last}s")]))
    return ", ".join(said)


def _notice(warning: str, names: frozenset[str]) -> Notice:
    head, colon, tail = warning.partition(": ")
    found = _BRACKETED.findall(tail)
    whole = "".join(match.group() for match in _BRACKETED.finditer(tail)) == tail
    if colon and found and whole and all(name in names for name, _ in found):
        reasons: dict[str, list[tuple[str, str]]] = {}
        for name, given in found:
            for reason in given.split("; "):
                reasons.setdefault(_NUMBER.sub("#", reason), []).append((name, reason))
        most_first = sorted(reasons.values(), key=len, reverse=True)
        return Notice(head, tuple(_grouped(group) for group in most_first))
    return Notice("".join(_in_few_words(warning, names)))


def _grouped(group: list[tuple[str, str]]) -> tuple[str, str]:
    """Return the common reason, each number as the range it takes, and who has it."""
    columns = zip(*(_NUMBER.findall(reason) for _, reason in group), strict=True)
    spans = []
    for column in columns:
        low, high = min(column, key=float), max(column, key=float)
        spans.append(low if low == high else f"{low}–{high}")
    numbers = iter(spans)
    return _NUMBER.sub(lambda _: next(numbers), group[0][1]), names_in_words(n for n, _ in group)


def _in_few_words(text: str, names: frozenset[str]) -> Iterator[str]:
    """Yield the text with each list of known names put in few words; a name alone, too.

    Not what stands in a file's name, a setting or quotes, and no name among unknown ones.
    """
    end = 0
    for run in _RUN.finditer(text):
        words = run.group().split(", ")
        known = [word in names for word in words]
        first = next((i for i, yes in enumerate(known) if yes), len(words))
        alone = known == [True] and not _inside(text, run.start(), run.end())
        if (alone or sum(known) > 1) and all(known[first:]):
            yield text[end : run.start()]
            yield ", ".join([*words[:first], names_in_words(words[first:])])
            end = run.end()
    yield text[end:]


def _inside(text: str, start: int, end: int) -> bool:
    """Return whether a word is part of something that must stay as it is written."""
    before, after = text[max(0, start - 1) : start], text[end : end + 2]
    return before in _JOINERS or after[:1] in _JOINERS - {"."} or bool(_SUFFIX.match(after))
