"""Findings in words: no underscores, numbers with their unit and no digits that mean nothing."""

import math
from collections.abc import Sequence

import numpy as np

from kinesphere.data import Array, Json

_UNITS = {
    "mm": "mm",
    "cm": "cm",
    "m": "m",
    "deg": "°",
    "rad": "rad",
    "s": "s",
    "hz": "Hz",
    "percent": "%",
    "kb": "kB",
}
_LISTED = 6
_LEAST = 0.001
"""Whatever the unit, a smaller number is called smaller than this."""


def counted(n: int, noun: str) -> str:
    """Return how many there are: ``1 frame``, ``1,854 frames``."""
    return f"{n:,} {noun}" if n == 1 else f"{n:,} {noun}s"


def finding_in_words(name: str, value: Json, listed: int = _LISTED) -> tuple[str, str]:
    """Return what a person reads for one finding: its name and its value with the unit.

    Parameters
    ----------
    name
        As in the history: ``residual_rms_mm``.
    value
        Anything JSON holds.
    listed
        How many entries of a list or table are written out before "and n more".
    """
    stem, _, unit = name.rpartition("_")
    if stem and unit.lower() in _UNITS:
        return stem.replace("_", " "), _value(value, _UNITS[unit.lower()], listed)
    return name.replace("_", " "), _value(value, "", listed)


def number_in_words(value: float | None, unit: str = "", digits: int = 3) -> str:
    """Return a number with about ``digits`` significant figures and its unit; – for no number."""
    if value is None or not math.isfinite(value):
        return "–"
    size = abs(value)
    if isinstance(value, int) or (size >= 10 ** (digits - 1)):
        text = f"{value:.0f}"
    elif size < _LEAST:
        text = "0" if size == 0 else f"< {_LEAST}"
    else:
        decimals = min(digits - 1 - math.floor(math.log10(size)), 3)
        text = f"{value:.{decimals}f}"
        if "." in text:
            text = text.rstrip("0").rstrip(".")
    gap = "" if unit in ("°", "%", "") else " "
    return f"{text}{gap}{unit}"


def in_words(name: str) -> str:
    """Return a name as a person writes it: ``left_upper_arm`` → ``left upper arm``."""
    return name.replace("_", " ")


def millimetres(metres: float) -> str:
    """Return a length in metres as millimetres, with their unit."""
    return number_in_words(metres * 1e3, "mm")


def degrees_span(degrees: Array) -> str:
    """Return 5 % … 95 % of what is no NaN, (n_frames,) in degrees."""
    known = degrees[np.isfinite(degrees)]
    if not len(known):
        return "–"
    low, high = (float(v) for v in np.percentile(known, [5, 95]))
    return f"{round(low)}° … {round(high)}°"  # round() knows no -0


def unique(sentences: Sequence[str]) -> list[str]:
    """Return sentences once each, in the order they came up."""
    return list(dict.fromkeys(sentences))


def _value(value: Json, unit: str, listed: int) -> str:
    if isinstance(value, bool):
        return "yes" if value else "no"
    if value is None:
        return "–"
    if isinstance(value, int | float):
        return number_in_words(value, unit)
    if isinstance(value, str):
        return value
    if isinstance(value, dict):
        parts = [f"{key.replace('_', ' ')} {_value(v, unit, listed)}" for key, v in value.items()]
    else:
        parts = [_value(v, unit, listed) for v in value]
    if not parts:
        return "none"
    more = f" and {len(parts) - listed} more" if len(parts) > listed else ""
    return ", ".join(parts[:listed]) + more
