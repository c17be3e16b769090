"""Tables of numbers in text: rows in, one array out, every blank a NaN."""

from collections.abc import Iterable
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from kinesphere.data import Array
from kinesphere.errors import UnreadableFile


class Table(NamedTuple):
    """Numbers, and where each row stood."""

    values: Array
    """(n_rows, n_columns); NaN where a cell is blank, missing or says NaN."""
    lines: list[int]
    """Line number of each row, counted from 1."""


def parse_table(
    lines: list[str], first_line: int, n_columns: int, path: Path, separator: str | None
) -> Table:
    r"""Parse rows of numbers; blank lines are passed over.

    A blank cell, a missing cell at the end of a row and ``NaN`` in any case are NaN.

    Parameters
    ----------
    lines
        As split at ``\n``; a last one that is not empty had no line end.
    first_line
        Line number of ``lines[0]``, counted from 1.
    separator
        Between cells; None for any run of blanks, where a missing cell cannot be told.

    Raises
    ------
    UnreadableFile
        Naming the line: a cell that is no number or infinite, more cells than columns, a last row
        that breaks off.
    """
    full = [(i, line) for i, line in enumerate(lines) if line and not line.isspace()]
    values = np.empty((len(full), n_columns))
    for row, (i, line) in enumerate(full):
        cells = line.split(separator)
        if len(cells) != n_columns:
            where = f"{path}: line {first_line + i}"
            cut_off = i == len(lines) - 1
            cells = _fitted(cells, n_columns, where, cut_off=cut_off, blanks=separator is None)
        try:
            values[row] = list(map(float, cells))
        except ValueError:
            values[row] = [_number(c, f"{path}: line {first_line + i}") for c in cells]
    numbers = [first_line + i for i, _ in full]
    if (bad := np.isinf(values).any(axis=1)).any():
        line_number = numbers[int(bad.argmax())]
        raise UnreadableFile(f"{path}: line {line_number} holds an infinite number")
    return Table(values, numbers)


def format_rows(
    columns: Iterable[NDArray[Any]], formats: Iterable[str], separator: str, gap: str = ""
) -> str:
    """Return rows of text, one line each.

    Parameters
    ----------
    columns
        Each (n_rows, k).
    formats
        printf format of the numbers of each block of columns.
    gap
        What stands for NaN.
    """
    blocks = list(columns)
    form = separator.join(
        one for block, one in zip(blocks, formats, strict=True) for _ in range(block.shape[1])
    )
    rows = [form % tuple(row.tolist()) for row in np.hstack(blocks)]
    return "".join(f"{row}\n" for row in rows).replace("nan", gap)


def rate_from_times(times: Array, n_steps: int, slack: float) -> float | None:
    """Return the roundest rate in Hz that evenly spaced times allow, or None.

    Parameters
    ----------
    times : (n_frames,) s
        As printed, each rounded by up to ``slack`` / 2.
    n_steps
        How many frames lie from the first time to the last.
    slack
        s, by how much first and last may be wrong together.

    Returns
    -------
    float or None
        None where first or last time is unknown, or they do not rise.
    """
    span = float(times[-1] - times[0])
    if not span > slack:
        return None
    for decimals in range(9):
        rate = round(n_steps / span, decimals)
        if rate > 0 and abs(n_steps / rate - span) <= slack:
            return rate
    return n_steps / span


def _fitted(
    cells: list[str], n_columns: int, where: str, *, cut_off: bool, blanks: bool
) -> list[str]:
    found = len(cells)
    if found < n_columns and not blanks and not cut_off:
        return cells + [""] * (n_columns - found)
    if found > n_columns and not "".join(cells[n_columns:]).strip():
        return cells[:n_columns]
    said = f"{where} has {found} cells, the header names {n_columns} columns"
    if found < n_columns and cut_off:
        raise UnreadableFile(f"{said}; the file breaks off there")
    if found < n_columns:
        raise UnreadableFile(f"{said}; gaps need tabs between the cells, or NaN")
    raise UnreadableFile(said)


def _number(cell: str, where: str) -> float:
    cell = cell.strip()
    if not cell:
        return np.nan
    try:
        return float(cell)
    except ValueError:
        raise UnreadableFile(f"{where} holds {cell!r:.40} where a number was expected") from None
