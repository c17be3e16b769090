"""Calibrations of cameras, each format recognised by its content."""

from pathlib import Path

from kinesphere.io.calibration.records import CalibratedCamera as CalibratedCamera
from kinesphere.io.calibration.records import Calibration as Calibration
from kinesphere.io.calibration.toml import write_calibration as write_calibration
from kinesphere.io.registry import read_bytes

_HEAD = 4096


def read_calibration(path: str | Path) -> Calibration:
    """Read a calibration: our TOML, Pose2Sim's or aniposelib's, Qualisys', or OpenCV's YAML.

    Raises
    ------
    UnreadableFile
        If the file is missing, none of these, or a camera in it is not whole.
    """
    path = Path(path)
    head = read_bytes(path, _HEAD).decode("utf-8", "replace").lstrip("\ufeff \t\r\n")
    if "<opencv_storage" in head or head.startswith(("%YAML", "{")) or _is_yaml(path, head):
        from kinesphere.io.calibration.opencv import read_opencv_calibration

        return read_opencv_calibration(path)
    if head.startswith("<"):
        from kinesphere.io.calibration.qualisys import read_qualisys_calibration

        return read_qualisys_calibration(path)
    from kinesphere.io.calibration.toml import read_toml_calibration

    return read_toml_calibration(path)


def _is_yaml(path: Path, head: str) -> bool:
    return path.suffix.lower() in (".yml", ".yaml") or head.startswith("---")
