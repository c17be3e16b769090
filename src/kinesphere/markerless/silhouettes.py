"""Silhouettes to begin with: given masks, a plate's difference, or cut out around a guess."""

from collections.abc import Sequence
from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import NDArray

from kinesphere.data import Array, Frame, Scene
from kinesphere.markerless.cutting import cut_out_together
from kinesphere.markerless.moving import instants_about, moved_since, rooms
from kinesphere.markerless.pieces import largest_piece as largest_piece
from kinesphere.markerless.views import View

Picture = NDArray[np.uint8]

_SHADOW = (0.6, 1.25)
"""How much darker or brighter than on the plate the same thing may be."""
_MOVED_IN = 2
"""Cameras that must see something move."""


@dataclass(frozen=True, eq=False)
class Silhouettes:
    """What a start is looked for in."""

    masks: list[Picture | None]
    """0 to 255 at the views' sizes; None where there is none."""
    cut_out: bool = False
    """Whether they were cut out of the images, not given or told by plates."""
    moved: bool = True
    """Whether two cameras saw something move, which tells of bare arms; of those cut out."""


def start_masks(scene: Scene, views: Sequence[View], frame: Frame) -> Silhouettes:
    """Return silhouettes of one instant in the views.

    Given masks before plates, plates before cutting the person out of the image itself.
    """
    out: list[Picture | None] = []
    for view, picture, mask, plate in zip(
        views, frame.images, frame.masks, scene.plates, strict=True
    ):
        if mask is not None:
            given = view.image(mask)
            piece = largest_piece((given > 127).astype(np.uint8) * 255)
            out.append(np.where(_grown(piece), given, np.uint8(0)))
        elif picture is None:
            out.append(None)
        elif plate is not None:
            out.append(plate_difference(view.image(picture), view.image(plate)))
        else:
            out.append(None)
    if any(mask is not None for mask in out):
        return Silhouettes(out)
    pictures = [
        None if picture is None else view.image(picture)
        for view, picture in zip(views, frame.images, strict=True)
    ]
    moved = [
        None if picture is None or room is None else moved_since(picture, room)
        for picture, room in zip(
            pictures, rooms(views, instants_about(scene, frame.index)), strict=True
        )
    ]
    middle = scene.start.position
    where = looked_at(views) if middle is None else np.array(middle)
    by = sum(mask is not None and bool(mask.any()) for mask in moved)
    masks = cut_out_together(views, pictures, where, moved)
    return Silhouettes(masks, cut_out=True, moved=by >= _MOVED_IN)


def plate_difference(picture: Picture, plate: Picture) -> Picture:
    """Return where an image differs from that of the empty scene, 0 or 255.

    A shadow, or more light, makes a pixel darker or brighter but leaves its channels in
    proportion: what counts is how far a colour is from the line of the plate's own, within
    ``_SHADOW`` of its brightness. The threshold is low, as dark clothes are hardly unlike a
    shadow, but above the noise.
    """
    now, empty = (cv2.GaussianBlur(p, (5, 5), 0).astype(np.float32) for p in (picture, plate))
    square = np.maximum((empty * empty).sum(axis=2), 1.0)
    brightness = np.clip((now * empty).sum(axis=2) / square, *_SHADOW)
    apart = np.sqrt(((now - brightness[..., None] * empty) ** 2).sum(axis=2))
    noise = float(np.median(apart)) + 0.5
    scaled = np.clip(4 * apart, 0, 255).astype(np.uint8)
    otsu, _ = cv2.threshold(scaled, 0, 255, cv2.THRESH_BINARY + cv2.THRESH_OTSU)
    different = apart > np.clip(0.3 * otsu / 4, 4 * noise, 12 * noise)
    return largest_piece(different.astype(np.uint8) * 255)


def _grown(mask: Picture) -> NDArray[np.bool_]:
    return np.asarray(cv2.dilate(mask, np.ones((5, 5), np.uint8)) > 0)


def looked_at(views: Sequence[View]) -> Array:
    """Return the point nearest to the middles of all views' lines of sight, (3,) m."""
    total, right = 1e-6 * np.eye(3), np.zeros(3)
    for view in views:
        across = np.eye(3) - np.outer(view.rotation[2], view.rotation[2])
        total += across
        right += across @ view.centre
    return np.asarray(np.linalg.solve(total, right))
