"""The options that several commands share, spelt once."""

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, TypeAlias

import typer

from kinesphere.errors import KinesphereError

if TYPE_CHECKING:
    from kinesphere.pipeline import Settings

JsonOption: TypeAlias = Annotated[
    bool, typer.Option("--json", help="Print the summary as JSON, for machines.")
]
SetOption: TypeAlias = Annotated[
    list[str] | None,
    typer.Option(
        "--set",
        metavar="STAGE.KEY=VALUE",
        help="Change one setting of one stage; may be given again. "
        "'kinesphere settings' shows them all.",
    ),
]
SettingsOption: TypeAlias = Annotated[
    Path | None,
    typer.Option(
        "--settings", metavar="FILE.toml", help="Change settings by a file; --set wins over it."
    ),
]
SubjectOption: TypeAlias = Annotated[
    str | None,
    typer.Option("--subject", metavar="NAME", help="Which person, where labels carry a prefix."),
]


class BadArgument(KinesphereError):
    """An option or argument of the command line that cannot be meant."""


def settings_from_options(assignments: Sequence[str] | None, file: Path | None) -> "Settings":
    """Return the settings of every stage after ``--settings`` and then ``--set``."""
    from kinesphere.pipeline import changes_from_text, merged, read_settings, settings_from

    changes = merged(
        read_settings(file) if file is not None else {}, changes_from_text(assignments or [])
    )
    return settings_from(changes)


def calibration_from_text(text: str | None) -> tuple[float, float] | None:
    """Return (start, end) in s from ``START:END``.

    Raises
    ------
    BadArgument
        Unless it is two times, the first before the second.
    """
    if text is None:
        return None
    start, colon, end = text.partition(":")
    try:
        span = float(start), float(end)
    except ValueError:
        span = (0.0, 0.0)
    if not colon or not 0 <= span[0] < span[1] < float("inf"):
        raise BadArgument(
            f"--calibration {text!r} is no stretch of time; write START:END in seconds from the "
            "first stored frame, as in 0:60"
        )
    return span
