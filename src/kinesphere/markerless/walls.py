"""Silhouettes without the wall that shows between arm and trunk."""

import cv2
import numpy as np
from numpy.typing import NDArray

from kinesphere.data import Mask

_BINS = 24
"""Of each channel, for the colours of the person and the room."""
_DOUBT = 2.0
"""How much more frequent in a silhouette than around it a colour of the person is."""
_RING = 12
"""px around a silhouette whose colours are the room's."""
_SORTED = 3
"""Times the colours are told apart, each with what was left."""


def without_room(bgr: NDArray[np.uint8], person: Mask, moved: Mask) -> Mask:
    """Return a silhouette without what wears the room's colours.

    Those are more frequent around the silhouette than in it, or nearly so; single pixels are left.

    Parameters
    ----------
    bgr : (height, width, 3)
    person : (height, width)
    moved : (height, width)
        What is the person's, whatever its colours.
    """
    around = grown(person, _RING) & ~person
    left = person
    for _ in range(_SORTED):
        if not around.any() or not left.any():
            return person
        counts = [
            cv2.calcHist([bgr], [0, 1, 2], of.astype(np.uint8), [_BINS] * 3, [0, 256] * 3)
            for of in (left, around)
        ]
        shares = [c / c.sum() for c in counts]
        bins = bgr.astype(np.intp) * _BINS // 256
        own, theirs = (s[bins[..., 0], bins[..., 1], bins[..., 2]] for s in shares)
        wall = (person & (_DOUBT * theirs > own) & ~moved).astype(np.uint8)
        wall = cv2.morphologyEx(wall, cv2.MORPH_OPEN, np.ones((3, 3), np.uint8))
        left = person & (wall == 0)
    return left


def grown(mask: Mask, reach: int) -> Mask:
    """Return a mask and all that is at most ``reach`` px from it along rows and columns."""
    kernel = np.ones((2 * reach + 1, 2 * reach + 1), np.uint8)
    return np.asarray(cv2.dilate(mask.astype(np.uint8), kernel) > 0)
