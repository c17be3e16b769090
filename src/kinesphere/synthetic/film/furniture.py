"""Things that stand between a camera and the person, and hide some of them."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from kinesphere.data import Array, Camera

_AWAY = 1.25
"""m from the middle of the room, towards the camera: out of reach of arms and legs."""
_ASIDE = 0.15
"""m, how far beside the line of sight to the middle at most: trunk or arms lie behind."""
_POST = (0.12, 2.4, 0.12)
"""m, width, height and depth."""


@dataclass(frozen=True, eq=False)
class Furniture:
    """Boxes as one surface of flat sides."""

    vertices: Array
    """(n, 3) m."""
    normals: Array
    """(n, 3) unit vectors."""
    colours: Array
    """(n, 3), 0–255."""
    faces: NDArray[np.int32]
    """(n_faces, 3), counted from 0."""


def posts_before(cameras: Sequence[Camera], rng: np.random.Generator) -> Furniture:
    """Return a post before each of some cameras."""
    if not cameras:
        none = np.empty((0, 3))
        return Furniture(none, none, none, np.empty((0, 3), dtype=np.int32))
    low = []
    for camera in cameras:
        towards = camera.centre * [1.0, 0.0, 1.0]
        towards /= np.linalg.norm(towards)
        aside = np.cross(towards, [0.0, 1.0, 0.0])
        low.append(_AWAY * towards + rng.uniform(-_ASIDE, _ASIDE) * aside)
    colours = rng.uniform(40, 190, (len(low), 3))
    boxes = [_box(foot, np.array(_POST)) for foot in low]
    sides = np.concatenate([box for box, _ in boxes])
    return Furniture(
        vertices=sides.reshape(-1, 3),
        normals=np.concatenate([normals for _, normals in boxes]).repeat(4, axis=0),
        colours=colours.repeat(24, axis=0),
        faces=np.concatenate([[[i, i + 1, i + 2], [i, i + 2, i + 3]]
                              for i in range(0, 4 * len(sides), 4)]).astype(np.int32),
    )  # fmt: skip


def _box(foot: Array, size: Array) -> tuple[Array, Array]:
    """Return the sides of a box that stands on a point, (6, 4, 3), and their normals, (6, 3)."""
    sides, normals = [], []
    for axis in range(3):
        for sign in (-1.0, 1.0):
            normal = np.zeros(3)
            normal[axis] = sign
            u, v = np.roll(np.eye(3)[axis], 1), np.roll(np.eye(3)[axis], 2)
            if sign < 0:
                u, v = v, u  # anticlockwise, seen from outside
            sides.append([normal + a * u + b * v for a, b in ((-1, -1), (1, -1), (1, 1), (-1, 1))])
            normals.append(normal)
    middle = foot + np.array([0.0, size[1] / 2, 0.0])
    return middle + np.array(sides) * size / 2, np.array(normals)
