"""Videos being written, frame after frame, by PyAV."""

from fractions import Fraction
from pathlib import Path
from typing import Any, BinaryIO

import numpy as np

from kinesphere.data import Image
from kinesphere.errors import MissingExtra

BROWSERS_PLAY = ("libx264", "libvpx-vp9")
"""Codecs of MP4 files, the best known first: which of them there are depends on PyAV's build."""


class VideoWriter:
    """A video being written: MP4 as browsers play it, or Matroska without loss.

    Parameters
    ----------
    target
        A path, or a binary file that can be sought.
    rate
        Frames per second.
    quality
        Constant rate factor: 16 can hardly be told from the original, 23 is usual; None for no
        loss at all.

    Raises
    ------
    MissingExtra
        If PyAV is not installed.
    """

    def __init__(self, target: Path | BinaryIO, rate: float, quality: int | None = 23) -> None:
        self.av = pyav()
        self.target = str(target) if isinstance(target, Path) else target
        self.rate = Fraction(rate).limit_denominator(1001)
        self.quality = quality
        self.begun = False

    def __enter__(self) -> "VideoWriter":
        kind = "matroska" if self.quality is None else "mp4"
        self.container = self.av.open(self.target, "w", format=kind)
        if self.quality is None:
            self.stream = self._stream("ffv1", "bgr0", {"g": "1"})
        else:
            codec = next(name for name in BROWSERS_PLAY if self._knows(name))
            options = {"crf": str(self.quality)} | ({"b": "0"} if "vpx" in codec else {})
            self.stream = self._stream(codec, "yuv420p", options)
        return self

    def add(self, image: Image) -> None:
        """Write one more frame, (height, width, 3); all have the size of the first."""
        if not self.begun:
            self.stream.height, self.stream.width = image.shape[:2]
            if self.quality is not None and any(side % 2 for side in image.shape[:2]):
                self.stream.pix_fmt = "yuv444p"  # halved colours need even sides
            self.begun = True
        frame = self.av.VideoFrame.from_ndarray(np.ascontiguousarray(image), format="rgb24")
        for packet in self.stream.encode(frame):
            self.container.mux(packet)

    def __exit__(self, *_: object) -> None:
        if self.begun:
            for packet in self.stream.encode():
                self.container.mux(packet)
        self.container.close()

    def _stream(self, codec: str, pixels: str, options: dict[str, str]) -> Any:
        stream = self.container.add_stream(codec, rate=self.rate, options=options)
        stream.pix_fmt = pixels
        return stream

    def _knows(self, codec: str) -> bool:
        try:
            self.av.Codec(codec, "w")
        except self.av.codec.codec.UnknownCodecError:
            return False
        return True


def pyav() -> Any:
    """Return PyAV, silent; MissingExtra says how to get it."""
    try:
        import av
    except ImportError:
        raise MissingExtra(
            "videos need PyAV, which is not installed: pip install 'kinesphere[markerless]'"
        ) from None
    av.logging.set_level(None)  # FFmpeg's own words go to stderr otherwise
    return av
