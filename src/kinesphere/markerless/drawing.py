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
    inside = ids != NOTHING
    limbs = np.where(inside, limb_of_face[np.maximum(ids, 0)], -1)
    corners = vertices[faces]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    normals /= np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), 1e-12)
    towards = seen.centre - corners.mean(axis=1)
    towards /= np.linalg.norm(towards, axis=1, keepdims=True)
    facing = np.clip((normals * towards).sum(axis=1), 0, 1)
    shade = (0.45 + 0.55 * facing)[np.maximum(ids, 0)]
    gone = np.zeros(len(names), dtype=bool) if lost is None else lost
    colours = limb_colours(names).astype(np.float64)
    colours[gone] = _LOST
    paint = colours[limbs] * shade[..., None]
    strength = np.where(inside, np.where(gone[limbs], 0.15, _STRENGTH), 0.0)[..., None]
    edge = _edges(limbs)
    paint = np.where(edge[..., None], colours[np.maximum(limbs, 0)], paint)
    strength = np.where(edge[..., None], 0.9, strength)
    mixed: Image = (picture * (1 - strength) + paint * strength).round().astype(np.uint8)
    return mixed


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
