"""Qualisys Track Manager's calibration, ``.qca.txt``: XML with focal lengths in 1/64 pixel."""

from pathlib import Path
from xml.etree.ElementTree import Element

import numpy as np

from kinesphere.data import Array
from kinesphere.errors import UnreadableFile
from kinesphere.io.calibration.records import CalibratedCamera, Calibration, checked
from kinesphere.io.xml_files import read_xml

_SUBPIXELS = 64.0
_FLIP = np.diag([1.0, -1.0, -1.0])
"""Their camera looks along −z with y up, ours along +z with y down."""


def read_qualisys_calibration(path: Path) -> Calibration:
    """Read a ``.qca.txt`` file.

    Inactive cameras are left out. A camera's ``transform`` holds its place in mm and its axes as
    rows; the principal point is counted on the whole sensor, so the image's corner is taken off.
    Distortion coefficients are those of normalised coordinates.

    Raises
    ------
    UnreadableFile
        If it is no calibration, or a camera in it is not whole.
    """
    root = read_xml(path)
    if root.tag != "calibration":
        raise UnreadableFile(f"{path}: its root is <{root.tag}>; <calibration> was expected")
    cameras = [
        _camera(element, i, path)
        for i, element in enumerate(root.iter("camera"))
        if element.get("active", "1") not in ("0", "false")
    ]
    return Calibration(path, "Qualisys", checked(cameras, path), unit="mm")


def _camera(element: Element, i: int, path: Path) -> CalibratedCamera:
    name = element.get("serial") or f"camera {i + 1}"
    if (turn := element.get("viewrotation", "0")) not in ("0", "0.0"):
        raise UnreadableFile(
            f"{path}: the view of camera {name} is turned by {turn}°; export it with 0°"
        )
    parts = {tag: element.find(tag) for tag in ("transform", "intrinsic", "fov_video")}

    def of(tag: str, *keys: str) -> Array:
        part = parts[tag]
        if part is None:
            raise UnreadableFile(f"{path}: camera {name} has no <{tag}>")
        try:
            values = np.array([float(part.attrib[key]) for key in keys])
        except KeyError as missing:
            raise UnreadableFile(f"{path}: <{tag}> of camera {name} has no {missing}") from None
        except ValueError as error:
            raise UnreadableFile(f"{path}: <{tag}> of camera {name}: {error}") from None
        if not np.isfinite(values).all():
            raise UnreadableFile(f"{path}: <{tag}> of camera {name} holds no finite number")
        return values

    left, top, right, bottom = of("fov_video", "left", "top", "right", "bottom")
    fu, fv, cu, cv, skew = (
        of("intrinsic", "focalLengthU", "focalLengthV", "centerPointU", "centerPointV", "skew")
        / _SUBPIXELS
    )
    k1, k2, k3, p1, p2 = of(
        "intrinsic",
        "radialDistortion1",
        "radialDistortion2",
        "radialDistortion3",
        "tangentalDistortion1",
        "tangentalDistortion2",
    )
    axes = of("transform", *(f"r{row}{column}" for row in "123" for column in "123"))
    rotation = _FLIP @ axes.reshape(3, 3)
    return CalibratedCamera(
        name=name,
        size=(round(right - left) + 1, round(bottom - top) + 1),
        matrix=np.array([[fu, skew, cu - left], [0.0, fv, cv - top], [0.0, 0.0, 1.0]]),
        distortion=np.array([k1, k2, p1, p2, k3]),
        rotation=rotation,
        translation=-rotation @ of("transform", "x", "y", "z"),
    )
