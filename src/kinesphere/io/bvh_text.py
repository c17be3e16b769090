"""The text of a BVH file: its hierarchy, and its numbers as they stand."""

from pathlib import Path
from typing import NamedTuple

import numpy as np

from kinesphere.data import Array
from kinesphere.errors import UnreadableFile
from kinesphere.io.bvh_hierarchy import BvhNode, nodes_from_lines
from kinesphere.io.tables import parse_table, rate_from_times
from kinesphere.io.text import read_text


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
    nodes = nodes_from_lines(lines[:start], path, warnings)
    hierarchy = "\n".join(lines[:start]) + "\n"
    n_channels = sum(len(node.channels) for node in nodes)
    try:
        values, rate = _motion(lines, start, n_channels, path, warnings)
    except UnreadableFile:
        if motion_needed:
            raise
        values, rate = np.empty((0, n_channels)), np.nan
    return BvhText(nodes, hierarchy, values, rate, tuple(warnings))


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
