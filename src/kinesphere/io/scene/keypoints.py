"""The keypoints that a scene names for its start, found for the right frame of every camera."""

import re
from collections.abc import Sequence
from pathlib import Path

import numpy as np

from kinesphere.data import Array, Camera
from kinesphere.data.keypoints import KEYPOINTS, PlacedKeypoints, SeenKeypoints
from kinesphere.errors import BadScene, UnreadableFile
from kinesphere.io.keypoints import read_people
from kinesphere.io.scene.image_folder import ImageFolder
from kinesphere.io.scene.opened import OpenedCamera
from kinesphere.io.scene.placed_keypoints import WITHOUT, placed_keypoints

CONFIDENT = 0.3
"""Keypoints less sure than this are left out."""


def start_keypoints(
    path: Path,
    axes: str | None,
    opened: Sequence[OpenedCamera],
    cameras: Sequence[Camera],
    turn: Array,
    frame: int,
    n_frames: int,
) -> tuple[SeenKeypoints | PlacedKeypoints | None, list[str]]:
    """Return the keypoints of the start's frame, and what is to be said about them.

    Parameters
    ----------
    path
        A folder that holds one folder of JSON files for each camera, or a TRC file.
    axes
        Of a TRC file: ``calibration`` or ``y-up``; guessed aloud if None.
    cameras
        In the scene's world.
    turn : (3, 3)
        ``world_from_file``.
    frame
        The start's, counted after the offsets as in the file.
    n_frames
        How many frames every camera covers.

    Raises
    ------
    UnreadableFile
        If there is no such file, or one is damaged or of an unknown set.
    BadScene
        If its folders belong to fewer than two cameras.
    """
    if path.suffix.lower() == ".trc":
        return placed_keypoints(path, axes, cameras, turn, frame, n_frames)
    if not path.is_dir():
        raise UnreadableFile(
            f"{path}: no such keypoints; a folder with a folder of JSON files for each camera, or "
            "a TRC file, would do"
        )
    return _from_folders(path, opened, frame)


def _from_folders(
    path: Path, opened: Sequence[OpenedCamera], frame: int
) -> tuple[SeenKeypoints | None, list[str]]:
    folders = sorted(f for f in path.iterdir() if f.is_dir())
    mine = [_folder_of(one, folders) for one in opened]
    if sum(f is not None for f in mine) < 2:
        wanted = ", ".join(one.spec.name for one in opened)
        have = ", ".join(f.name for f in folders) or "none"
        raise BadScene(
            f"{path}: folders called after two cameras ({wanted}) are needed; there: {have}"
        )
    pixels = np.full((len(opened), len(KEYPOINTS), 2), np.nan)
    confidence = np.zeros(pixels.shape[:2])
    said: list[str] = []
    for i, (one, folder) in enumerate(zip(opened, mine, strict=True)):
        if folder is None:
            said.append(f"{path} has no keypoints of {one.spec.name}")
            continue
        file = _file_of(one, folder, frame, said)
        people = np.empty((0, len(KEYPOINTS), 3)) if file is None else read_people(file)
        if len(people) == 0:
            continue
        sure = np.where(people[..., 2] >= CONFIDENT, people[..., 2], 0.0)
        counts = (sure > 0).sum(axis=1)
        best = int(np.lexsort((-sure.sum(axis=1), -counts))[0])
        if len(people) > 1:
            said.append(
                f"{file} shows {len(people)} people; the one with most confident keypoints "
                f"({counts[best]}) is taken"
            )
        pixels[i], confidence[i] = people[best, :, :2], sure[best]
    if (confidence.any(axis=1)).sum() < 2:
        found = ", ".join(o.spec.name for o, c in zip(opened, confidence, strict=True) if c.any())
        return None, [
            *said,
            f"{path}: in frame {frame} keypoints are confident in {found or 'no camera'}, and two "
            f"are needed{WITHOUT}",
        ]
    return SeenKeypoints(pixels, confidence), said


def _folder_of(one: OpenedCamera, folders: Sequence[Path]) -> Path | None:
    """Return the folder called as a camera or its images are, ``_json`` at the end or not."""
    own = (one.spec.name, Path(one.spec.images).stem)
    stems = {f: re.sub(r"_(json|keypoints)$", "", f.name) for f in folders}
    exact = [f for f, stem in stems.items() if stem in own or f.name in own]
    within = [f for f, stem in stems.items() if re.search(rf"(^|_){re.escape(stem)}(_|$)", own[0])]
    found = exact or within
    return found[0] if len(found) == 1 else None


def _file_of(one: OpenedCamera, folder: Path, frame: int, said: list[str]) -> Path | None:
    numbers: dict[int, Path] = {}
    for file in sorted(folder.glob("*.json")):
        if digits := re.findall(r"\d+", file.stem):
            numbers[int(digits[-1])] = file
    if not numbers:
        raise UnreadableFile(f"{folder} holds no numbered JSON files, such as cam01_000000.json")
    stream = one.stream
    index, begins, step = frame + one.spec.offset, 0, 1
    if isinstance(stream, ImageFolder) and stream.n_frames > 1:
        begins, step = stream.first_number, stream.step
    elif len(numbers) == stream.n_frames:
        begins = min(numbers)
    number = begins + index * step
    if len(numbers) != stream.n_frames:
        said.append(
            f"{folder} has {len(numbers)} files, {one.spec.name} {stream.n_frames} images; the one "
            f"with number {number} is taken for frame {frame}"
            + ("" if number in numbers else ", and it is not there")
        )
    elif number not in numbers:
        said.append(f"{folder} has no file with number {number} for frame {frame}")
    return numbers.get(number)
