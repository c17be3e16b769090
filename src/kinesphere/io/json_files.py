"""JSON files: readable, without NaN, and every way they can be damaged said in one line."""

import json
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np

from kinesphere.errors import UnreadableFile
from kinesphere.io.atomic import replacing
from kinesphere.io.text import read_text


def read_json(path: Path, *, nan: bool = False) -> Any:
    """Return what a JSON file holds.

    Parameters
    ----------
    nan
        Whether NaN and Infinity are let through, as other programs write them.

    Raises
    ------
    UnreadableFile
        Naming line and column of what is no JSON; NaN and Infinity are none, unless let through.
    """
    text = read_text(path)
    try:
        return json.loads(text, parse_constant=float if nan else _refuse)
    except json.JSONDecodeError as error:
        raise UnreadableFile(
            f"{path}: line {error.lineno}, column {error.colno} is no JSON ({error.msg})"
        ) from None
    except (ValueError, RecursionError) as error:
        raise UnreadableFile(f"{path} is no JSON ({error})") from None


def write_json(content: Any, path: str | Path) -> None:
    """Write JSON, indented; numbers are printed so that reading gives the same bits."""
    with replacing(path) as temporary:
        temporary.write_text(json_text(content), encoding="utf-8", newline="\n")


def json_text(content: Any) -> str:
    """Return JSON with lists of numbers on one line each; NaN and infinity become null."""
    return _indented(plain(content), "") + "\n"


def plain(value: Any) -> Any:
    """Return ``value`` as JSON has it: arrays as lists, NaN and infinity as None."""
    if isinstance(value, np.ndarray | np.generic):
        value = value.tolist()
    if isinstance(value, Mapping):
        return {str(key): plain(item) for key, item in value.items()}
    if isinstance(value, list | tuple):
        return [plain(item) for item in value]
    if isinstance(value, float) and not np.isfinite(value):
        return None
    return value


def _indented(value: Any, margin: str) -> str:
    """``json.dumps`` puts each number of a matrix on a line of its own; this puts rows there."""
    deeper = margin + "  "
    if isinstance(value, dict) and value:
        inner = [f"{deeper}{_dumps(k)}: {_indented(v, deeper)}" for k, v in value.items()]
        return "{\n" + ",\n".join(inner) + f"\n{margin}}}"
    if isinstance(value, list) and any(isinstance(item, list | dict) for item in value):
        inner = [deeper + _indented(item, deeper) for item in value]
        return "[\n" + ",\n".join(inner) + f"\n{margin}]"
    return _dumps(value)


def _dumps(value: Any) -> str:
    return json.dumps(value, ensure_ascii=False, allow_nan=False)


def _refuse(constant: str) -> None:
    raise ValueError(f"it holds {constant}; null stands for what is not known")
