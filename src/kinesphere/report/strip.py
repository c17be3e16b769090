"""A strip of pictures: the model over every camera, a row a frame."""

from collections.abc import Callable

import numpy as np

from kinesphere.data import Image, Scene
from kinesphere.markerless import TrackedMotion
from kinesphere.report.panels import drawn_panels, panels_for

STRIP_FRAMES = 5
"""Rows of the strip."""
_PANEL = 340.0
"""px, longest side of one picture."""
_GAP = 4


def overlay_strip(
    scene: Scene,
    tracked: TrackedMotion,
    n_frames: int = STRIP_FRAMES,
    progress: Callable[[str, int, int], None] | None = None,
) -> tuple[Image, list[int]]:
    """Return pictures of every camera with the model over them, a row a frame, and which frames.

    Frames are spread evenly over the scene; the frame with the least support of a limb is among
    them, as it shows where to look.
    """
    frames = shown_frames(tracked, n_frames)
    panels = panels_for(scene, tracked, frames, _PANEL)
    rows = []
    for i, index in enumerate(frames):
        if progress is not None:
            progress("pictures", i, len(frames))
        rows.append(side_by_side(drawn_panels(scene.frame(index), panels, tracked)))
    padded = [np.pad(row, ((0, _GAP), (0, 0), (0, 0))) for row in rows]
    return np.vstack(padded)[:-_GAP], frames


def shown_frames(tracked: TrackedMotion, n_frames: int) -> list[int]:
    """Return the frames that a strip shows, in their order."""
    last = tracked.n_frames - 1
    chosen = set(np.linspace(0, last, min(n_frames, tracked.n_frames)).round().astype(int).tolist())
    known = np.isfinite(tracked.support)
    worst = np.where(known, tracked.support, np.inf).min(axis=1)
    if np.isfinite(worst).any():
        chosen.add(int(np.argmin(worst)))
    return sorted(chosen)


def side_by_side(pictures: list[Image]) -> Image:
    """Return pictures in a row, aligned at the top, black between them."""
    height = max(len(picture) for picture in pictures)
    padded = [np.pad(p, ((0, height - len(p)), (0, _GAP), (0, 0))) for p in pictures]
    return np.hstack(padded)[:, :-_GAP]
