"""Settings of a stage: one frozen dataclass whose fields say unit, range and source."""

from collections.abc import Sequence
from dataclasses import Field, field, fields
from typing import Any

from kinesphere.data.history import Json
from kinesphere.errors import BadSetting


def setting(
    default: Any,
    doc: str,
    *,
    unit: str = "",
    low: float | None = None,
    high: float | None = None,
    choices: Sequence[str] = (),
    source: str = "",
) -> Any:
    """Declare one field of a settings dataclass.

    Parameters
    ----------
    default
        Value used when nobody says otherwise; its type is the setting's type.
    doc
        One line for a person.
    unit
        As shown to people: ``"s"``, ``"deg"``, ``"mm"``; empty for a pure number or a name.
    low, high
        Closed range of a number.
    choices
        The names a method may have.
    source
        Paper and section, DOI, or the measurement that chose the default.
    """
    return field(
        default=default,
        metadata={
            "doc": doc,
            "unit": unit,
            "low": low,
            "high": high,
            "choices": tuple(choices),
            "source": source,
        },
    )


def check_settings(settings: Any) -> None:
    """Check every field of a settings dataclass against its range or choices.

    Raises
    ------
    BadSetting
        Naming the setting, the value found and what would be right.
    """
    for f in fields(settings):
        check_setting(f, getattr(settings, f.name))


def check_setting(f: Field[Any], value: Any) -> None:
    """Check one value against what its field allows; raises BadSetting as check_settings does."""
    meta = f.metadata
    if meta["choices"] and value not in meta["choices"]:
        raise BadSetting(f"{f.name} is {value!r}; known are {', '.join(meta['choices'])}")
    if value is None:
        return
    low, high, unit = meta["low"], meta["high"], meta["unit"]
    if low is not None and not value >= low:  # also catches NaN
        raise BadSetting(f"{f.name} is {value}; it must be at least {low} {unit}".rstrip())
    if high is not None and not value <= high:
        raise BadSetting(f"{f.name} is {value}; it must be at most {high} {unit}".rstrip())


def settings_as_json(settings: Any) -> dict[str, Json]:
    """Return the settings as a step of the history records them."""
    return {f.name: getattr(settings, f.name) for f in fields(settings)}
