"""Keypoints as pose estimators write them: OpenPose's JSON, and the labels of TRC files.

Which set a JSON file holds is told by how many keypoints a person has: COCO 17, OpenPose's COCO 18,
BODY_25, HALPE_26, and the two whole-body sets that begin with these (133 and 136).
"""

import re
from collections.abc import Sequence
from pathlib import Path

import numpy as np

from kinesphere.data import Array
from kinesphere.data.keypoints import KEYPOINTS
from kinesphere.errors import UnreadableFile
from kinesphere.io.json_files import read_json

_BEYOND = 1e6
"""px; no image is as large, and what lies there was not seen."""
_ARMS = ("shoulder", "elbow", "wrist")
_LEGS = ("hip", "knee", "ankle")


def _both(*joints: str) -> list[str]:
    return [f"{side}_{joint}" for joint in joints for side in ("left", "right")]


def _of(side: str, *joints: str) -> list[str]:
    return [f"{side}_{joint}" for joint in joints]


_COCO = ["nose", *_both("eye", "ear", *_ARMS, *_LEGS)]
_ARMS_FIRST = ["nose", "neck", *_of("right", *_ARMS), *_of("left", *_ARMS)]
_LEGS_NEXT = [*_of("right", *_LEGS), *_of("left", *_LEGS)]
_FACE = ["right_eye", "left_eye", "right_ear", "left_ear"]
_FOOT = ("big_toe", "small_toe", "heel")
_HALPE = [*_COCO, "head", "neck", "hip", *_both(*_FOOT)]

SETS: dict[int, tuple[str, tuple[str, ...]]] = {
    17: ("COCO", tuple(_COCO)),
    18: ("COCO_18", (*_ARMS_FIRST, *_LEGS_NEXT, *_FACE)),
    25: (
        "BODY_25",
        (*_ARMS_FIRST, "mid_hip", *_LEGS_NEXT, *_FACE, *_of("left", *_FOOT), *_of("right", *_FOOT)),
    ),
    26: ("HALPE_26", tuple(_HALPE)),
    133: ("COCO_133", (*_COCO, *_of("left", *_FOOT), *_of("right", *_FOOT))),
    136: ("HALPE_136", tuple(_HALPE)),
}
"""Number of keypoints → the set's name and its first keypoints; faces and fingers are not used."""


def read_people(path: Path) -> Array:
    """Return the people in one image, (n_people, n_keypoints, 3): x, y in px and confidence.

    Keypoints are in the order of `KEYPOINTS`; NaN, NaN, 0 stands for one that was not seen.

    Raises
    ------
    UnreadableFile
        If it is no such file, or the number of keypoints is that of no known set.
    """
    said = read_json(path, nan=True)
    people = said.get("people") if isinstance(said, dict) else None
    if not isinstance(people, list):
        raise UnreadableFile(
            f'{path} holds no "people": {{"people": [{{"pose_keypoints_2d": [x, y, c, …]}}]}} '
            "is what pose estimators write"
        )
    found = [_person(person, path) for person in people]
    return np.array([one for one in found if one is not None]).reshape(-1, len(KEYPOINTS), 3)


def _person(person: object, path: Path) -> Array | None:
    numbers = person.get("pose_keypoints_2d") if isinstance(person, dict) else None
    if numbers == [] or person == {}:
        return None  # somebody whom other programs took out
    if not isinstance(numbers, list):
        raise UnreadableFile(f'{path}: a person without "pose_keypoints_2d": [x, y, c, …]')
    try:
        flat = np.array([np.nan if n is None else n for n in numbers], dtype=np.float64)
    except (TypeError, ValueError, OverflowError):
        raise UnreadableFile(
            f"{path}: pose_keypoints_2d holds something else than numbers"
        ) from None
    if flat.ndim != 1 or flat.size % 3 or flat.size // 3 not in SETS:
        known = ", ".join(f"{n} ({name})" for n, (name, _) in SETS.items())
        raise UnreadableFile(
            f"{path}: {flat.size} numbers are {flat.size / 3:g} keypoints of x, y, c; known are "
            f"{known}"
        )
    rows = flat.reshape(-1, 3)
    out = np.tile([np.nan, np.nan, 0.0], (len(KEYPOINTS), 1))
    for name, row in zip(SETS[len(rows)][1], rows, strict=False):
        if name in KEYPOINTS and row[2] > 0 and (np.abs(row) < _BEYOND).all():
            out[KEYPOINTS.index(name)] = (row[0], row[1], min(row[2], 1.0))
    return out


def keypoint_columns(labels: Sequence[str]) -> dict[str, int]:
    """Return which labels are keypoints: ``RShoulder``, ``right_shoulder``, ``shoulder.r``."""
    found: dict[str, int] = {}
    for column, label in enumerate(labels):
        name = _spelt_out(label)
        if name in KEYPOINTS:
            found.setdefault(name, column)
    return found


def _spelt_out(label: str) -> str:
    words = [w.lower() for w in re.findall(r"[A-Z]?[a-z]+|[A-Z]", label)]
    side = [w for w in words if w in ("l", "r", "left", "right")]
    rest = "_".join(w for w in words if w not in side)
    if not side:
        return rest
    return f"{'left' if side[0].startswith('l') else 'right'}_{rest}"
