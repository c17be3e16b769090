"""The part of each camera's images that shows the person, with the model drawn over it."""

from collections.abc import Iterable
from dataclasses import dataclass, replace

import numpy as np

from kinesphere.data import Array, Camera, Frame, Image, Scene
from kinesphere.markerless import TrackedMotion
from kinesphere.markerless.drawing import overlay

_ROOM = 0.08
"""Around the body, as a share of what it takes up."""
_FLESH = 0.1
"""m around joints and limbs' ends in which the body's surface lies."""

_SKINS = 12
"""Frames whose skin is looked at, too."""
_SPARSE = 5
"""Of its vertices every so many."""


@dataclass(frozen=True, eq=False)
class Panel:
    """A camera's window on the person: always the same part of its image, at one size."""

    left: int
    top: int
    right: int
    bottom: int
    camera: Camera
    """Of that part, at the image's own scale."""
    scale: float = 1.0
    """Size against the image's, at most 1."""

    @property
    def size(self) -> tuple[int, int]:
        """Width and height, px."""
        shown = self.camera.resized(self.scale)
        return shown.width, shown.height

    def within(self, width: float, height: float) -> "Panel":
        """Return the panel as large as fits in so many pixels; nothing is enlarged."""
        scale = min(1.0, width / self.camera.width, height / self.camera.height)
        return replace(self, scale=scale)

    def cut(self, image: Image | None) -> Image:
        """Return that part of an image; black where there is none."""
        if image is None:
            return np.zeros((self.bottom - self.top, self.right - self.left, 3), dtype=np.uint8)
        return image[self.top : self.bottom, self.left : self.right]


def panels_for(
    scene: Scene, tracked: TrackedMotion, frames: Iterable[int], largest: float
) -> list[Panel]:
    """Return a panel for each camera, wide enough for the body in all these frames.

    Parameters
    ----------
    frames
        Of the scene.
    largest
        px, longest side of a panel; nothing is enlarged.
    """
    i = np.array(list(frames), dtype=int)
    ends = tracked.origins[i] + (tracked.rotations[i] @ tracked.ends[..., None])[..., 0]
    joints = np.concatenate([tracked.origins[i], ends]).reshape(-1, 3)
    joints = joints[np.isfinite(joints).all(axis=1)]
    around = _FLESH * np.array([[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)])
    # a head that is one with the trunk has no joint: in some frames the skin itself is looked at
    some = i[tracked.solved[i]]
    some = some[:: max(1, -(-len(some) // _SKINS))]
    skins = [tracked.body.vertices(tracked.parameters[k])[::_SPARSE] for k in some]
    points = np.concatenate([(joints[:, None] + around).reshape(-1, 3), *skins])
    found = []
    for camera in scene.cameras:
        left, top, right, bottom = _box(camera, points)
        part = camera.cropped(left, top, right, bottom)
        found.append(Panel(left, top, right, bottom, part).within(largest, largest))
    return found


def drawn_panels(frame: Frame, panels: list[Panel], tracked: TrackedMotion) -> list[Image]:
    """Return what each camera shows of a frame, the model over it where it has a pose."""
    body, i = tracked.body, frame.index
    if tracked.solved[i]:
        skin = body.vertices(tracked.parameters[i])
    else:
        skin = np.full((int(body.faces.max()) + 1, 3), np.nan)
    return [
        overlay(
            panel.cut(image),
            panel.camera,
            skin,
            body.faces,
            body.limb_of_face,
            tracked.limb_names,
            tracked.lost[i],
            panel.scale,
        )
        for panel, image in zip(panels, frame.images, strict=True)
    ]


def _box(camera: Camera, points: Array) -> tuple[int, int, int, int]:
    """Return left, top, right, bottom of what is shown of a camera: the body and some room."""
    pixels = camera.project(points)
    pixels = pixels[np.isfinite(pixels).all(axis=1)]
    if not len(pixels):
        return 0, 0, camera.width, camera.height
    low, high = pixels.min(axis=0), pixels.max(axis=0)
    room = _ROOM * (high - low).max()
    left, top = np.clip(low - room, 0, [camera.width - 2, camera.height - 2]).astype(int)
    right, bottom = np.clip(high + room, [left + 2, top + 2], [camera.width, camera.height])
    return int(left), int(top), int(right), int(bottom)
