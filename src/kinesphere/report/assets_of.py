"""The files that pages are made of."""

from functools import cache
from importlib.resources import files

from jinja2 import Environment, StrictUndefined


@cache
def asset(name: str) -> str:
    """Return the text of one of the room's assets."""
    return (files("kinesphere.report") / "assets" / name).read_text(encoding="utf-8")


@cache
def environment() -> Environment:
    """Return how templates are read: whatever comes from a file is escaped."""
    return Environment(
        autoescape=True, undefined=StrictUndefined, trim_blocks=True, lstrip_blocks=True
    )
