"""The text of a BVH file: its hierarchy, and its numbers as they stand.

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

from kinesphere.data import Array
from kinesphere.errors import UnreadableFile
from kinesphere.io.tables import parse_table, rate_from_times
from kinesphere.io.text import read_text

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


class BvhText(NamedTuple):
    """A BVH file as it stands."""

    nodes: list[BvhNode]
    """Parents before children, in the order of the columns."""
    hierarchy: str
    """The text before ``MOTION``."""
    values: Array
    """(n_frames, n_channels) in the file's unit and degrees."""
    rate: float
    """Hz."""
    warnings: tuple[str, ...]


class _Line(NamedTuple):
    number: int
    words: list[str]
    text: str


def parse_bvh(path: str | Path, *, motion_needed: bool = True) -> BvhText:
    """Parse a BVH file.

    Parameters
    ----------
    motion_needed
        False where the hierarchy alone is wanted: no frames, or none that make sense, will do.

    Raises
    ------
    UnreadableFile
        Naming the line, what was found and what would be right.
    """
    path = Path(path)
    lines = read_text(path).split("\n")
    if not lines[0].strip().upper().startswith("HIERARCHY") and not any(
        line.strip().upper().startswith("HIERARCHY") for line in lines[:20]
    ):
        raise UnreadableFile(f"{path}: line 1 starts with {lines[0][:20]!r}; BVH says HIERARCHY")
    start = next((i for i, line in enumerate(lines) if line.strip().upper() == "MOTION"), None)
    if start is None:
        if motion_needed:
            raise UnreadableFile(f"{path}: there is no line MOTION; the file breaks off before it")
        start = len(lines)
    warnings: list[str] = []
    nodes = _nodes(lines[:start], path, warnings)
    hierarchy = "\n".join(lines[:start]) + "\n"
    n_channels = sum(len(node.channels) for node in nodes)
    try:
        values, rate = _motion(lines, start, n_channels, path, warnings)
    except UnreadableFile:
        if motion_needed:
            raise
        values, rate = np.empty((0, n_channels)), np.nan
    return BvhText(nodes, hierarchy, values, rate, tuple(warnings))


def _pieces(lines: list[str]) -> Iterator[_Line]:
    """Yield statements: braces stand alone, whatever the file has them share a line with."""
    for number, line in enumerate(lines, start=1):
        for piece in re.split(r"([{}])", line):
            if text := piece.strip():
                yield _Line(number, text.split(), text)


def _nodes(lines: list[str], path: Path, warnings: list[str]) -> list[BvhNode]:
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


def _motion(
    lines: list[str], start: int, n_channels: int, path: Path, warnings: list[str]
) -> tuple[Array, float]:
    said, time, at = "", "", start + 1
    while at < len(lines):
        key, colon, value = lines[at].partition(":")
        if lines[at].strip() and not colon:
            break
        match key.strip().lower():
            case "frames":
                said = value.strip()
            case "frame time":
                time = value.strip()
        at += 1
    table = parse_table(lines[at:], at + 1, n_channels, path, None)
    if not len(table.values):
        raise UnreadableFile(f"{path}: there is no frame after MOTION")
    if said != str(len(table.values)):
        warnings.append(f"the file says {said or 'no'} frames, there are {len(table.values)}")
    return table.values, _rate(time, path, len(table.values), warnings)


def _rate(told: str, path: Path, n_frames: int, warnings: list[str]) -> float:
    """Return the roundest rate in Hz that the printed frame time allows."""
    try:
        step = float(told)
    except ValueError:
        step = np.nan
    if not 1e-6 < step < 1e6:
        if n_frames == 1:
            warnings.append("one frame tells no frame rate; 1 Hz is taken")
            return 1.0
        raise UnreadableFile(f"{path}: Frame Time is {told!r:.20}; seconds above 0 are right")
    decimals = len(told.partition(".")[2])
    slack = min(0.5 * 10.0**-decimals, 1e-3 * step) * 1.001
    return rate_from_times(np.array([0.0, step]), 1, slack) or 1 / step
