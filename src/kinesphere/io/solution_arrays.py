"""``solution.npz``: a whole solution, to the last bit, without pickle.

Arrays with a frame axis are entries of their own, named by their way (``motion.rotations``).
Everything else (labels, history, the skeleton with its small arrays) is one JSON text in the
entry ``tree``. How long stages took is not among it: what the same recording gives is the same
file, to the last bit.
"""

import json
import zipfile
import zlib
from collections.abc import Mapping
from dataclasses import fields, is_dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np

from kinesphere.data import (
    Analog,
    Event,
    Joint,
    Limb,
    Motion,
    Output,
    Parameters,
    Recording,
    Skeleton,
    Solution,
    Step,
    Surface,
)
from kinesphere.errors import KinesphereError, UnreadableFile
from kinesphere.io.atomic import replacing
from kinesphere.io.json_files import plain

SOLUTION_FORMAT = "kinesphere-solution-1"
_KNOWN = {
    kind.__name__: kind
    for kind in (
        *(Analog, Event, Joint, Limb, Motion, Output),
        *(Parameters, Recording, Skeleton, Solution, Step, Surface),
    )
}
"""Nothing else is ever built from a file."""

_Arrays = dict[str, np.ndarray[Any, Any]]


def write_solution_arrays(solution: Solution, path: str | Path) -> None:
    """Write ``solution.npz``. Needs every value in ``Recording.details`` to be plain."""
    arrays: _Arrays = {}
    timeless = replace(solution, seconds={})
    content = {"format": SOLUTION_FORMAT, "solution": _pack(timeless, "", arrays)}
    tree = json.dumps(content, ensure_ascii=False, allow_nan=False).encode()
    arrays["tree"] = np.frombuffer(tree, dtype=np.uint8)
    # for those who look into the file without Kinesphere
    arrays["labels"] = np.array(solution.recording.labels, dtype=np.str_)
    arrays["limbs"] = np.array(solution.skeleton.limb_names, dtype=np.str_)
    arrays["joints"] = np.array(solution.skeleton.joint_names, dtype=np.str_)
    with replacing(path) as temporary, zipfile.ZipFile(temporary, "w") as file:
        for name, array in arrays.items():
            with file.open(f"{name}.npy", "w", force_zip64=True) as entry:
                np.lib.format.write_array(entry, array, allow_pickle=False)


def read_solution_arrays(path: Path) -> Solution:
    """Read ``solution.npz``.

    Raises
    ------
    UnreadableFile
        If the file is missing, damaged, or no solution.
    """
    try:
        with path.open("rb") as file, np.load(file, allow_pickle=False) as entries:
            content = json.loads(bytes(entries["tree"]))
            if content["format"] != SOLUTION_FORMAT:
                raise UnreadableFile(
                    f"{path} has format {content['format']!r}; {SOLUTION_FORMAT!r} was expected"
                )
            solution = _unpack(content["solution"], entries)
    except UnreadableFile:
        raise
    except FileNotFoundError:
        raise UnreadableFile(f"{path}: there is no such file") from None
    except (
        *(OSError, EOFError, zipfile.BadZipFile, zlib.error, KinesphereError, RecursionError),
        *(ValueError, KeyError, TypeError, AttributeError, NotImplementedError),
    ) as error:
        raise UnreadableFile(f"{path} is damaged ({error or type(error).__name__})") from None
    if not isinstance(solution, Solution):
        raise UnreadableFile(f"{path} holds a {type(solution).__name__}, no solution")
    return solution


def _pack(value: Any, way: str, arrays: _Arrays | None) -> Any:
    """Return ``value`` as JSON; arrays are put aside under their way, or written out if None."""
    if is_dataclass(value) and type(value).__name__ in _KNOWN:
        inside = None if isinstance(value, Skeleton) else arrays
        packed = {
            f.name: _pack(getattr(value, f.name), f"{way}.{f.name}".lstrip("."), inside)
            for f in fields(value)
        }
        return {"$": type(value).__name__, **packed}
    if isinstance(value, np.ndarray):
        if arrays is None:
            return {"$values": plain(value), "shape": list(value.shape)}
        arrays[way] = value
        return {"$array": way}
    if isinstance(value, np.generic):
        value = value.item()
    if isinstance(value, Mapping):
        return {"$map": {str(k): _pack(v, f"{way}.{k}", arrays) for k, v in value.items()}}
    if isinstance(value, tuple):
        return {"$tuple": [_pack(v, f"{way}.{i}", arrays) for i, v in enumerate(value)]}
    if isinstance(value, list):
        return [_pack(v, f"{way}.{i}", arrays) for i, v in enumerate(value)]
    if isinstance(value, float) and not np.isfinite(value):
        return {"$float": repr(value)}
    if value is None or isinstance(value, bool | int | float | str):
        return value
    raise TypeError(f"{way} holds a {type(value).__name__}, which solution.npz cannot")


def _unpack(packed: Any, entries: Mapping[str, Any]) -> Any:
    if isinstance(packed, list):
        return [_unpack(item, entries) for item in packed]
    if not isinstance(packed, dict):
        return packed
    if "$" in packed:
        kind = _KNOWN[packed["$"]]
        return kind(**{k: _unpack(v, entries) for k, v in packed.items() if k != "$"})
    if "$array" in packed:
        return entries[packed["$array"]]
    if "$values" in packed:
        return np.array(packed["$values"], dtype=np.float64).reshape(packed["shape"])
    if "$map" in packed:
        return {k: _unpack(v, entries) for k, v in packed["$map"].items()}
    if "$tuple" in packed:
        return tuple(_unpack(item, entries) for item in packed["$tuple"])
    return float(packed["$float"])
