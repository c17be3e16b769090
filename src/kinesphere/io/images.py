"""Image files as arrays, and the one place that fetches OpenCV."""

from functools import cache
from pathlib import Path
from typing import Any

import numpy as np

from kinesphere.data import Image, Mask
from kinesphere.errors import MissingExtra, UnreadableFile
from kinesphere.io.registry import read_bytes

SUFFIXES = (".png", ".jpg", ".jpeg", ".bmp", ".tif", ".tiff", ".ppm", ".pgm", ".webp")
"""What counts as an image in a folder."""
_HALF = 127


@cache
def opencv() -> Any:
    """Return OpenCV, one thread each call; MissingExtra says how to get it."""
    try:
        import cv2
    except ImportError:
        raise MissingExtra(
            "images need OpenCV, which is not installed: pip install 'kinesphere[markerless]'"
        ) from None
    cv2.utils.logging.setLogLevel(0)  # it prints what its errors say anyway
    return cv2


def read_image(path: str | Path) -> Image:
    """Return an image file as (height, width, 3) red, green, blue.

    Grey images have three equal channels; of 16 bits the upper 8 are kept; transparency is
    dropped.

    Raises
    ------
    UnreadableFile
        If there is no such file, or no image in it.
    """
    return _decoded(Path(path))


def read_mask(path: str | Path) -> Mask:
    """Return a mask file as (height, width): True where it is brighter than half."""
    return np.asarray(_decoded(Path(path)).max(axis=2) > _HALF)


def write_image(image: Image | Mask, path: str | Path) -> None:
    """Write an image, or a mask as black and white; the suffix says which format."""
    cv2 = opencv()
    path = Path(path)
    if image.dtype == np.bool_:
        image = image.astype(np.uint8) * 255
    pixels = image if image.ndim == 2 else image[..., ::-1]
    done, raw = cv2.imencode(path.suffix, np.ascontiguousarray(pixels))
    if not done:
        raise UnreadableFile(f"{path}: OpenCV writes no such images")
    path.write_bytes(raw.tobytes())


def encoded_image(image: Image, suffix: str = ".jpg", quality: int = 85) -> bytes:
    """Return an image as the bytes of a file."""
    cv2 = opencv()
    options = [cv2.IMWRITE_JPEG_QUALITY, quality] if suffix == ".jpg" else []
    _, raw = cv2.imencode(suffix, np.ascontiguousarray(image[..., ::-1]), options)
    return bytes(raw.tobytes())


def _decoded(path: Path) -> Image:
    cv2 = opencv()
    raw = np.frombuffer(read_bytes(path), dtype=np.uint8)
    flags = cv2.IMREAD_COLOR | cv2.IMREAD_ANYDEPTH
    try:
        pixels = cv2.imdecode(raw, flags)
    except cv2.error:
        pixels = None
    if pixels is None:
        raise UnreadableFile(f"{path} holds no image that can be decoded")
    if pixels.dtype == np.uint16:
        pixels = (pixels >> 8).astype(np.uint8)
    elif pixels.dtype != np.uint8:
        raise UnreadableFile(f"{path} holds {pixels.dtype} pixels; 8 or 16 bits were expected")
    image: Image = np.ascontiguousarray(pixels[..., ::-1])
    return image
