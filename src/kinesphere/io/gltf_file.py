"""A glTF 2.0 file as it stands: its JSON, and the bytes beside it. Nothing in it is lost."""

import base64
import json
import struct
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from kinesphere.data import Array
from kinesphere.errors import UnreadableFile
from kinesphere.io.registry import read_bytes

_MAGIC, _JSON, _BIN = b"glTF", 0x4E4F534A, 0x004E4942
_FLOAT = 5126


@dataclass
class GltfFile:
    """A document that can be added to."""

    json: dict[str, Any]
    binary: bytes | None
    """The chunk of a GLB file; None for a ``.gltf``."""

    def add_floats(self, values: Array, kind: str, *, bounds: bool = False) -> int:
        """Add an accessor of 32-bit floats; return its number.

        Parameters
        ----------
        values : (n, ...) or (n,)
        kind
            ``SCALAR``, ``VEC3``, ``VEC4``.
        bounds
            Whether to say the least and largest, as times must.
        """
        data = np.ascontiguousarray(values, dtype="<f4")
        raw = data.tobytes()
        buffers = self.json.setdefault("buffers", [])
        if self.binary is not None:
            if not buffers or "uri" in buffers[0]:  # the chunk is buffer 0, and nothing else
                if buffers:
                    raise UnreadableFile("the first buffer lies outside the GLB file")
                buffers.append({"byteLength": 0})
            self.binary += bytes(-len(self.binary) % 4)
            start, buffer = len(self.binary), 0
            self.binary += raw
            buffers[0]["byteLength"] = len(self.binary)
        else:
            uri = "data:application/octet-stream;base64," + base64.b64encode(raw).decode()
            buffers.append({"byteLength": len(raw), "uri": uri})
            start, buffer = 0, len(buffers) - 1
        views = self.json.setdefault("bufferViews", [])
        views.append({"buffer": buffer, "byteOffset": start, "byteLength": len(raw)})
        accessor: dict[str, Any] = {
            "bufferView": len(views) - 1,
            "componentType": _FLOAT,
            "count": len(data),
            "type": kind,
        }
        if bounds:
            flat = data.reshape(len(data), -1)
            accessor["min"] = [float(v) for v in flat.min(axis=0)]
            accessor["max"] = [float(v) for v in flat.max(axis=0)]
        accessors = self.json.setdefault("accessors", [])
        accessors.append(accessor)
        return len(accessors) - 1

    def content(self) -> bytes:
        """Return the file's bytes."""
        text = json.dumps(self.json, ensure_ascii=False, separators=(",", ":")).encode()
        if self.binary is None:
            return text + b"\n"
        text += b" " * (-len(text) % 4)
        binary = self.binary + bytes(-len(self.binary) % 4)
        chunks = struct.pack("<II", len(text), _JSON) + text
        if binary:
            chunks += struct.pack("<II", len(binary), _BIN) + binary
        return struct.pack("<4sII", _MAGIC, 2, 12 + len(chunks)) + chunks


def parse_gltf(path: Path) -> GltfFile:
    """Parse a ``.glb`` or ``.gltf`` file.

    Raises
    ------
    UnreadableFile
        If it is damaged or not of version 2.
    """
    raw = read_bytes(path)
    binary: bytes | None = None
    text = raw
    if raw.startswith(_MAGIC):
        text, binary = _chunks(raw, path)
    try:
        document = json.loads(text)
    except (ValueError, RecursionError) as error:
        raise UnreadableFile(f"{path}: its JSON is damaged ({error})") from None
    asset = document.get("asset") if isinstance(document, dict) else None
    version = asset.get("version") if isinstance(asset, dict) else None
    if not isinstance(version, str) or not version.startswith("2"):
        raise UnreadableFile(f"{path} is glTF of version {version!r:.20}; 2.0 is read")
    return GltfFile(document, binary)


def external_files(document: dict[str, Any]) -> list[str]:
    """Return the files a ``.gltf`` refers to beside itself."""
    listed = [*document.get("buffers", []), *document.get("images", [])]
    uris = [one.get("uri") for one in listed if isinstance(one, dict)]
    return [uri for uri in uris if isinstance(uri, str) and not uri.startswith("data:")]


def _chunks(raw: bytes, path: Path) -> tuple[bytes, bytes]:
    if len(raw) < 20:
        raise UnreadableFile(f"{path} breaks off in the header of a GLB file")
    _, version, length = struct.unpack_from("<4sII", raw)
    if version != 2 or length > len(raw):
        raise UnreadableFile(
            f"{path} says version {version} and {length} bytes; it is {len(raw)} bytes long"
        )
    at, text, binary = 12, b"", b""
    while at + 8 <= length:
        size, kind = struct.unpack_from("<II", raw, at)
        chunk = raw[at + 8 : at + 8 + size]
        if len(chunk) < size:
            raise UnreadableFile(f"{path}: a chunk of {size} bytes breaks off")
        if kind == _JSON and not text:
            text = chunk
        elif kind == _BIN and not binary:
            binary = chunk
        at += 8 + size
    return text, binary
