"""TRC, the marker format of OpenSim and Motion Analysis: five lines of header, a row a frame.

In: every spelling of a gap, tabs or runs of blanks, any line end. Out: millimetres with six
decimals, gaps as NaN.
"""

import re
from pathlib import Path
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from kinesphere.data import Array, Recording, Step
from kinesphere.errors import BadSetting, UnreadableFile
from kinesphere.io.atomic import replacing
from kinesphere.io.tables import Table, format_rows, parse_table, rate_from_times
from kinesphere.io.text import read_text
from kinesphere.io.units import length_unit, metres_from_unit

_FIELDS = (
    "DataRate",
    "CameraRate",
    "NumFrames",
    "NumMarkers",
    "Units",
    "OrigDataRate",
    "OrigDataStartFrame",
    "OrigNumFrames",
)
RATE_SLACK = 0.01
"""Share by which the time column may contradict the header's rate."""
TIME_SLACK = 1e-3
"""s; times are often printed with three decimals."""
MOST_MISSING = 10
"""Rows that may be missing for each row there is; more is a damaged frame number."""


class _Header(NamedTuple):
    fields: dict[str, str]
    labels: tuple[str, ...]
    n_lines: int
    separator: str | None


def read_trc(path: str | Path) -> Recording:
    """Read a TRC file.

    A point with a coordinate missing is not seen. Frame numbers that jump leave unseen frames.

    Returns
    -------
    Recording
        In metres, in the file's axes. ``details["trc"]`` keeps the unit and the first time.

    Raises
    ------
    UnreadableFile
        Saying what was found, in which line, and what would be right.
    """
    path = Path(path)
    lines = read_text(path).split("\n")
    header = _read_header(lines, path)
    warnings: list[str] = []
    n_columns = 2 + 3 * len(header.labels)
    table = parse_table(
        lines[header.n_lines :], header.n_lines + 1, n_columns, path, header.separator
    )
    if not len(table.values):
        raise UnreadableFile(f"{path}: no frames after the header")
    n_told = header.fields.get("NumFrames", "")
    if _count(n_told) != len(table.values):
        warnings.append(f"the header says {n_told or 'no'} frames, there are {len(table.values)}")

    rows, first_frame = _placed(table, path, warnings)
    rate = _rate(header.fields.get("DataRate", ""), table.values[:, 1], rows, path, warnings)
    markers = np.full((int(rows[-1]) + 1, len(header.labels), 3), np.nan)
    markers[rows] = table.values[:, 2:].reshape(len(rows), -1, 3)
    seen = np.isfinite(markers)
    partly = seen.any(axis=2) & ~seen.all(axis=2)
    if partly.any():
        markers[partly] = np.nan
        warnings.append(
            f"{partly.sum()} points had only some of their coordinates; they count as not seen"
        )
    unit, metres, doubts = length_unit(header.fields.get("Units", ""), markers)
    warnings += doubts
    return Recording(
        markers=markers * metres,
        labels=header.labels,
        rate=rate,
        first_frame=first_frame,
        details={"trc": {"unit": unit, "first_time_s": float(np.nan_to_num(table.values[0, 1]))}},
        history=(
            Step(
                name="read",
                settings={"format": "trc", "file": path.name},
                findings={
                    "n_frames": len(markers),
                    "n_markers": len(header.labels),
                    "rate_hz": rate,
                    "unit": unit,
                    "first_frame": first_frame,
                },
                warnings=tuple(warnings),
            ),
        ),
    )


def write_trc(recording: Recording, path: str | Path, unit: str = "mm") -> None:
    """Write a TRC file in the axes the recording's own file had.

    Coordinates are printed to 1e-6 mm (at least), gaps as NaN: OpenSim 4.6 refuses a row whose
    last cell is blank. Outputs, analog channels and events have no place in a TRC file.

    Parameters
    ----------
    unit
        ``"mm"``, ``"m"``, ``"cm"``…: as ``metres_from_unit`` knows them.

    Raises
    ------
    BadSetting
        If the unit is unknown.
    """
    metres = metres_from_unit(unit)
    if metres is None:
        raise BadSetting(f"unit {unit!r} is unknown; mm, cm, m, in and ft are some that are known")
    path = Path(path)
    in_file = recording.markers @ recording.world_from_file / metres
    decimals = max(0, int(np.ceil(np.log10(metres) + 9)))  # 1e-9 m
    kept = recording.details.get("trc", {})
    times = recording.times + kept.get("first_time_s", 0.0)
    frames = recording.first_frame + np.arange(recording.n_frames)
    labels = [re.sub(r"\s", " ", label) for label in recording.labels]
    n, m, rate = recording.n_frames, recording.n_markers, f"{recording.rate:.10g}"
    head = [
        ["PathFileType", "4", "(X/Y/Z)", path.name],
        list(_FIELDS),
        [rate, rate, str(n), str(m), unit, rate, str(recording.first_frame), str(n)],
        ["Frame#", "Time"] + [cell for label in labels for cell in (label, "", "")],
        ["", ""] + [f"{axis}{i}" for i in range(1, m + 1) for axis in "XYZ"],
        [],
    ]
    body = format_rows(
        (frames[:, None], times[:, None], in_file.reshape(n, -1)),
        ("%d", "%.9f", f"%.{decimals}f"),
        "\t",
        gap="NaN",
    )
    with replacing(path) as temporary:
        text = "".join("\t".join(row) + "\n" for row in head) + body
        temporary.write_text(text, encoding="utf-8", newline="\n")


def _read_header(lines: list[str], path: Path) -> _Header:
    if not lines[0].lstrip().startswith("PathFileType"):
        raise UnreadableFile(
            f"{path}: line 1 starts with {lines[0][:20]!r}; a TRC file starts with PathFileType"
        )
    if len(lines) < 5:
        raise UnreadableFile(f"{path}: the file breaks off in line {len(lines)} of the header")
    names, values = _cells(lines[1]), _cells(lines[2])
    fields = dict(zip(names, values, strict=False))
    if "NumMarkers" not in fields:
        raise UnreadableFile(f"{path}: lines 2 and 3 of the header name no NumMarkers")
    first, *rest = _cells(lines[3])
    if not first.lower().startswith("frame") or not rest:
        raise UnreadableFile(
            f"{path}: line 4 starts with {lines[3][:20]!r}; Frame#, Time and labels were expected"
        )
    labels = [cell for cell in rest[1:] if cell]
    n_told = _count(fields["NumMarkers"])
    if n_told is None:
        raise UnreadableFile(
            f"{path}: line 3 gives {fields['NumMarkers']!r} for NumMarkers; a count was expected"
        )
    if n_told != len(labels) and "\t" not in lines[3]:
        labels = lines[3].split()[2:]  # labels a single blank apart
    if n_told != len(labels):
        raise UnreadableFile(
            f"{path}: line 4 holds {len(labels)} labels, the header says {n_told} markers"
        )
    if twice := sorted({label for label in labels if labels.count(label) > 1}):
        raise UnreadableFile(f"{path}: line 4 names {', '.join(twice)} more than once")
    after = 4 if re.match(r"\s*[-+.\d]", lines[4]) else 5  # the line X1 Y1 Z1… may be missing
    first = next((line for line in lines[after:] if line.strip()), "")
    return _Header(fields, tuple(labels), after, "\t" if "\t" in first.strip() else None)


def _cells(line: str) -> list[str]:
    """Return the cells of a header line: between tabs, or else between runs of two blanks."""
    cells = line.rstrip().split("\t") if "\t" in line.strip() else re.split(r"\s{2,}", line.strip())
    if len(cells) < 3:
        cells = line.split()
    return [cell.strip() for cell in cells]


def _count(told: str) -> int | None:
    """Return the whole number that ``told`` is, even if it is written as 41.00."""
    try:
        return int(float(told))
    except (ValueError, OverflowError):
        return None


def _placed(table: Table, path: Path, warnings: list[str]) -> tuple[NDArray[np.intp], int]:
    """Return which stored frame each row is, and the number of the first."""
    frames = table.values[:, 0]
    if (odd := frames != np.round(frames)).any():  # NaN is odd, too
        raise UnreadableFile(
            f"{path}: line {table.lines[int(odd.argmax())]} does not start with a frame number"
        )
    steps = np.diff(frames)
    if (back := steps <= 0).any():
        at = int(back.argmax())
        raise UnreadableFile(
            f"{path}: line {table.lines[at + 1]} is frame {frames[at + 1]:g} after frame "
            f"{frames[at]:g}; frame numbers must rise"
        )
    step = steps.min() if len(steps) else 1.0  # decimated files count 1, 11, 21…
    rows = (frames - frames[0]) / step
    if (rows != np.round(rows)).any() or rows[-1] > MOST_MISSING * len(rows):
        raise UnreadableFile(
            f"{path}: {len(rows)} frame numbers jump unevenly between {frames[0]:.0f} and "
            f"{frames[-1]:.0f}"
        )
    if missing := int(rows[-1]) + 1 - len(rows):
        warnings.append(f"{missing} frames are missing from the file; they count as not seen")
    return rows.astype(np.intp), int(frames[0])


def _rate(
    told: str, times: Array, rows: NDArray[np.intp], path: Path, warnings: list[str]
) -> float:
    """Return the frame rate in Hz: the header's, unless the time column contradicts it."""
    try:
        rate = float(told)
    except ValueError:
        rate = np.nan
    known = rate > 0 and np.isfinite(rate)
    n, span = int(rows[-1]), float(times[-1] - times[0])
    by_times = rate_from_times(times, n, TIME_SLACK)
    if by_times is not None and (
        not known or abs(span - n / rate) > TIME_SLACK + RATE_SLACK * n / rate
    ):
        warnings.append(
            f"the header's data rate is {told or 'missing'}, the time column says "
            f"{by_times:g} Hz; the time column counts"
        )
        rate, known = by_times, True
    if not known:
        raise UnreadableFile(
            f"{path}: line 3 gives {told!r} for DataRate and the time column does not help; "
            f"a positive number of Hz was expected"
        )
    uneven = np.abs(times - times[0] - rows / rate)
    if by_times is not None and np.nanmax(uneven) > 0.5 / rate + TIME_SLACK:
        warnings.append(
            f"the time column is uneven, by up to {np.nanmax(uneven):.3f} s; frames are taken as "
            f"1/{rate:g} s apart"
        )
    return rate
