"""glTF files as they come: the JSON, and arrays out of its buffers.

Format: Khronos glTF 2.0 specification, sections 3.6 (binary data) and 4.4 (GLB).
"""

import base64
import json
import struct
from pathlib import Path
from typing import Any
from urllib.parse import unquote

import numpy as np
from numpy.typing import NDArray

from kinesphere.data import Array
from kinesphere.errors import UnreadableFile
from kinesphere.io.registry import read_bytes

_TYPES = {"SCALAR": (), "VEC2": (2,), "VEC3": (3,), "VEC4": (4,), "MAT4": (4, 4)}
_COMPONENTS = {5120: "i1", 5121: "u1", 5122: "<i2", 5123: "<u2", 5125: "<u4", 5126: "<f4"}
_WHOLE = {"i1": 127.0, "u1": 255.0, "<i2": 32767.0, "<u2": 65535.0}
"""What stands for 1 in normalised integers."""
_JSON, _BIN = 0x4E4F534A, 0x004E4942


class GltfFile:
    """A glTF file that is read."""

    def __init__(self, path: Path) -> None:
        """Open ``.glb`` or ``.gltf``; UnreadableFile for anything else."""
        self.path = path
        raw = read_bytes(path)
        self._buffers: dict[int, bytes] = {}
        try:
            if raw[:4] == b"glTF":
                self.json, body = _chunks(raw)
                if body is not None:
                    self._buffers[0] = body
            else:
                self.json = json.loads(raw.decode("utf-8-sig"))
            version = str(self.json["asset"]["version"])
        except (ValueError, KeyError, TypeError, struct.error) as error:
            raise UnreadableFile(f"{path} is no glTF file ({error})") from None
        if not version.startswith("2."):
            raise UnreadableFile(f"{path} is glTF {version}; 2.0 was expected")

    def entries(self, kind: str) -> list[dict[str, Any]]:
        """Return one of the lists (``nodes``, ``meshes``…), empty if it is not there."""
        found = self.json.get(kind, [])
        return found if isinstance(found, list) else []

    def array(self, accessor: int) -> NDArray[Any]:
        """Return the values of an accessor, (n, …); normalised integers as floats.

        Raises
        ------
        UnreadableFile
            If it points nowhere, or is sparse or compressed.
        """
        try:
            entry = self.entries("accessors")[accessor]
            view = self.entries("bufferViews")[entry["bufferView"]]
            kind, shape = _COMPONENTS[entry["componentType"]], _TYPES[entry["type"]]
            if "sparse" in entry or "extensions" in view:
                raise UnreadableFile(
                    f"{self.path}: an array is sparse or compressed; export it without compression"
                )
            content = self._buffer(view["buffer"])
            count, item = (
                int(entry["count"]),
                int(np.prod(shape, dtype=int)) * np.dtype(kind).itemsize,
            )
            start = view.get("byteOffset", 0) + entry.get("byteOffset", 0)
            stride = view.get("byteStride", item)
            end = view.get("byteOffset", 0) + view["byteLength"]
            if count < 0 or start + stride * (count - 1) + item > min(end, len(content)):
                raise UnreadableFile(f"{self.path}: an array reaches beyond the file's bytes")
            flat = np.ndarray(
                (count, item), dtype=np.uint8, buffer=content, offset=start, strides=(stride, 1)
            )
            values = np.ascontiguousarray(flat).view(kind).reshape(count, *shape)
        except (KeyError, IndexError, TypeError, ValueError) as error:
            raise UnreadableFile(f"{self.path}: an array is not whole ({error})") from None
        if entry.get("normalized") and kind in _WHOLE:
            return np.maximum(values / _WHOLE[kind], -1.0)
        return values

    def world_from_node(self) -> Array:
        """Return every node's place as the file stands, (n_nodes, 4, 4).

        Raises
        ------
        UnreadableFile
            If the nodes are no tree.
        """
        nodes = self.entries("nodes")
        parents = [-1] * len(nodes)
        for i, node in enumerate(nodes):
            for child in node.get("children", ()):
                if not 0 <= child < len(nodes) or parents[child] >= 0:
                    raise UnreadableFile(f"{self.path}: its nodes are no tree")
                parents[child] = i
        local = [_local(node) for node in nodes]
        world = np.tile(np.eye(4), (len(nodes), 1, 1))
        for i in range(len(nodes)):
            at, steps = i, 0
            while at >= 0:
                world[i] = local[at] @ world[i]
                at, steps = parents[at], steps + 1
                if steps > len(nodes):
                    raise UnreadableFile(f"{self.path}: its nodes are no tree")
        return world

    def _buffer(self, i: int) -> bytes:
        if i not in self._buffers:
            uri = self.entries("buffers")[i]["uri"]
            if uri.startswith("data:"):
                self._buffers[i] = base64.b64decode(uri.partition(",")[2])
            else:
                name = unquote(uri)
                if Path(name).is_absolute() or ".." in Path(name).parts:
                    raise UnreadableFile(f"{self.path}: its buffer {uri!r} lies elsewhere")
                self._buffers[i] = read_bytes(self.path.parent / name)
        return self._buffers[i]


def _chunks(raw: bytes) -> tuple[dict[str, Any], bytes | None]:
    """Return the JSON and the binary part of a GLB file."""
    at, text, body = 12, None, None
    while at + 8 <= len(raw):
        size, kind = struct.unpack_from("<II", raw, at)
        content = raw[at + 8 : at + 8 + size]
        if kind == _JSON:
            text = json.loads(content.decode("utf-8"))
        elif kind == _BIN and body is None:
            body = content
        at += 8 + size
    if not isinstance(text, dict):
        raise ValueError("it has no JSON part")
    return text, body


def _local(node: dict[str, Any]) -> Array:
    if "matrix" in node:
        return np.array(node["matrix"], dtype=np.float64).reshape(4, 4).T
    x, y, z, w = node.get("rotation", (0.0, 0.0, 0.0, 1.0))
    placed = np.eye(4)
    placed[:3, :3] = [
        [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
        [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
        [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
    ]
    placed[:3, :3] *= np.asarray(node.get("scale", (1.0, 1.0, 1.0)))
    placed[:3, 3] = node.get("translation", (0.0, 0.0, 0.0))
    return placed
