"""Findings in words: no underscores, numbers with their unit and no digits that mean nothing."""

import math

from kinesphere.data import Json

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
    elif size == 0:
        text = "0"
    else:
        decimals = min(digits - 1 - math.floor(math.log10(size)), 6)
        text = f"{value:.{decimals}f}"
        if "." in text:
            text = text.rstrip("0").rstrip(".") or "0"
    gap = "" if unit in ("°", "%", "") else " "
    return f"{text}{gap}{unit}"


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
