"""History travels with the data: what was done, with which settings, and what was found."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import TypeAlias

from kinesphere import __version__

Json: TypeAlias = bool | int | float | str | list["Json"] | dict[str, "Json"] | None
"""What a finding or a setting may hold: whatever JSON can."""


@dataclass(frozen=True)
class Step:
    """One thing done to the data."""

    name: str
    """The stage or function, e.g. ``"read"``, ``"skeleton"``, ``"axes"``."""
    settings: Mapping[str, Json] = field(default_factory=dict)
    """Every setting in force, defaults included."""
    findings: Mapping[str, Json] = field(default_factory=dict)
    """What was found and how good it is; names end in their unit (``_mm``, ``_deg``, ``_s``)."""
    warnings: tuple[str, ...] = ()
    """What was guessed, overridden or doubtful, each a sentence for a person."""
    version: str = __version__
    """Version of Kinesphere that did it: this one, unless a file says otherwise."""


History: TypeAlias = tuple[Step, ...]
