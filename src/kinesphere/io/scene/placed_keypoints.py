"""Keypoints in space, from a TRC file: which row, in which axes."""

from collections.abc import Sequence
from pathlib import Path

import numpy as np

from kinesphere.data import Array, Camera
from kinesphere.data.keypoints import KEYPOINTS, PlacedKeypoints
from kinesphere.errors import BadScene, UnreadableFile
from kinesphere.io.keypoints import keypoint_columns
from kinesphere.io.trc import read_trc

WITHOUT = "; the start is found by the images instead"
"""What follows where keypoints do not serve."""
_Y_UP = np.array([[0.0, 0, 1], [1, 0, 0], [0, 1, 0]])
"""From axes with y up to a calibration with z up, as Pose2Sim turns its TRC files."""


def placed_keypoints(
    path: Path, axes: str | None, cameras: Sequence[Camera], turn: Array, frame: int, n_frames: int
) -> tuple[PlacedKeypoints | None, list[str]]:
    """Return a TRC file's keypoints of one frame, and what is to be said about them.

    Parameters are those of `start_keypoints`.

    Raises
    ------
    UnreadableFile
        If it is no TRC file, or none of its labels is a keypoint's.
    BadScene
        If the calibration has not the axes that the file's are said to stand to.
    """
    recording = read_trc(path)
    columns = keypoint_columns(recording.labels)
    if not columns:
        shown = ", ".join(recording.labels[:6])
        raise UnreadableFile(
            f"{path}: no label is a keypoint's ({shown}, …); RShoulder or right_hip is"
        )
    said = list(recording.history[0].warnings)
    row = frame
    if recording.n_frames != n_frames:
        row = frame - recording.first_frame
        said.append(
            f"{path} has {recording.n_frames} rows, the cameras {n_frames} frames; the row with "
            f"Frame# {frame} is taken"
        )
    points = np.full((len(KEYPOINTS), 3), np.nan)
    if 0 <= row < recording.n_frames:
        for name, column in columns.items():
            points[KEYPOINTS.index(name)] = recording.markers[row, column]
    if not np.isfinite(points).any():
        return None, [*said, f"{path} shows nobody in frame {frame}{WITHOUT}"]
    choices = {"calibration": points @ turn.T}
    if turn[1, 2] == 1:  # the calibration has z up
        choices["y-up"] = points @ (turn @ _Y_UP).T
    if axes is None:
        fits = {name: _fit(p, cameras) for name, p in choices.items()}
        axes = max(fits, key=lambda name: fits[name])
        if len(choices) > 1:
            said.append(
                f'{path} does not say its axes; keypoints_axes = "{axes}" is guessed, as the '
                "person is upright and in the images then"
            )
    elif axes not in choices:
        raise BadScene(f'keypoints_axes = "{axes}" is for calibrations with z up; this one has not')
    placed = choices[axes]
    if _inside(placed, cameras) < 0.5:
        return None, [*said, f"{path}: its keypoints lie outside most images{WITHOUT}"]
    return PlacedKeypoints(placed), said


def _fit(points: Array, cameras: Sequence[Camera]) -> float:
    """Return how well points suit axes: the share inside the images, and how upright they are."""
    at = {n: p for n, p in zip(KEYPOINTS, points, strict=True) if np.isfinite(p).all()}
    top, low = (
        [at[n] for n in at if n.endswith(joints)]
        for joints in (("shoulder", "hip"), ("knee", "ankle"))
    )
    if not (top and low):
        return _inside(points, cameras)
    rise = np.mean(top, axis=0) - np.mean(low, axis=0)
    upright = rise[1] / max(float(np.linalg.norm(rise)), 1e-9)
    return _inside(points, cameras) + 0.5 * float(upright)


def _inside(points: Array, cameras: Sequence[Camera]) -> float:
    known = points[np.isfinite(points).all(axis=1)]
    shares = []
    for camera in cameras:
        pixels = camera.project(known)
        with np.errstate(invalid="ignore"):
            inside = (pixels >= 0) & (pixels < (camera.width, camera.height))
        shares.append(inside.all(axis=1).mean())
    return float(np.mean(shares))
