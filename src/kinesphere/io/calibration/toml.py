"""Calibrations in TOML: our own ``[[camera]]`` list, and Pose2Sim's and aniposelib's tables."""

import json
import tomllib
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from kinesphere.data import Camera
from kinesphere.errors import UnreadableFile
from kinesphere.io.atomic import replacing
from kinesphere.io.calibration.records import (
    CalibratedCamera,
    Calibration,
    checked,
    lens,
    numbers,
    rotation,
    size,
)
from kinesphere.io.text import read_text


def read_toml_calibration(path: Path) -> Calibration:
    """Read our own or a Pose2Sim/aniposelib calibration.

    Raises
    ------
    UnreadableFile
        If it is neither, or a camera in it is not whole.
    """
    try:
        found = tomllib.loads(read_text(path))
    except tomllib.TOMLDecodeError as error:
        raise UnreadableFile(f"{path}: no TOML: {error}") from error
    if isinstance(found.get("camera"), list):
        cameras = [_own(camera, i, path) for i, camera in enumerate(found["camera"])]
        unit, up = str(found.get("unit", "m")), str(found.get("up", ""))
        return Calibration(path, "Kinesphere TOML", checked(cameras, path), unit, up)
    tables = {
        key: table
        for key, table in found.items()
        if isinstance(table, Mapping) and ("matrix" in table or "distortions" in table)
    }
    if not tables:
        raise UnreadableFile(
            f"{path} calibrates no camera: neither [[camera]] entries nor tables with a matrix "
            "(Pose2Sim, aniposelib) are in it"
        )
    cameras = [_pose2sim(key, table, path) for key, table in tables.items()]
    return Calibration(path, "Pose2Sim TOML", checked(cameras, path))


def write_calibration(cameras: Sequence[Camera], path: str | Path, up: str = "+y") -> None:
    """Write our own calibration TOML; `read_calibration` gives the same numbers back.

    Parameters
    ----------
    up
        Which way is up in the cameras' world.
    """
    lines = ["# camera_from_world: p_camera = rotation @ p_world + translation", 'unit = "m"']
    lines.append(f"up = {json.dumps(up)}")
    for camera in cameras:
        lines += [
            "",
            "[[camera]]",
            f"name = {json.dumps(camera.name)}",
            f"size = {json.dumps([camera.width, camera.height])}",
            f"matrix = {json.dumps(camera.matrix.tolist())}",
            f"distortion = {json.dumps(camera.distortion.tolist())}",
            f"rotation = {json.dumps(camera.rotation.tolist())}",
            f"translation = {json.dumps(camera.translation.tolist())}",
        ]
    with replacing(Path(path)) as partial:
        partial.write_text("\n".join(lines) + "\n", encoding="utf-8")


def _own(table: Any, i: int, path: Path) -> CalibratedCamera:
    if not isinstance(table, Mapping):
        raise UnreadableFile(f"{path}: camera must be a list of tables, [[camera]]")
    name = str(table.get("name", f"camera {i + 1}"))
    known = {"name", "size", "matrix", "distortion", "rotation", "translation"}
    if unknown := sorted(set(table) - known):
        raise UnreadableFile(
            f"{path}: {name}: {', '.join(unknown)} is no key here; known: {', '.join(known)}"
        )
    return _camera(name, table, "distortion", path)


def _pose2sim(key: str, table: Mapping[str, Any], path: Path) -> CalibratedCamera:
    name = str(table.get("name", key))
    if table.get("fisheye"):
        raise UnreadableFile(
            f"{path}: {name} is a fisheye; only the pinhole with k1, k2, p1, p2, k3 is known here"
        )
    return _camera(name, table, "distortions", path)


def _camera(name: str, table: Mapping[str, Any], bends: str, path: Path) -> CalibratedCamera:
    for needed in ("matrix", "rotation", "translation"):
        if needed not in table:
            raise UnreadableFile(f"{path}: {name} has no {needed}")
    return CalibratedCamera(
        name=name,
        size=size(table["size"], f"size of {name}", path) if "size" in table else None,
        matrix=numbers(table["matrix"], (3, 3), f"matrix of {name}", path),
        distortion=lens(table.get(bends, [0.0] * 5), f"{bends} of {name}", path),
        rotation=rotation(table["rotation"], f"rotation of {name}", path),
        translation=numbers(table["translation"], (3,), f"translation of {name}", path),
    )
