"""The two halves of a glTF file: what its JSON says, and the bytes it points into.

Format: Khronos glTF 2.0 specification, sections 3.6 (binary data), 4.4 (GLB) and 5 (properties).
"""

import base64
import json
import struct
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from kinesphere.data import Array
from kinesphere.errors import BadRecording
from kinesphere.io.atomic import replacing

VERTICES, INDICES = 34962, 34963
"""What a part of the buffer is for: ``ARRAY_BUFFER``, ``ELEMENT_ARRAY_BUFFER``."""
_COMPONENTS = {"float32": 5126, "uint32": 5125, "uint16": 5123, "uint8": 5121}
_TYPES = {(): "SCALAR", (2,): "VEC2", (3,): "VEC3", (4,): "VEC4", (4, 4): "MAT4"}
_MAGIC, _VERSION, _JSON, _BIN = 0x46546C67, 2, 0x4E4F534A, 0x004E4942
_LARGEST = 2**32 - 1  # bytes; GLB counts in 32 bits


class Document:
    """A glTF file while it is put together."""

    def __init__(self, asset: dict[str, Any]) -> None:
        self.json: dict[str, Any] = {"asset": asset}
        self._bytes: list[bytes] = []
        self._size = 0

    def add(self, kind: str, content: dict[str, Any]) -> int:
        """Append to one of the lists (``nodes``, ``meshes``…); return its index there."""
        entries: list[dict[str, Any]] = self.json.setdefault(kind, [])
        entries.append(content)
        return len(entries) - 1

    def array(
        self, values: NDArray[Any], target: int | None = None, *, bounds: bool = False
    ) -> int:
        """Store an array; return the index of its accessor.

        Parameters
        ----------
        values : (n, ...)
            float32, or unsigned of 8, 16 or 32 bits; matrices column by column.
        target
            ``VERTICES`` or ``INDICES``, for what a mesh points at.
        bounds
            Whether to say the least and the largest of each component.
        """
        content = np.ascontiguousarray(values).tobytes()
        view: dict[str, Any] = {
            "buffer": 0,
            "byteOffset": self._size,
            "byteLength": len(content),
        }
        if target is not None:
            view["target"] = target
        accessor: dict[str, Any] = {
            "bufferView": self.add("bufferViews", view),
            "componentType": _COMPONENTS[values.dtype.name],
            "count": len(values),
            "type": _TYPES[values.shape[1:]],
        }
        if bounds:
            accessor["min"] = np.atleast_1d(values.min(axis=0)).tolist()
            accessor["max"] = np.atleast_1d(values.max(axis=0)).tolist()
        padding = -len(content) % 4
        self._bytes += [content, b"\0" * padding]
        self._size += len(content) + padding
        return self.add("accessors", accessor)

    def write(self, path: str | Path) -> None:
        """Write ``.gltf`` (text, the bytes inside as base64) or else GLB; whole or not at all."""
        binary = b"".join(self._bytes)
        buffer: dict[str, Any] = {"byteLength": len(binary)}
        text = Path(path).suffix.lower() == ".gltf"
        if text and binary:
            coded = base64.b64encode(binary).decode("ascii")
            buffer["uri"] = f"data:application/octet-stream;base64,{coded}"
        tree = {**self.json, **({"buffers": [buffer]} if binary else {})}
        said = json.dumps(tree, ensure_ascii=False, allow_nan=False, separators=(",", ":")).encode()
        with replacing(path) as temporary:
            temporary.write_bytes(said if text else _glb(said, binary, path))


def _glb(said: bytes, binary: bytes, path: str | Path) -> bytes:
    said += b" " * (-len(said) % 4)
    chunks = struct.pack("<II", len(said), _JSON) + said
    if binary:
        chunks += struct.pack("<II", len(binary), _BIN) + binary
    size = 12 + len(chunks)
    if size > _LARGEST:
        raise BadRecording(f"{path}: {size:,} bytes are more than a GLB file can hold (4 GiB)")
    return struct.pack("<III", _MAGIC, _VERSION, size) + chunks


def float32(values: Array) -> NDArray[np.float32]:
    """Return numbers as glTF holds them."""
    return values.astype(np.float32)
