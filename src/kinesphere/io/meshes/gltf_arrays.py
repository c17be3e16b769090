"""Arrays out of a glTF file: accessors, views and buffers.

Format: Khronos glTF 2.0 specification, section 3.6 (binary data storage).
"""

import base64
import binascii
from pathlib import Path
from urllib.parse import unquote

import numpy as np

from kinesphere.data import Array
from kinesphere.errors import UnreadableFile
from kinesphere.io.gltf_file import GltfFile
from kinesphere.io.registry import read_bytes

_TYPES = {5120: "<i1", 5121: "<u1", 5122: "<i2", 5123: "<u2", 5125: "<u4", 5126: "<f4"}
_WIDTHS = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4, "MAT4": 16}


class GltfArrays:
    """The arrays of one file, by the number of their accessor."""

    def __init__(self, file: GltfFile, path: Path) -> None:
        self.file, self.path = file, path
        self._buffers: dict[int, bytes] = {}

    def __getitem__(self, index: int) -> Array:
        """Return an accessor's values as float64, (count, width); normalized integers as shares."""
        told = self.file.json["accessors"][index]
        dtype = np.dtype(_TYPES[told["componentType"]])
        width, count = _WIDTHS[told["type"]], int(told["count"])
        if "sparse" in told:
            raise UnreadableFile(f"{self.path} holds sparse arrays, which are not read")
        if "bufferView" not in told:
            raise UnreadableFile(f"{self.path} is compressed; export it without compression")
        view = self.file.json["bufferViews"][told["bufferView"]]
        stride = int(view.get("byteStride") or dtype.itemsize * width)
        start = int(view.get("byteOffset", 0)) + int(told.get("byteOffset", 0))
        raw = self._buffer(int(view["buffer"]))
        end = start + stride * (count - 1) + dtype.itemsize * width
        if count < 0 or start < 0 or stride < 0 or (count and end > len(raw)):
            raise UnreadableFile(f"{self.path}: array {index} reaches beyond the end of its bytes")
        values = np.ndarray(
            (count, width), dtype, buffer=raw, offset=start, strides=(stride, dtype.itemsize)
        ).astype(np.float64)
        if told.get("normalized") and dtype.kind in "iu":
            values = np.maximum(values / np.iinfo(dtype).max, -1.0)
        return values

    def _buffer(self, index: int) -> bytes:
        if index not in self._buffers:
            uri = self.file.json["buffers"][index].get("uri")
            if uri is None:
                if self.file.binary is None:
                    raise UnreadableFile(f"{self.path}: buffer {index} is nowhere")
                self._buffers[index] = self.file.binary
            elif uri.startswith("data:"):
                try:
                    self._buffers[index] = base64.b64decode(uri.partition(",")[2], validate=True)
                except binascii.Error as error:
                    raise UnreadableFile(f"{self.path}: its base64 is damaged ({error})") from None
            else:
                beside = Path(unquote(uri))
                if beside.is_absolute() or ".." in beside.parts or ":" in uri:
                    raise UnreadableFile(f"{self.path} refers to {uri}, which is not beside it")
                self._buffers[index] = read_bytes(self.path.parent / beside)
        return self._buffers[index]
