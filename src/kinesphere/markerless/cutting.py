"""A person cut out of all cameras' images together, where there is neither mask nor plate.

GrabCut (Rother et al. 2004, doi:10.1145/1015706.1015720) begins with a guess of where the person
is: upright, or on the floor. What most cameras then agree on in space, they are asked again about:
a wall of the shirt's colour is in one camera's silhouette, but in no other's.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import cv2
import numpy as np
from numpy.typing import NDArray

from kinesphere.data import Array, Mask
from kinesphere.markerless.hull import largest_piece_of_space
from kinesphere.markerless.kernels.contour import project_kernel
from kinesphere.markerless.pieces import largest_piece
from kinesphere.markerless.views import View
from kinesphere.markerless.walls import grown, without_room

Picture = NDArray[np.uint8]

_CUT = 240
"""px; longer side of the images that are cut: GrabCut is slow."""
_ROUNDS = 2
"""Times the cameras are asked again."""
_SIDE = 0.04
"""m, of the cubes of space they agree on."""
_AROUND = 0.2
"""m about what is agreed on that may be the person's."""
_TRUE = 0.85
"""Share of what has moved that must be cut out with the person for all of it to be the person's:
0.93 where arms move before a room, 0.55 to 0.73 where the median of the images shows the person."""
_REACH = 1.25
"""m about the middle in which a person may be."""


@dataclass(frozen=True)
class _Guess:
    """Cylinders about the middle: (radius, lowest, highest) in m."""

    maybe: tuple[float, float, float]
    """Beyond it is surely background."""
    likely: tuple[float, float, float]


_UPRIGHT = _Guess((0.75, -1.15, 1.25), (0.18, -0.85, 0.75))
_LYING = _Guess((1.25, -0.8, 0.6), (0.28, -0.14, 0.14))


@dataclass(frozen=True, eq=False)
class _Small:
    """One camera's image, small enough to be cut."""

    view: View
    bgr: Picture
    scale: float
    moved: Mask
    """(height, width) where something has moved."""
    sure: Mask
    """(height, width) the person's beyond doubt."""

    def pixels(self, points: Array) -> Array:
        """Return where points in the world appear, (n, 2) px of the small image."""
        pixels, depths = np.empty((len(points), 2)), np.empty(len(points))
        view = self.view
        project_kernel(points, view.rotation, view.shift, view.lens, pixels, depths)
        return (pixels + 0.5) * self.scale - 0.5

    def nearest(self, points: Array) -> NDArray[np.intp]:
        """Return the pixel nearest to each point, columns and rows, (2, n); −1 behind."""
        known = np.nan_to_num(np.rint(self.pixels(points)), nan=-1)
        return np.asarray(np.clip(known, -1, 1e6).astype(np.intp).T)

    def drawn(self, points: Array, size: float) -> Mask:
        """Return the pixels that cubes of ``size`` m about points cover."""
        height, width = self.bgr.shape[0], self.bgr.shape[1]
        found = np.zeros((height, width), dtype=np.uint8)
        if len(points) == 0:
            return np.asarray(found > 0)
        depths = points @ self.view.rotation[2] + self.view.shift[2]
        depth = float(np.median(depths))
        reach = max(1, round(size * self.view.lens[0] * self.scale / max(depth, 0.1)))
        columns, rows = self.nearest(points)
        shown = (rows >= 0) & (rows < height) & (columns >= 0) & (columns < width)
        found[rows[shown], columns[shown]] = 1
        return np.asarray(cv2.dilate(found, np.ones((reach + 1, reach + 1), np.uint8)) > 0)


def cut_out_together(
    views: Sequence[View],
    pictures: Sequence[Picture | None],
    middle: Array,
    moved: Sequence[Picture | None] | None = None,
) -> list[Picture | None]:
    """Return the person's silhouettes, 0 or 255 in the views' sizes; None where no image is.

    Parameters
    ----------
    pictures
        (height, width, 3) at the views' sizes.
    middle : (3,) m
        About where the person's middle is.
    moved
        Where something has moved, as silhouettes; None where nobody knows. What has moved is
        taken for the person's in the guess, so that what the guess leaves out, bare arms and
        heads, teaches its colours, too.
    """
    moved = [None] * len(views) if moved is None else moved
    small = [
        None if picture is None else _small(view, picture, known)
        for view, picture, known in zip(views, pictures, moved, strict=True)
    ]
    seen = [one for one in small if one is not None]
    guesses = [
        [(_within(one, middle, g.maybe), _within(one, middle, g.likely)) for one in seen]
        for g in (_UPRIGHT, _LYING)
    ]
    # what moves in one camera alone is somebody else, or the room
    mover = _allowed(seen, [grown(one.moved, 1) for one in seen], middle)
    seen = [replace(one, moved=one.moved & one.drawn(mover, 2 * _SIDE)) for one in seen]
    cut = _best(seen, middle, guesses)
    if any(one.moved.any() for one in seen) and _held(seen, cut[1]) > _TRUE:
        cut = _best([replace(one, sure=one.moved) for one in seen], middle, guesses)
    left = iter(cut[1])
    return [None if one is None else _enlarged(next(left), one.view) for one in small]


def _best(
    seen: Sequence[_Small], middle: Array, guesses: Sequence[Sequence[tuple[Mask, Mask]]]
) -> tuple[float, list[Mask]]:
    """Return the silhouettes, of those from each guess, that agree best and hold what moves."""
    cuts = [_agreed(seen, middle, guess) for guess in guesses]
    return max(cuts, key=lambda cut: cut[0] * _held(seen, cut[1]))


def _agreed(
    seen: Sequence[_Small], middle: Array, guess: Sequence[tuple[Mask, Mask]]
) -> tuple[float, list[Mask]]:
    """Return silhouettes from one guess, and to what share they are what all agree on."""
    masks = [_cut(one, *where) for one, where in zip(seen, guess, strict=True)]
    share = 0.0
    for i in range(_ROUNDS + 1):
        common = _common(seen, masks, middle)
        drawn = [one.drawn(common, _SIDE) for one in seen]
        share = float(np.mean([_overlap(d, m) for d, m in zip(drawn, masks, strict=True)]))
        if i < _ROUNDS and len(common):
            masks = [_cut(one, *_beside(one, common)) for one in seen]
    return share, masks


def _held(seen: Sequence[_Small], masks: Sequence[Mask]) -> float:
    """Return what share of what has moved the silhouettes hold; 1 where nothing has."""
    moved = sum(float(one.moved.sum()) for one in seen)
    both = sum(float((one.moved & mask).sum()) for one, mask in zip(seen, masks, strict=True))
    return both / moved if moved else 1.0


def _beside(one: _Small, points: Array) -> tuple[Mask, Mask]:
    """Return where a person may be, and likely is, who fills cubes about points."""
    return one.drawn(points, _SIDE + 2 * _AROUND), one.drawn(points, _SIDE)


def _common(seen: Sequence[_Small], masks: Sequence[Mask], middle: Array) -> Array:
    """Return the largest piece of space that cameras allow, as middles of cubes, (n, 3) m."""
    allowed = _allowed(seen, masks, middle)
    return largest_piece_of_space(allowed, _SIDE) if len(allowed) else allowed


def _allowed(seen: Sequence[_Small], masks: Sequence[Mask], middle: Array) -> Array:
    """Return the middles of the cubes that all cameras but one allow, (n, 3) m.

    With three cameras or fewer all must allow them.
    """
    axis = np.arange(-_REACH, _REACH, _SIDE)
    points = np.stack(np.meshgrid(axis, axis, axis, indexing="ij"), -1).reshape(-1, 3) + middle
    against = np.zeros(len(points), dtype=int)
    shown_by = np.zeros(len(points), dtype=int)
    for one, mask in zip(seen, masks, strict=True):
        columns, rows = one.nearest(points)
        shown = (rows >= 0) & (rows < mask.shape[0]) & (columns >= 0) & (columns < mask.shape[1])
        shown_by += shown
        against[shown] += ~mask[rows[shown], columns[shown]]
    most = shown_by > 3
    allowed: Array = points[(against <= most) & (shown_by - against > 1)]
    return allowed


def _cut(one: _Small, maybe: Mask, likely: Mask) -> Mask:
    labels = np.full(maybe.shape, cv2.GC_BGD, dtype=np.uint8)
    labels[maybe] = cv2.GC_PR_BGD
    labels[likely | (maybe & one.moved)] = cv2.GC_PR_FGD
    labels[maybe & one.sure] = cv2.GC_FGD
    if not likely.any() or not (labels == cv2.GC_BGD).any():
        return np.zeros(maybe.shape, dtype=bool)
    cv2.setRNGSeed(0)  # GrabCut draws its first clusters at random
    models = np.zeros((1, 65)), np.zeros((1, 65))
    cv2.grabCut(one.bgr, labels, [0, 0, 1, 1], *models, 5, cv2.GC_INIT_WITH_MASK)
    return without_room(one.bgr, (labels == cv2.GC_FGD) | (labels == cv2.GC_PR_FGD), one.sure)


def _within(one: _Small, middle: Array, cylinder: tuple[float, float, float]) -> Mask:
    radius, low, high = cylinder
    turn = np.linspace(0, 2 * np.pi, 16, endpoint=False)
    ring = np.stack([radius * np.cos(turn), np.zeros(16), radius * np.sin(turn)], axis=1)
    pixels = one.pixels(np.concatenate([middle + ring + [0, y, 0] for y in (low, high)]))
    found = np.zeros(one.bgr.shape[:2], dtype=np.uint8)
    known = pixels[np.isfinite(pixels).all(axis=1)]
    if len(known) > 2:
        cv2.fillConvexPoly(found, cv2.convexHull(np.rint(known).astype(np.int32)), 1)
    return found > 0


def _overlap(one: Mask, other: Mask) -> float:
    union = float((one | other).sum())
    return float((one & other).sum()) / union if union else 0.0


def _small(view: View, picture: Picture, moved: Picture | None) -> _Small:
    scale = min(1.0, _CUT / max(view.width, view.height))
    size = (round(view.width * scale), round(view.height * scale))
    small = cv2.resize(picture, size, interpolation=cv2.INTER_AREA)
    known = np.zeros(small.shape[:2], dtype=bool)
    if moved is not None:
        known = cv2.resize(moved, size, interpolation=cv2.INTER_AREA) > 200
    return _Small(view, np.ascontiguousarray(small[..., ::-1]), scale, known, np.zeros_like(known))


def _enlarged(mask: Mask, view: View) -> Picture:
    whole = cv2.resize(mask.astype(np.uint8) * 255, (view.width, view.height))
    return largest_piece((whole > 127).astype(np.uint8) * 255)
