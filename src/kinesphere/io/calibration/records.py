"""What a calibration file says of its cameras, before axes, unit and image size are settled."""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from scipy.spatial.transform import Rotation

from kinesphere.data import Array
from kinesphere.errors import UnreadableFile

_LENS = 5
"""Coefficients of the lens model: k1, k2, p1, p2, k3."""


@dataclass(frozen=True, eq=False)
class CalibratedCamera:
    """One camera as its file has it."""

    name: str
    size: tuple[int, int] | None
    """Width and height in pixels; None if the file does not say."""
    matrix: Array
    """(3, 3) px."""
    distortion: Array
    """(5,) k1, k2, p1, p2, k3."""
    rotation: Array
    """(3, 3) ``camera_from_world``."""
    translation: Array
    """(3,) in the file's unit."""


@dataclass(frozen=True, eq=False)
class Calibration:
    """The cameras of one file, in its axes and its unit."""

    path: Path
    format: str
    cameras: tuple[CalibratedCamera, ...]
    unit: str = ""
    """As the format fixes it or the file says; empty if neither does."""
    up: str = ""
    """``+z`` and the like, if the file says."""


def numbers(values: Any, shape: tuple[int, ...], what: str, path: Path) -> Array:
    """Return an array of finite numbers of one shape; UnreadableFile says what there is instead."""
    wanted = " × ".join(str(n) for n in shape)
    try:
        found = np.array(values, dtype=np.float64)
    except (TypeError, ValueError):
        raise UnreadableFile(f"{path}: {what} must be {wanted} numbers") from None
    if found.size == int(np.prod(shape)) and found.ndim != len(shape):
        found = found.reshape(shape)
    if found.shape != shape:
        shown = " × ".join(str(n) for n in found.shape) or "1"
        raise UnreadableFile(f"{path}: {what} must be {wanted} numbers, found {shown}")
    if not np.isfinite(found).all():
        raise UnreadableFile(f"{path}: {what} holds a value that is no finite number")
    return found


def lens(values: Any, what: str, path: Path) -> Array:
    """Return the five coefficients of a lens from four, five or more, the further ones zero."""
    flat = numbers(values, (int(np.size(np.asarray(values, dtype=object))),), what, path)
    if len(flat) > _LENS and flat[_LENS:].any():
        raise UnreadableFile(
            f"{path}: {what} has {len(flat)} coefficients; five are known here (k1, k2, p1, p2, "
            "k3): calibrate again without the rational, thin-prism or tilted model"
        )
    return np.pad(flat[:_LENS], (0, max(0, _LENS - len(flat))))


def rotation(values: Any, what: str, path: Path) -> Array:
    """Return a rotation given as a 3 × 3 matrix or as a rotation vector in rad."""
    if np.size(np.asarray(values, dtype=object)) == 9:
        return numbers(values, (3, 3), what, path)
    turned: Array = Rotation.from_rotvec(numbers(values, (3,), what, path)).as_matrix()
    return turned


def size(values: Any, what: str, path: Path) -> tuple[int, int]:
    """Return width and height as whole numbers of pixels."""
    width, height = numbers(values, (2,), what, path)
    if not (width == int(width) > 0 and height == int(height) > 0):
        raise UnreadableFile(f"{path}: {what} is {width:g} × {height:g}; whole pixels are needed")
    return int(width), int(height)


def checked(cameras: Sequence[CalibratedCamera], path: Path) -> tuple[CalibratedCamera, ...]:
    """Return the cameras of a file, of which there must be one at least and none twice."""
    if not cameras:
        raise UnreadableFile(f"{path} calibrates no camera")
    names = [camera.name for camera in cameras]
    if twice := sorted({name for name in names if names.count(name) > 1}):
        raise UnreadableFile(f"{path}: camera {', '.join(twice)} is there twice")
    return tuple(cameras)
