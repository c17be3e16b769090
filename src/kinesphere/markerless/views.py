"""Cameras as the tracker uses them: pinholes at a working size, images brought to them."""

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import cv2
import numpy as np
from numpy.typing import NDArray

from kinesphere.data import Array, Camera


@dataclass(frozen=True, eq=False)
class View:
    """A camera without lens distortion or skew, at the size images are worked on."""

    camera: Camera
    """As calibrated."""
    width: int
    height: int
    lens: Array
    """(4,) fx, fy, cx, cy in px."""

    @property
    def rotation(self) -> Array:
        """(3, 3) ``camera_from_world``."""
        return self.camera.rotation

    @property
    def shift(self) -> Array:
        """(3,) m."""
        return self.camera.translation

    @property
    def centre(self) -> Array:
        """(3,) m, where the camera stands."""
        return self.camera.centre

    @cached_property
    def maps(self) -> tuple[NDArray[np.float32], NDArray[np.float32]] | None:
        """Where each pixel of the view is in the camera's own image; None if at the same place."""
        plain = not self.camera.distortion.any() and self.camera.matrix[0, 1] == 0
        if plain and (self.width, self.height) == (self.camera.width, self.camera.height):
            return None
        fx, fy, cx, cy = self.lens
        col, row = np.meshgrid(np.arange(self.width), np.arange(self.height))
        lines = np.stack([(col - cx) / fx, (row - cy) / fy, np.ones_like(col, dtype=float)], -1)
        world = (lines - self.shift) @ self.rotation
        pixels = self.camera.project(world).astype(np.float32)
        return np.ascontiguousarray(pixels[..., 0]), np.ascontiguousarray(pixels[..., 1])

    def image(self, picture: NDArray[Any]) -> NDArray[np.uint8]:
        """Return a camera's image, (h, w, 3) or a mask (h, w), as this view would have taken it.

        Masks become 0 to 255. Pixels beyond the image's edge repeat it.
        """
        if picture.dtype == np.bool_:
            picture = picture.astype(np.uint8) * 255
        if self.maps is None:
            return np.ascontiguousarray(picture)
        ratio = self.width / self.camera.width
        if ratio < 0.75:  # averaged first, so that nothing is skipped over
            blur = 0.5 * (1 / ratio - 1) + 0.2
            picture = cv2.GaussianBlur(picture, (0, 0), blur)
        seen = cv2.remap(
            picture, *self.maps, interpolation=cv2.INTER_LINEAR, borderMode=cv2.BORDER_REPLICATE
        )
        return np.asarray(seen, dtype=np.uint8)


def view_of(camera: Camera, largest: int) -> View:
    """Return the view of a camera, with a longer side of at most ``largest`` px."""
    scale = min(1.0, largest / max(camera.width, camera.height))
    small = camera.resized(scale)
    m = small.matrix
    lens = np.array([m[0, 0], m[1, 1], m[0, 2], m[1, 2]])
    return View(camera, small.width, small.height, lens)
