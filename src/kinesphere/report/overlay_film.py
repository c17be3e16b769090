"""The model drawn over every camera, as a video that plays in a browser."""

import io
import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from kinesphere.data import Image, Scene
from kinesphere.io.images import opencv
from kinesphere.io.video import VideoWriter
from kinesphere.markerless import TrackedMotion
from kinesphere.report.panels import Panel, drawn_panels, panels_for

_WIDTH, _HEIGHT = 1280, 720
"""px that all cameras together take at most; nothing is enlarged."""
_RATE = 30.0
"""Pictures a second at most: of faster cameras every second, third, … frame is shown."""
_LINE = 20
"""px of a line of words."""
_GAP = 4
_QUALITY = 26


def overlay_film(
    scene: Scene,
    tracked: TrackedMotion,
    progress: Callable[[str, int, int], None] | None = None,
) -> tuple[bytes, Image]:
    """Return an MP4 of all cameras side by side, the model over them, as fast as it happened.

    Each camera's panel shows the same part of its image throughout, above it the camera's name and
    overlap; below all are frame, time and the limbs held lost.

    Returns
    -------
    video
        The file's bytes.
    poster
        Its first picture.

    Raises
    ------
    MissingExtra
        If PyAV or OpenCV is not installed.
    """
    every = max(1, math.ceil(scene.rate / _RATE - 1e-6))
    sheet = sheet_for(panels_for(scene, tracked, range(tracked.n_frames), math.inf))
    names = [camera.name for camera in scene.cameras]
    target = io.BytesIO()
    poster: Image | None = None
    with VideoWriter(target, scene.rate / every, _QUALITY) as video:
        for frame in scene.frames(*_reached(tracked), every):
            if progress is not None:
                progress("video", frame.index, scene.n_frames)
            titles = [
                name if np.isnan(share) else f"{name}  {share:.2f}"
                for name, share in zip(names, tracked.overlap[frame.index], strict=True)
            ]
            pictures = drawn_panels(frame, list(sheet.panels), tracked)
            picture = sheet.arranged(pictures, titles, _words(scene, tracked, frame.index))
            poster = picture if poster is None else poster
            video.add(picture)
    assert poster is not None  # a scene has a frame
    return target.getvalue(), poster


@dataclass(frozen=True)
class Sheet:
    """Panels in rows and columns of one size."""

    panels: tuple[Panel, ...]
    columns: int
    width: int
    """px of a column, and below of a row."""
    height: int

    def arranged(self, pictures: list[Image], titles: list[str], words: str) -> Image:
        """Return pictures in their places, titles above them, and words below all."""
        across = self.columns * self.width
        down = math.ceil(len(pictures) / self.columns) * self.height + _LINE
        sheet = np.zeros((down + down % 2, across + across % 2, 3), dtype=np.uint8)  # for H.264
        for i, (picture, title) in enumerate(zip(pictures, titles, strict=True)):
            top, left = i // self.columns * self.height, i % self.columns * self.width
            _write(sheet, title, (left + 4, top + _LINE - 6))
            top += _LINE
            sheet[top : top + picture.shape[0], left : left + picture.shape[1]] = picture
        _write(sheet, words, (4, down - 6))
        return sheet


def sheet_for(panels: list[Panel]) -> Sheet:
    """Return the arrangement that shows the cameras largest."""
    n = len(panels)
    wide, high = (max(sides) for sides in zip(*(panel.size for panel in panels), strict=True))

    def cell(columns: int) -> tuple[float, float]:
        return _WIDTH / columns - _GAP, (_HEIGHT - _LINE) / math.ceil(n / columns) - _LINE - _GAP

    columns = max(range(1, n + 1), key=lambda k: min(cell(k)[0] / wide, cell(k)[1] / high))
    fitted = tuple(panel.within(*cell(columns)) for panel in panels)
    width, height = (max(sides) for sides in zip(*(panel.size for panel in fitted), strict=True))
    return Sheet(fitted, columns, width + _GAP, height + _GAP + _LINE)


def _reached(tracked: TrackedMotion) -> tuple[int, int]:
    """Return the frames to show: all, or those that tracking reached before it was interrupted."""
    found = np.flatnonzero(tracked.solved)
    if tracked.n_reached is None or not len(found):
        return 0, tracked.n_frames
    return int(found[0]), int(found[-1]) + 1


def _words(scene: Scene, tracked: TrackedMotion, index: int) -> str:
    said = f"frame {scene.first_frame + index + 1}   {index / scene.rate:.2f} s"
    if not tracked.solved[index]:
        return said + "   no pose"
    lost = [n for n, gone in zip(tracked.limb_names, tracked.lost[index], strict=True) if gone]
    return said + (f"   lost: {', '.join(lost)}" if lost else "")


def _write(picture: Image, words: str, place: tuple[int, int]) -> None:
    """Write words into a picture; letters beyond ASCII become ?, as OpenCV has no others."""
    cv2 = opencv()
    plain = words.encode("ascii", "replace").decode()
    cv2.putText(picture, plain, place, cv2.FONT_HERSHEY_SIMPLEX, 0.45, (230,) * 3, 1, cv2.LINE_AA)
