"""Which limb is which part of a figure, said by a person: ``left_thigh = "Bein_L"`` in TOML."""

import tomllib
from pathlib import Path

from kinesphere.data.figure import PARTS
from kinesphere.errors import UnreadableFile
from kinesphere.io.text import read_text

TABLES = ("rig", "source")


def read_parts(path: str | Path) -> dict[str, dict[str, str]]:
    """Read part → name of the limb for the rig and for the source.

    Raises
    ------
    UnreadableFile
        If the file is no TOML, or names a table, a part or a limb that cannot be.
    """
    path = Path(path)
    try:
        found = tomllib.loads(read_text(path))
    except tomllib.TOMLDecodeError as error:
        raise UnreadableFile(f"{path}: no TOML: {error}") from error
    if odd := sorted(set(found) - set(TABLES)):
        raise UnreadableFile(f"{path} holds {odd[0]!r:.40}; the tables are [rig] and [source]")
    for table, parts in found.items():
        if not isinstance(parts, dict):
            raise UnreadableFile(f"{path}: {table} is no table; write [{table}]")
        for part, limb in parts.items():
            if part not in PARTS:
                known = ", ".join(PARTS)
                raise UnreadableFile(f"{path}: {part!r:.40} is no part; they are {known}")
            if not isinstance(limb, str):
                raise UnreadableFile(f"{path}: {part} is {limb!r:.40}; a limb's name is text")
    return {table: dict(found.get(table, {})) for table in TABLES}
