"""CSV of a recording: ``time_s``, then ``LABEL.x_m``, ``LABEL.y_m``, ``LABEL.z_m`` per marker."""

import csv
import io
from collections.abc import Sequence
from pathlib import Path
from typing import NamedTuple

import numpy as np

from kinesphere.data import Array, Recording, Step
from kinesphere.errors import UnreadableFile
from kinesphere.io.atomic import replacing
from kinesphere.io.tables import format_rows, parse_table, rate_from_times
from kinesphere.io.text import read_text

TIME_FORMAT = "%.9f"
TIME_SLACK = 2e-9
"""s; two times printed with nine decimals may be wrong by this together."""
_AXES = (".x_m", ".y_m", ".z_m")


class NamedColumns(NamedTuple):
    """A table whose first row names its columns."""

    names: list[str]
    values: Array
    """(n_rows, n_columns); NaN where blank."""
    lines: list[int]
    """Line number of each row, counted from 1."""


def write_csv(recording: Recording, path: str | Path) -> None:
    """Write marker positions in metres, in the axes the recording's own file had.

    Printed to 1e-9 m; gaps are blank cells.
    """
    in_file = recording.markers @ recording.world_from_file
    names = ["time_s"] + [label + axis for label in recording.labels for axis in _AXES]
    columns = (recording.times[:, None], in_file.reshape(recording.n_frames, -1))
    write_columns(path, names, columns, (TIME_FORMAT, "%.9f"))


def read_csv(path: str | Path) -> Recording:
    """Read a recording from a CSV file with the columns that ``write_csv`` gives it.

    Raises
    ------
    UnreadableFile
        If the columns are others, or as ``parse_table`` says.
    """
    path = Path(path)
    table = read_columns(path)
    labels = tuple(name.removesuffix(_AXES[0]) for name in table.names[1::3])
    wanted = ["time_s"] + [label + axis for label in labels for axis in _AXES]
    if table.names != wanted or not labels:
        odd = next((f for f, w in zip(table.names, wanted, strict=False) if f != w), "nothing more")
        raise UnreadableFile(
            f"{path}: line 1 holds {odd!r:.60}; time_s, then LABEL.x_m, LABEL.y_m, LABEL.z_m for "
            f"each marker were expected"
        )
    if len(set(labels)) < len(labels):
        raise UnreadableFile(f"{path}: line 1 names a marker more than once")
    rate, warnings = rate_of(table, path)
    markers = table.values[:, 1:].reshape(len(table.values), -1, 3)
    step = Step(
        name="read",
        settings={"format": "csv", "file": path.name},
        findings={"n_frames": len(markers), "n_markers": len(labels), "rate_hz": rate, "unit": "m"},
        warnings=warnings,
    )
    return Recording(markers=markers, labels=labels, rate=rate, history=(step,))


def write_columns(
    path: str | Path, names: list[str], columns: Sequence[Array], formats: Sequence[str]
) -> None:
    """Write a CSV file: a row of names, then numbers with NaN as blank cells."""
    head = io.StringIO()
    csv.writer(head, lineterminator="\n").writerow(names)
    with replacing(path) as temporary:
        text = head.getvalue() + format_rows(columns, formats, ",")
        temporary.write_text(text, encoding="utf-8", newline="\n")


def read_columns(path: Path) -> NamedColumns:
    """Read a CSV file of numbers whose first row names the columns.

    Raises
    ------
    UnreadableFile
        As ``parse_table`` does, and if there is no row of numbers.
    """
    first, _, rest = read_text(path).partition("\n")
    names = [name.strip() for name in next(csv.reader([first]))]
    table = parse_table(rest.split("\n"), 2, len(names), path, ",")
    if not len(table.values):
        raise UnreadableFile(f"{path}: no rows after the names of the columns")
    return NamedColumns(names, *table)


def rate_of(table: NamedColumns, path: Path) -> tuple[float, tuple[str, ...]]:
    """Return the frame rate in Hz by the first column, the time in s, and warnings.

    Raises
    ------
    UnreadableFile
        If the times do not rise evenly.
    """
    times = table.values[:, 0]
    if len(times) == 1:
        return 1.0, ("one frame tells no frame rate; 1 Hz is taken",)
    rate = rate_from_times(times, len(times) - 1, TIME_SLACK)
    if rate is None:
        raise UnreadableFile(f"{path}: time_s does not rise from line {table.lines[0]} to the last")
    uneven = np.abs(times - times[0] - np.arange(len(times)) / rate)
    if not uneven.max() < 0.5 / rate:  # NaN is uneven, too
        line = table.lines[int(np.argmax(~(uneven < 0.5 / rate)))]
        raise UnreadableFile(f"{path}: time_s is uneven at line {line}; rows 1/{rate:g} s apart")
    return rate, ()
