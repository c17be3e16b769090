"""Scenes of the real recordings: SCENE.toml files written beside nothing of theirs.

    python -m benchmarks.markerless.real_scenes FOLDER
    kinesphere track FOLDER/pose2sim/SCENE.toml -o OUT

They are those of the benchmark. The recordings stay where they are (KINESPHERE_DATA); the scenes
name them by their full paths.
"""

import json
import os
import sys
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from kinesphere.io.scene import read_scene
from kinesphere.markerless.alignment import aligned, pixel_map
from kinesphere.markerless.checks import silhouettes

DATA = Path(os.environ.get("KINESPHERE_DATA", "../shared/data"))
_CROPPED = {"cam01", "cam02"}
"""Their videos are 1080 pixels wide, their calibration is for 1088 and was matched by features."""


def write_pose2sim_scene(
    folder: Path, data: Path = DATA, *, qualisys: bool = False, masks: bool = False
) -> Path:
    """Write the scene of one person balancing before clutter; return its path.

    Parameters
    ----------
    masks
        Whether the mask of frame 5 serves the start; else all four are only compared with.
    qualisys
        With the calibration as it was shipped, 15 px off, instead of the better one.
    """
    video = (data / "video" / "pose2sim").resolve()
    calibration = video / ("Calib.qca.txt" if qualisys else "Calib_scene.toml")
    lines = [f"calibration = {json.dumps(str(calibration))}", 'up = "+z"']
    what = "masks" if masks else "reference_masks"
    if not qualisys:
        lines.append('unit = "m"')
    for name in ("cam01", "cam02", "cam03", "cam04"):
        called = name if qualisys else f"int_{name}_img"
        lines += [
            "",
            "[[camera]]",
            f"name = {json.dumps(called)}",
            f"images = {json.dumps(str(video / f'{name}.mp4'))}",
            f"{what} = {json.dumps(str(video / 'masks' / f'{name}_*.png'))}",
            "first_mask = 0",
        ]
        if name in _CROPPED:
            lines.append("calibration_pixel = { scale = 1.0075, shift = [0.0, -7.2] }")
    if masks:
        lines += ["", "[start]", "frame = 5"]
    return _written(folder, lines)


def write_parsec_scene(
    folder: Path,
    data: Path = DATA,
    *,
    masks: bool = True,
    shifts: NDArray[np.float64] | None = None,
) -> Path:
    """Write the scene of the single instant that four grey cameras saw; return its path.

    Parameters
    ----------
    masks
        Whether its foreground maps are used, or only compared with.
    shifts
        (4, 2) px, where the images lie beside what the calibration says: its cameras were moved.
    """
    video = (data / "video" / "parsec").resolve()
    folder.mkdir(parents=True, exist_ok=True)
    calibration = ['unit = "mm"', f'up = "{PARSEC_UP}"']
    lines = ['calibration = "calibration.toml"']
    for i in range(1, 5):
        fx, fy, cx, cy, skew, k1, k2, p1, p2, k3, *pose = (
            float(word) for word in (video / "CALIB" / f"Camera{i}.cal").read_text().split()
        )
        calibration += [
            "",
            "[[camera]]",
            f'name = "CAM{i}"',
            "size = [640, 480]",
            f"matrix = {[[fx, skew, cx], [0.0, fy, cy], [0.0, 0.0, 1.0]]}",
            f"distortion = {[k1, k2, p1, p2, k3]}",
            f"rotation = {np.reshape(pose[:9], (3, 3)).tolist()}",
            f"translation = {pose[9:12]}",
        ]
        what = "masks" if masks else "reference_masks"
        lines += [
            "",
            "[[camera]]",
            f'name = "CAM{i}"',
            f"images = {json.dumps(str(video / f'CAM{i}' / 'image0000.bmp'))}",
            f"{what} = {json.dumps(str(video / f'FG{i}' / 'image0000.bmp'))}",
        ]
        if shifts is not None:
            lines.append(pixel_map(shifts[i - 1]))
    (folder / "calibration.toml").write_text("\n".join(calibration) + "\n")
    return _written(folder, lines)


def write_mended_parsec_scene(folder: Path, data: Path = DATA) -> Path:
    """Write the scene of that instant, its calibration mended as the check before tracking advises.

    The cameras were moved by up to 8 px after they had been calibrated; what the check says of it
    is written into the scene, as a user would.
    """
    path = write_parsec_scene(folder, data)
    scene = read_scene(path)
    found = aligned(scene.cameras, [silhouettes(scene, scene.frame(0))])
    return path if found is None else write_parsec_scene(folder, data, shifts=found.shifts)


PARSEC_UP = "+z"


def _written(folder: Path, lines: list[str]) -> Path:
    folder.mkdir(parents=True, exist_ok=True)
    path = folder / "SCENE.toml"
    path.write_text("\n".join(lines) + "\n", encoding="utf-8")
    return path


if __name__ == "__main__":
    where = Path(sys.argv[1] if len(sys.argv) > 1 else "scenes")
    print(write_pose2sim_scene(where / "pose2sim", masks=True))
    print(write_mended_parsec_scene(where / "parsec"))
