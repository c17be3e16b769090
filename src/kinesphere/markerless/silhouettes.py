"""Silhouettes that need no model: given masks, or what differs from the empty scene."""

import numpy as np
from scipy import ndimage

from kinesphere.data import Frame, Image, Mask, Scene

_NOISE = 6.0
"""Standard deviations of the sensor's noise from which a pixel differs."""
_LEAST = 22.0
"""Grey values from which a pixel differs, however little noise there is."""
_PIECE = 0.15
"""Share of the largest piece that a piece of the person has at least."""


def silhouettes(scene: Scene, frame: Frame) -> tuple[Mask | None, ...]:
    """Return the person's silhouette in each camera, None where neither mask nor plate tells."""
    found: list[Mask | None] = []
    for c, mask in enumerate(frame.masks):
        image, plate = frame.images[c], scene.plates[c]
        if mask is not None:
            found.append(large_pieces(mask))
        elif image is not None and plate is not None:
            found.append(differing(image, plate))
        else:
            found.append(None)
    return tuple(found)


def differing(image: Image, plate: Image) -> Mask:
    """Return where an image differs from the empty scene, (height, width).

    The image's brightness is fitted to the plate's first, so that a lamp that fades is no person;
    a shadow, which darkens all colours alike and by less than half, is none either.
    """
    now, empty = image.astype(np.float32), plate.astype(np.float32)
    gain = np.median((empty.sum(axis=2) + 30) / (now.sum(axis=2) + 30))
    off = now * gain - empty
    spread = 1.4826 * np.median(np.abs(off - np.median(off)))
    limit = max(_LEAST, _NOISE * float(spread))
    differs = np.abs(off).max(axis=2) > limit
    share = (now.sum(axis=2) * gain + 1) / (empty.sum(axis=2) + 1)
    tint = np.abs(off - (share[..., None] - 1) * empty).max(axis=2)
    shadow = (share > 0.5) & (share < 1.0) & (tint < 0.6 * limit)
    tidy = ndimage.binary_closing(ndimage.binary_opening(differs & ~shadow), iterations=2)
    return large_pieces(np.asarray(tidy))


def large_pieces(mask: Mask) -> Mask:
    """Return a mask without its crumbs; holes stay."""
    pieces, n = ndimage.label(mask)
    if n < 2:
        return mask
    sizes = np.bincount(pieces.ravel())
    sizes[0] = 0
    large: Mask = (sizes >= _PIECE * sizes.max())[pieces]
    return large
