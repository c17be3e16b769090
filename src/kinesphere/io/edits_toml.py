"""Pose edits as TOML, read and written: ``[[edit]]`` after ``[[edit]]``."""

import json
import tomllib
from pathlib import Path

from pydantic import ValidationError

from kinesphere.data.edits import Edit, Edits
from kinesphere.data.validation import first_problem
from kinesphere.errors import UnreadableFile
from kinesphere.io.atomic import replacing
from kinesphere.io.text import read_text


def read_edits(path: str | Path) -> tuple[Edit, ...]:
    """Read pose edits.

    Raises
    ------
    UnreadableFile
        If the file is no TOML or an edit does not mean one thing; it says which and where.
    """
    path = Path(path)
    try:
        found = tomllib.loads(read_text(path))
    except tomllib.TOMLDecodeError as error:
        raise UnreadableFile(f"{path}: no TOML: {error}") from error
    try:
        return Edits.model_validate(found).edit
    except ValidationError as error:
        raise UnreadableFile(
            f'{path}: {first_problem(error)}; an edit reads [[edit]], joint = "left_elbow", '
            "axis = 1, add_deg = 30.0, frames = [100, 200], blend_s = 0.2"
        ) from error


def write_edits(edits: tuple[Edit, ...], path: str | Path) -> None:
    """Write pose edits so that `read_edits` gives them back."""
    parts = []
    for edit in edits:
        told = edit.model_dump(exclude_none=True, exclude_defaults=True)
        # numbers, text and lists of numbers read alike in JSON and TOML
        lines = [f"{key} = {json.dumps(value)}" for key, value in told.items()]
        parts.append("\n".join(["[[edit]]", *lines]))
    with replacing(path) as partial:
        partial.write_text("\n\n".join(parts) + "\n", encoding="utf-8")
