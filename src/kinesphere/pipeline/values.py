"""A setting's value from what a person or a TOML file wrote, by the type the field declares."""

import types
from collections.abc import Sequence
from typing import Any, Literal, Union, get_args, get_origin

from kinesphere.errors import BadSetting

_TRUE = ("true", "yes", "on", "1")
_FALSE = ("false", "no", "off", "0")
_NOTHING = ("none", "null", "")


def value_from(written: Any, annotation: Any, name: str) -> Any:
    """Return ``written`` as ``annotation`` wants it.

    Parameters
    ----------
    written
        Text, as after ``--set``, or a TOML value.
    annotation
        ``bool``, ``int``, ``float``, ``str``, a ``Literal``, a tuple of these, or one of them
        ``| None``.
    name
        What the setting is called in an error: ``axes.method``.

    Raises
    ------
    BadSetting
        If it cannot be read as that type.
    """
    if isinstance(annotation, types.UnionType) or get_origin(annotation) is Union:
        return _optional(written, get_args(annotation), name)
    if get_origin(annotation) is tuple:
        return _several(written, get_args(annotation), name)
    if get_origin(annotation) is Literal:
        annotation = str
    value = _plain(written, annotation)
    if value is None:
        raise BadSetting(f"{name} is {written!r}; it must be {type_as_text(annotation)}")
    return value


def type_as_text(annotation: Any) -> str:
    """Return what a person would call the type of a setting."""
    if isinstance(annotation, types.UnionType) or get_origin(annotation) is Union:
        return " or ".join(type_as_text(a) for a in get_args(annotation))
    if get_origin(annotation) is tuple:
        kinds = [a for a in get_args(annotation) if a is not Ellipsis]
        return "a list of " + type_as_text(kinds[0]).removeprefix("a ") + "s"
    if get_origin(annotation) is Literal:
        return "a name"
    names = {
        bool: "true or false",
        int: "a whole number",
        float: "a number",
        str: "a name",
        type(None): "none",
    }
    return names.get(annotation, str(annotation))


def _plain(written: Any, annotation: Any) -> Any:
    """Return the value, or None where it is not of that type."""
    text = written.strip() if isinstance(written, str) else None
    if annotation is bool:
        if isinstance(written, bool):
            return written
        lowered = (text or "").lower()
        return True if lowered in _TRUE else False if lowered in _FALSE else None
    if isinstance(written, bool):
        return None
    if annotation is str:
        return text
    if annotation in (int, float) and isinstance(written, str | int | float):
        try:
            number = float(written)
            whole = int(text) if text and annotation is int else None
        except (ValueError, OverflowError):
            return None
        if annotation is float:
            return number
        return whole if whole is not None else int(number) if number.is_integer() else None
    return None


def _optional(written: Any, members: Sequence[Any], name: str) -> Any:
    if type(None) in members and isinstance(written, str) and written.lower() in _NOTHING:
        return None
    for member in members:
        if member is type(None):
            continue
        try:
            return value_from(written, member, name)
        except BadSetting:
            continue
    wanted = " or ".join(type_as_text(member) for member in members)
    raise BadSetting(f"{name} is {written!r}; it must be {wanted}")


def _several(written: Any, members: Sequence[Any], name: str) -> tuple[Any, ...]:
    parts = written.split(",") if isinstance(written, str) else written
    if not isinstance(parts, Sequence):
        parts = [parts]
    if len(members) == 2 and members[1] is Ellipsis:
        members = [members[0]] * len(parts)
    if len(parts) != len(members):
        raise BadSetting(f"{name} is {written!r}; it must have {len(members)} values, by commas")
    return tuple(value_from(p, m, name) for p, m in zip(parts, members, strict=True))
