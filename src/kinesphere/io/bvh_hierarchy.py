"""The hierarchy of a BVH file, as it stands.

Format: M. Meredith, S. Maddock (2001), Motion Capture File Formats Explained, section 3.1; and
what programs make of it: any order and number of channels, braces on the line of the name, names
with blanks, joints without an end site.
"""

import re
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import NamedTuple

import numpy as np

from kinesphere.errors import UnreadableFile

MOST_JOINTS = 2000
MOST_DEPTH = 200
_CHANNEL = re.compile(r"([xyz])(position|rotation)", re.IGNORECASE)


@dataclass
class BvhNode:
    """A joint of the hierarchy."""

    name: str
    parent: int
    """Index of the parent; −1 for the root."""
    offset: tuple[float, float, float] = (0.0, 0.0, 0.0)
    """From the parent, in the file's unit and axes."""
    channels: tuple[str, ...] = ()
    """``Xposition``, ``Zrotation``…, in the order of the columns."""
    end: tuple[float, float, float] | None = None
    """Offset of the end site."""


class _Line(NamedTuple):
    number: int
    words: list[str]
    text: str


def _pieces(lines: list[str]) -> Iterator[_Line]:
    """Yield statements: braces stand alone, whatever the file has them share a line with."""
    for number, line in enumerate(lines, start=1):
        for piece in re.split(r"([{}])", line):
            if text := piece.strip():
                yield _Line(number, text.split(), text)


def nodes_from_lines(lines: list[str], path: Path, warnings: list[str]) -> list[BvhNode]:
    """Return the joints of the lines before ``MOTION``; warnings are added to the list.

    Raises
    ------
    UnreadableFile
        Naming the line, what was found and what would be right.
    """
    nodes: list[BvhNode] = []
    inside: list[int] = []  # joints whose braces are open; −1 for an end site
    named: int | None = None  # what the next brace opens
    names: set[str] = set()
    for number, words, text in _pieces(lines):
        where, key = f"{path}: line {number}", words[0].upper()
        if key == "HIERARCHY":
            continue
        if named is not None and key != "{":
            raise UnreadableFile(f"{where} holds {text!r:.40} where {{ was expected")
        if key in ("ROOT", "JOINT"):
            if (key == "ROOT") == bool(inside) or (key == "ROOT" and nodes):
                raise UnreadableFile(f"{where}: {text!r:.40} stands where no {key} can; one ROOT")
            if inside and inside[-1] < 0:
                raise UnreadableFile(f"{where}: {text!r:.40} stands inside an End Site")
            if len(nodes) == MOST_JOINTS or len(inside) == MOST_DEPTH:
                raise UnreadableFile(
                    f"{where}: more than {MOST_JOINTS} joints, or {MOST_DEPTH} one in another"
                )
            name = _unique(text[len(key) :].strip() or f"joint_{len(nodes) + 1}", names, warnings)
            nodes.append(BvhNode(name, inside[-1] if inside else -1))
            named = len(nodes) - 1
        elif key == "END":
            if not inside or inside[-1] < 0:
                raise UnreadableFile(f"{where}: an End Site stands outside any joint")
            named = -1
        elif key == "{":
            if named is None:
                raise UnreadableFile(f"{where}: a {{ that belongs to no ROOT, JOINT or End Site")
            inside.append(named)
            named = None
        elif key == "}":
            if not inside:
                raise UnreadableFile(f"{where}: a }} too many")
            inside.pop()
        elif key == "OFFSET" and inside:
            offset = _triple(words[1:], where)
            if inside[-1] >= 0:
                nodes[inside[-1]].offset = offset
            else:
                owner = next(i for i in reversed(inside) if i >= 0)
                nodes[owner].end = offset
        elif key == "CHANNELS" and inside and inside[-1] >= 0:
            nodes[inside[-1]].channels = _channels(words[1:], where)
        else:
            raise UnreadableFile(
                f"{where} starts with {words[0]!r:.20}; JOINT, End Site, OFFSET, CHANNELS or a "
                "brace was expected"
            )
    if inside or named is not None:
        raise UnreadableFile(f"{path}: {len(inside)} braces are open when the hierarchy ends")
    if not nodes:
        raise UnreadableFile(f"{path}: the hierarchy names no ROOT")
    return nodes


def _unique(name: str, names: set[str], warnings: list[str]) -> str:
    unique, k = name, 2
    while unique in names:
        unique, k = f"{name}_{k}", k + 1
    if unique != name:
        warnings.append(f"there is more than one joint {name}; the next is called {unique}")
    names.add(unique)
    return unique


def _triple(words: list[str], where: str) -> tuple[float, float, float]:
    try:
        x, y, z = map(float, words)
    except ValueError:
        x = y = z = np.nan
    if not np.isfinite([x, y, z]).all():
        raise UnreadableFile(f"{where}: OFFSET {' '.join(words)!r:.40}; three numbers are right")
    return x, y, z


def _channels(words: list[str], where: str) -> tuple[str, ...]:
    said, *names = words or [""]
    known = [_CHANNEL.fullmatch(name) for name in names]
    if said != str(len(names)) or not all(known):
        raise UnreadableFile(
            f"{where}: CHANNELS {' '.join(words)!r:.60}; a number and as many names like Xposition "
            "and Zrotation are right"
        )
    return tuple(f"{match[1].upper()}{match[2].lower()}" for match in known if match)
