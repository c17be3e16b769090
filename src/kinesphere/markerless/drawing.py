"""The model drawn over what a camera saw, for a person to judge."""

import numpy as np
from numpy.typing import NDArray

from kinesphere.data import Array, Camera, Image, Mask
from kinesphere.geometry.raster import NOTHING, visible_faces

_COLOURS = {
    "pelvis": (120, 120, 128),
    "trunk": (86, 132, 190),
    "head": (214, 170, 96),
    "upper_arm": (72, 160, 120),
    "forearm": (236, 140, 60),
    "hand": (214, 84, 74),
    "thigh": (124, 104, 186),
    "shank": (70, 150, 176),
    "foot": (190, 96, 150),
}
"""By kind of limb; the right side is darker than the left."""
_LOST = (255, 20, 20)
_STRENGTH = 0.5
"""How much of a limb's colour covers the image."""
_OPEN = 0.15
"""The same for one that is lost, and for outlines."""
_OUTLINE = 0.9


def limb_colours(names: tuple[str, ...]) -> NDArray[np.uint8]:
    """Return a colour for each limb, (n, 3)."""
    colours = []
    for name in names:
        kind = name.split("_", 1)[1] if name.startswith(("left_", "right_")) else name
        colour = np.array(_COLOURS.get(kind, (150, 150, 150)), dtype=np.float64)
        colours.append(colour * (0.72 if name.startswith("right_") else 1.0))
    return np.array(colours).round().astype(np.uint8)


def overlay(
    image: Image,
    camera: Camera,
    vertices: Array,
    faces: NDArray[np.int32],
    limb_of_face: NDArray[np.int32],
    names: tuple[str, ...],
    lost: Mask | None = None,
    scale: float = 1.0,
) -> Image:
    """Return an image with the body over it: limbs coloured and shaded, outlined where they end.

    Parameters
    ----------
    image : (height, width, 3)
    camera
    vertices : (n_vertices, 3) m
        NaN throughout where there is no pose: the image comes back as it is.
    faces : (n_faces, 3)
    limb_of_face : (n_faces,)
    names
        Of the limbs.
    lost : (n_limbs,)
        Limbs held lost are drawn in red, without filling.
    scale
        Size of the picture against the image's.
    """
    seen = camera.resized(scale)
    picture = _resized(image, seen.width, seen.height)
    if not np.isfinite(vertices).all():
        return picture
    ids, _ = visible_faces(
        seen.project(vertices), seen.depths(vertices), faces, seen.width, seen.height
    )
    body = np.nonzero(ids != NOTHING)  # the rest stays as it is, and is most of the picture
    face = ids[body]
    limbs = np.full(ids.shape, -1, dtype=np.int32)
    limbs[body] = limb = limb_of_face[face]
    gone = np.zeros(len(names), dtype=bool) if lost is None else lost
    colours = limb_colours(names).astype(np.float64)
    colours[gone] = _LOST
    edge = _edges(limbs)[body]
    shade = np.where(edge, 1.0, _shades(seen, vertices, faces)[face])
    strength = np.where(edge, _OUTLINE, np.where(gone[limb], _OPEN, _STRENGTH))[:, None]
    paint = colours[limb] * shade[:, None]
    mixed = picture.copy()
    mixed[body] = (picture[body] * (1 - strength) + paint * strength).round().astype(np.uint8)
    return mixed


def _shades(camera: Camera, vertices: Array, faces: NDArray[np.int32]) -> Array:
    """Return how bright a face is under a lamp at the camera, (n_faces,) up to 1."""
    corners = vertices[faces]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    normals /= np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), 1e-12)
    towards = camera.centre - corners.mean(axis=1)
    towards /= np.linalg.norm(towards, axis=1, keepdims=True)
    shades: Array = 0.45 + 0.55 * np.clip((normals * towards).sum(axis=1), 0, 1)
    return shades


def _edges(limbs: NDArray[np.int32]) -> Mask:
    """Return the pixels of limbs that touch something else."""
    edge = np.zeros(limbs.shape, dtype=bool)
    across, down = limbs[:, 1:] != limbs[:, :-1], limbs[1:] != limbs[:-1]
    edge[:, 1:] |= across
    edge[:, :-1] |= across
    edge[1:] |= down
    edge[:-1] |= down
    return edge & (limbs >= 0)


def _resized(image: Image, width: int, height: int) -> Image:
    import cv2

    if image.shape[:2] == (height, width):
        return image
    smaller: Image = np.asarray(
        cv2.resize(image, (width, height), interpolation=cv2.INTER_AREA), dtype=np.uint8
    )
    return smaller
