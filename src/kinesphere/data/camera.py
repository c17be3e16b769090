"""A calibrated camera: where a point appears in the image, which line a pixel looks along."""

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from kinesphere.data.arrays import Array, frozen
from kinesphere.errors import BadCamera
from kinesphere.kernels.cameras import project_kernel, undistort_kernel

_ORTHOGONAL = 1e-3
"""How far ``rotation`` may be from a rotation: text files round."""


@dataclass(frozen=True, eq=False)
class Camera:
    """A pinhole with OpenCV's lens: x right, y down, z ahead; pixel centres at integers."""

    name: str
    width: int
    """Pixels."""
    height: int
    matrix: Array
    """(3, 3) px: focal lengths, skew and principal point."""
    distortion: Array
    """(5,) k1, k2, p1, p2, k3, in OpenCV's order."""
    rotation: Array
    """(3, 3) ``camera_from_world``."""
    translation: Array
    """(3,) m, the world's origin seen from the camera: p_camera = rotation @ p + translation."""

    def __post_init__(self) -> None:
        put = object.__setattr__
        put(self, "matrix", frozen(self.matrix, 3, 3, name=f"matrix of {self.name}"))
        put(self, "distortion", frozen(self.distortion, 5, name=f"distortion of {self.name}"))
        put(self, "translation", frozen(self.translation, 3, name=f"translation of {self.name}"))
        rotation = frozen(self.rotation, 3, 3, name=f"rotation of {self.name}")
        if not (self.width > 0 and self.height > 0):
            raise BadCamera(f"camera {self.name} has {self.width} × {self.height} pixels")
        for part in (self.matrix, self.distortion, self.translation, rotation):
            if np.isnan(part).any():
                raise BadCamera(f"camera {self.name} has a calibration with gaps (NaN)")
        if not (self.matrix[0, 0] > 0 and self.matrix[1, 1] > 0):
            raise BadCamera(
                f"camera {self.name} has focal lengths {self.matrix[0, 0]:g}, "
                f"{self.matrix[1, 1]:g}; both must be positive"
            )
        u, _, vt = np.linalg.svd(rotation)
        if np.linalg.det(rotation) < 0 or np.abs(u @ vt - rotation).max() > _ORTHOGONAL:
            raise BadCamera(
                f"the rotation of camera {self.name} is none: not orthogonal, or mirrored"
            )
        put(self, "rotation", frozen(u @ vt, 3, 3, name="rotation"))

    @cached_property
    def centre(self) -> Array:
        """(3,) m, where the camera stands in the world."""
        centre: Array = -self.rotation.T @ self.translation
        return centre

    @cached_property
    def widest(self) -> float:
        """Squared tangent of the widest angle the lens maps outward; inf for most lenses."""
        k1, k2, _, _, k3 = self.distortion
        turns = np.roots([7 * k3, 5 * k2, 3 * k1, 1.0])  # d/dr of r(1 + k1 r² + k2 r⁴ + k3 r⁶)
        real = turns[np.abs(turns.imag) < 1e-12].real
        return float(min(real[real > 0], default=np.inf))

    def project(self, points: Array) -> Array:
        """Return the pixels of points in the world, (…, 3) m → (…, 2) px.

        NaN behind the camera, and so far aside that the lens model says nothing; pixels outside
        the image are given as they come.
        """
        points = np.asarray(points, dtype=np.float64)
        flat = np.ascontiguousarray(points.reshape(-1, 3))
        pixels = np.empty((len(flat), 2))
        project_kernel(
            flat,
            self.rotation,
            self.translation,
            self.matrix,
            self.distortion,
            self.widest,
            pixels,
        )
        return pixels.reshape(*points.shape[:-1], 2)

    def depths(self, points: Array) -> Array:
        """Return how far points lie ahead of the camera, (…, 3) m → (…) m."""
        ahead: Array = points @ self.rotation[2] + self.translation[2]
        return ahead

    def undistorted(self, pixels: Array) -> Array:
        """Return where pixels' lines of sight meet the plane z = 1 of the camera, (…, 2).

        NaN where the lens sends no line to the pixel.
        """
        pixels = np.asarray(pixels, dtype=np.float64)
        flat = np.ascontiguousarray(pixels.reshape(-1, 2))
        plane = np.empty_like(flat)
        undistort_kernel(flat, self.matrix, self.distortion, self.widest, plane)
        return plane.reshape(pixels.shape)

    def rays(self, pixels: Array) -> Array:
        """Return unit directions of the pixels' lines of sight in the world, (…, 2) → (…, 3)."""
        plane = self.undistorted(pixels)
        ahead = np.concatenate([plane, np.ones((*plane.shape[:-1], 1))], axis=-1)
        ahead /= np.linalg.norm(ahead, axis=-1, keepdims=True)
        directions: Array = ahead @ self.rotation
        return directions

    def lines(self, pixels: Array) -> tuple[Array, Array]:
        """Return the pixels' lines of sight as Plücker lines (n, m), each (…, 3).

        A point X lies on the line where X × n − m = 0 (Rosenhahn et al. 2006, equation 10).
        """
        directions = self.rays(pixels)
        return directions, np.cross(self.centre, directions)

    def turned(self, rotation: Array, shift: Array) -> "Camera":
        """Return the camera in another world, with p_new = rotation @ p_old + shift (m)."""
        turned = self.rotation @ rotation.T
        return replace(self, rotation=turned, translation=self.translation - turned @ shift)

    def resized(self, scale: float) -> "Camera":
        """Return the camera of the image ``scale`` times as large, to the nearest whole pixel."""
        width, height = max(1, round(self.width * scale)), max(1, round(self.height * scale))
        a, b = width / self.width, height / self.height
        # a pixel's centre is at an integer, so its corner, which stays, is at minus one half
        fit = np.array([[a, 0, (a - 1) / 2], [0, b, (b - 1) / 2], [0, 0, 1.0]])
        return replace(self, width=width, height=height, matrix=fit @ self.matrix)

    def cropped(self, left: int, top: int, right: int, bottom: int) -> "Camera":
        """Return the camera of a part of the image, ``right`` and ``bottom`` left out."""
        shift = np.array([[1, 0, -left], [0, 1, -top], [0, 0, 1.0]])
        return replace(self, width=right - left, height=bottom - top, matrix=shift @ self.matrix)
