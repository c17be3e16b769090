"""Silhouettes to begin with: given masks, a plate's difference, or cut out around a guess."""

from collections.abc import Sequence

import cv2
import numpy as np
from numpy.typing import NDArray

from kinesphere.data import Array, Frame, Scene
from kinesphere.markerless.kernels.contour import project_kernel
from kinesphere.markerless.views import View

Picture = NDArray[np.uint8]

_SHADOW = (0.6, 1.25)
"""How much darker or brighter than on the plate the same thing may be."""
_CUT = 240
"""px; longer side of the images that are cut: GrabCut is slow."""


def start_masks(scene: Scene, views: Sequence[View], frame: Frame) -> list[Picture | None]:
    """Return silhouettes of one instant in the views, 0 to 255; None where there is none.

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
        return out
    middle = scene.start.position
    where = looked_at(views) if middle is None else np.array(middle)
    return [
        None if picture is None else cut_out(view, view.image(picture), where)
        for view, picture in zip(views, frame.images, strict=True)
    ]


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


def largest_piece(mask: Picture) -> Picture:
    """Return the largest connected piece of a mask, small gaps closed."""
    closed = cv2.morphologyEx(mask, cv2.MORPH_CLOSE, np.ones((5, 5), np.uint8))
    closed = cv2.morphologyEx(closed, cv2.MORPH_OPEN, np.ones((3, 3), np.uint8))
    n, labels, stats, _ = cv2.connectedComponentsWithStats(closed)
    if n < 2:
        return np.zeros_like(mask)
    best = 1 + int(np.argmax(stats[1:, cv2.CC_STAT_AREA]))
    return np.asarray((labels == best) * 255, dtype=np.uint8)


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


def cut_out(view: View, picture: Picture, middle: Array) -> Picture:
    """Return a person cut out of an image by GrabCut, from a guess of where the middle is.

    Surely background is what lies beyond an arm's reach of an upright person there; probably the
    person's is a column about the middle (Rother et al. 2004, doi:10.1145/1015706.1015720).
    """
    scale = min(1.0, _CUT / max(view.width, view.height))
    size = (round(view.width * scale), round(view.height * scale))
    small = cv2.resize(picture, size, interpolation=cv2.INTER_AREA)
    labels = np.full(small.shape[:2], cv2.GC_BGD, dtype=np.uint8)
    for radius, low, high, label in (
        (0.75, -1.15, 1.25, cv2.GC_PR_BGD),
        (0.18, -0.85, 0.75, cv2.GC_PR_FGD),
    ):
        hull = _cylinder(view, middle, radius, low, high) * scale
        cv2.fillConvexPoly(labels, cv2.convexHull(np.rint(hull).astype(np.int32)), label)
    if not (labels == cv2.GC_PR_FGD).any() or not (labels == cv2.GC_BGD).any():
        return np.zeros(picture.shape[:2], dtype=np.uint8)
    cv2.setRNGSeed(0)  # GrabCut draws its first clusters at random
    models = np.zeros((1, 65)), np.zeros((1, 65))
    bgr = np.ascontiguousarray(small[..., ::-1])
    cv2.grabCut(bgr, labels, [0, 0, 1, 1], *models, 6, cv2.GC_INIT_WITH_MASK)
    person = ((labels == cv2.GC_FGD) | (labels == cv2.GC_PR_FGD)).astype(np.uint8) * 255
    whole = cv2.resize(largest_piece(person), (view.width, view.height))
    return np.asarray((whole > 127) * 255, dtype=np.uint8)


def _cylinder(view: View, middle: Array, radius: float, low: float, high: float) -> Array:
    turn = np.linspace(0, 2 * np.pi, 16, endpoint=False)
    ring = np.stack([radius * np.cos(turn), np.zeros(16), radius * np.sin(turn)], axis=1)
    points = np.concatenate([middle + ring + [0, y, 0] for y in (low, high)])
    pixels, depths = np.empty((32, 2)), np.empty(32)
    project_kernel(points, view.rotation, view.shift, view.lens, pixels, depths)
    return pixels[np.isfinite(pixels).all(axis=1)]
