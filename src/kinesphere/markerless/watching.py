"""How a scene is watched: images or masks, forward or backwards."""

from collections.abc import Iterator, Sequence
from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

from kinesphere.data import Frame, Scene

Pictures: TypeAlias = Sequence[NDArray[np.uint8] | None]

_CHUNK = 24
"""Frames held at once where a film is watched backwards."""


def masks_throughout(scene: Scene, first: int) -> bool:
    """Return whether the scene is followed by masks, as far as a look beside the first one tells.

    Masks of single frames serve the start; between them the person is found by colours, as they
    are where masks end.
    """
    if not scene.has_masks:
        return False
    beside = first + 1 if first + 1 < scene.n_frames else max(0, first - 1)
    return any(mask is not None for mask in scene.frame(beside).masks)


def pictures_of(frame: Frame, masks: bool) -> Pictures:
    """Return what the tracker looks at: the frame's masks or its images."""
    if not masks:
        return frame.images
    return [None if m is None else m.astype(np.uint8) * 255 for m in frame.masks]


def backwards(scene: Scene, first: int) -> Iterator[Frame]:
    """Yield the first frame and those before it, the last one first; nothing if there is none."""
    stop = first + 1 if first else 0
    while stop > 0:
        begin = max(0, stop - _CHUNK)
        yield from reversed(list(scene.frames(begin, stop)))
        stop = begin
