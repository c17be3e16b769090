"""Calibrations that OpenCV's FileStorage wrote: YAML, XML or JSON, one camera or several a file."""

from pathlib import Path
from typing import Any

import numpy as np

from kinesphere.errors import UnreadableFile
from kinesphere.io.calibration.records import (
    CalibratedCamera,
    Calibration,
    checked,
    lens,
    numbers,
    rotation,
    size,
)
from kinesphere.io.images import opencv
from kinesphere.io.text import read_text

_SPELLINGS = {
    "matrix": ("camera_matrix", "cameraMatrix", "Camera_Matrix", "K", "M", "matrix"),
    "distortion": (
        "distortion_coefficients",
        "Distortion_Coefficients",
        "distCoeffs",
        "dist_coeffs",
        "dist",
        "D",
    ),
    "rotation": ("Rot", "R", "rvec", "rotation", "rotation_matrix"),
    "translation": ("T", "t", "tvec", "translation"),
    "width": ("image_width", "image_Width", "width"),
    "height": ("image_height", "image_Height", "height"),
}
"""What programs call each part; one camera's in a file of several ends in ``_`` and its name."""


def read_opencv_calibration(path: Path) -> Calibration:
    """Read what FileStorage wrote.

    One camera a file, named after the file (``camera_matrix``, ``distortion_coefficients``, ``R``
    or ``rvec``, ``T`` or ``tvec``, ``image_width``, ``image_height``); or several, each key ending
    in the camera's name (``K_01``, ``dist_01``, ``Rot_01``, ``T_01``).

    Raises
    ------
    UnreadableFile
        If it is no such file, or a camera in it is not whole.
    """
    values = _values(path)
    suffixes = sorted(
        {
            key[len(head) :]
            for key in values
            for head in _SPELLINGS["matrix"]
            if key == head or key.startswith(head + "_")
        }
    )
    if not suffixes:
        raise UnreadableFile(
            f"{path} calibrates no camera: no camera_matrix among {', '.join(list(values)[:8])}"
        )
    cameras = [_camera(suffix, values, path) for suffix in suffixes]
    return Calibration(path, "OpenCV", checked(cameras, path))


def _camera(suffix: str, values: dict[str, Any], path: Path) -> CalibratedCamera:
    name = suffix.lstrip("_") or path.stem
    parts = {
        part: next((values[s + suffix] for s in spellings if s + suffix in values), None)
        for part, spellings in _SPELLINGS.items()
    }
    for needed in ("matrix", "rotation", "translation"):
        if parts[needed] is None:
            shown = ", ".join(s + suffix for s in _SPELLINGS[needed][:3])
            raise UnreadableFile(f"{path}: {name} has no {needed} ({shown} or the like)")
    bounds = (parts["width"], parts["height"])
    bends = parts["distortion"]
    return CalibratedCamera(
        name=name,
        size=None if None in bounds else size(bounds, f"size of {name}", path),
        matrix=numbers(parts["matrix"], (3, 3), f"matrix of {name}", path),
        distortion=lens([0.0] if bends is None else bends, f"distortion of {name}", path),
        rotation=rotation(parts["rotation"], f"rotation of {name}", path),
        translation=numbers(parts["translation"], (3,), f"translation of {name}", path),
    )


def _values(path: Path) -> dict[str, Any]:
    """Return every top-level entry as a number, a text or an array."""
    cv2 = opencv()
    text = read_text(path)
    if not text.lstrip().startswith(("%YAML", "<?xml", "{")):
        text = "%YAML:1.0\n---\n" + text  # written by hand, or by a program that left it out
    try:
        storage = cv2.FileStorage(text, cv2.FILE_STORAGE_READ | cv2.FILE_STORAGE_MEMORY)
        root = storage.root()
        found = {key: _value(root.getNode(key)) for key in root.keys()}  # noqa: SIM118 - no dict
    except (cv2.error, SystemError) as error:
        said = " ".join(str(error).split())
        raise UnreadableFile(f"{path}: OpenCV cannot read it: {said[-120:]}") from None
    return {key: value for key, value in found.items() if value is not None}


def _value(node: Any) -> Any:
    if node.isReal() or node.isInt():
        return node.real()
    if node.isString():
        return node.string()
    if node.isSeq():
        return np.array([_value(node.at(i)) for i in range(node.size())], dtype=object)
    if node.isMap():
        matrix = node.mat() if not node.getNode("dt").empty() else None
        if matrix is not None:
            return matrix
        data = node.getNode("data")  # ROS writes rows, cols, data without OpenCV's tag
        return None if data.empty() else _value(data)
    return None
