"""Silhouettes by level sets: region statistics, length, shape (Rosenhahn et al. 2006, 2.1, 3.1).

Equation 1 is meant with the length's sign turned: as printed it would reward length.
"""

from dataclasses import dataclass, replace
from typing import Any

import cv2
import numpy as np
from numpy.typing import NDArray

from kinesphere.data import Array
from kinesphere.markerless.kernels.distance import near_distance_kernel
from kinesphere.markerless.kernels.evolution import band_runs_kernel, evolve_kernel
from kinesphere.markerless.kernels.levelset import (
    ratios_kernel,
    recount_kernel,
    region_counts_kernel,
)
from kinesphere.markerless.pieces import around
from kinesphere.markerless.settings import TrackSettings

Phi = NDArray[np.float32]

_FLOOR = 1e-4
"""Density that every value has at least: nothing is impossible."""
_BAND = 8.0
"""px to either side of the contour in which it moves."""
_NEAR = 10
"""px; so far must Φ be a distance for the band and the pixels beside it."""
_FAR = 60.0
"""px; Φ goes no farther: beyond the band only its sign counts."""


@dataclass(frozen=True, eq=False)
class Silhouette:
    """A level-set function over a part of a view."""

    phi: Phi
    """(height, width) px, positive inside; about a signed distance near the contour."""
    left: int
    """Column of the view at which it begins."""
    top: int


def signed_distance(mask: NDArray[np.uint8]) -> Phi:
    """Return the distance in px to the edge of a mask, positive inside, (height, width)."""
    inside = cv2.distanceTransform(mask, cv2.DIST_L2, cv2.DIST_MASK_PRECISE)
    outside = cv2.distanceTransform(1 - mask, cv2.DIST_L2, cv2.DIST_MASK_PRECISE)
    # an edge lies between two pixels, half a pixel from either
    phi = np.where(mask > 0, inside - 0.5, 0.5 - outside)
    return np.clip(phi, -_FAR, _FAR).astype(np.float32)


def near_distance(mask: NDArray[np.bool_], reach: int = _NEAR) -> Phi:
    """Return the same, (height, width), cut at ``reach`` px from the edge: three times as fast."""
    phi = np.empty(mask.shape, dtype=np.float32)
    near_distance_kernel(mask, reach, phi)
    return phi


def features_of(picture: NDArray[np.uint8], kind: str) -> NDArray[np.uint8]:
    """Return the features of an image, (height, width, n): grey; Lab; Lab and texture.

    Texture is the local standard deviation of grey, in place of the scale of Brox & Weickert
    (2004), and takes a part of their role at a hundredth of their cost.
    """
    if kind == "colour":
        return np.ascontiguousarray(cv2.cvtColor(picture, cv2.COLOR_RGB2LAB))
    grey = np.asarray(cv2.cvtColor(picture, cv2.COLOR_RGB2GRAY))
    if kind == "grey":
        return np.ascontiguousarray(grey[..., None])
    lab = np.asarray(cv2.cvtColor(picture, cv2.COLOR_RGB2LAB))
    value = grey.astype(np.float32)
    mean = cv2.blur(value, (7, 7))
    spread = np.sqrt(np.maximum(cv2.blur(value * value, (7, 7)) - mean * mean, 0))
    return np.dstack([lab, np.clip(4 * spread, 0, 255).astype(np.uint8)])


def segment(
    picture: NDArray[np.uint8],
    model: NDArray[np.bool_],
    settings: TrackSettings,
    start: Silhouette | None = None,
    shape: float = 0.0,
    known: Phi | None = None,
    scale: int = 1,
) -> Silhouette | None:
    """Return the person's silhouette in an image, started from the projected model.

    Parameters
    ----------
    picture : (height, width, 3)
    model : (height, width)
        What the model covers in its last pose; where Φ starts, and Φ₀ for the shape term.
    start
        A silhouette of the same image to go on from instead.
    shape
        λ of equations 3 and 4, 0 for none.
    known : (height, width)
        log p₁/p₂ of each pixel near the model, in place of densities estimated from the image.
    scale
        How many times smaller than the view the contour moves: coarse, it reaches farther.

    Returns
    -------
    Silhouette
        None where the model is not in the image.
    """
    if start is not None:
        rows = slice(start.top, start.top + start.phi.shape[0])
        cols = slice(start.left, start.left + start.phi.shape[1])
    else:
        box = around(model, settings.margin)
        if box is None:
            return None
        rows, cols = box
    covered = np.ascontiguousarray(model[rows, cols])
    size = covered.shape[1], covered.shape[0]
    if shape:  # the contour is drawn to the model from wherever it has strayed to
        prior = signed_distance(covered.astype(np.uint8))
    else:
        prior = near_distance(covered, _NEAR * scale)
    prior = _smaller(prior, scale) / np.float32(scale)
    phi = prior.copy() if start is None else _smaller(start.phi, scale) / np.float32(scale)
    inside = phi > 0
    if known is None:
        small = _smaller(np.ascontiguousarray(picture[rows, cols]), scale)
        features = features_of(small, settings.features)
        counts, force = np.empty((2, features.shape[2], 256)), np.zeros_like(phi)
        region_counts_kernel(features, inside, counts)
    else:
        force = _smaller(np.ascontiguousarray(known[rows, cols]), scale)
    for i in range(settings.rounds):
        if i % 2 == 0:
            phi = near_distance(inside) if i else phi
            runs = band_runs_kernel(phi, _BAND)
        if known is None:
            ratios_kernel(features, runs, _ratios(counts, settings.blur), force)
        evolve_kernel(
            phi,
            runs,
            force,
            settings.length,
            shape,
            prior,
            settings.shape_term == "inside",
            2.0,
            0.7,
            settings.evolution,
        )
        if known is None:
            recount_kernel(features, phi, runs, inside, counts)
        else:
            inside = phi > 0
    if scale > 1:
        phi = cv2.resize(phi, size, interpolation=cv2.INTER_LINEAR) * np.float32(scale)
    return Silhouette(phi, cols.start, rows.start)


def _smaller(image: Any, scale: int) -> Any:
    if scale == 1:
        return image
    h, w = image.shape[:2]
    size = max(2, round(w / scale)), max(2, round(h / scale))
    return np.ascontiguousarray(cv2.resize(image, size, interpolation=cv2.INTER_AREA))


def mask_of(silhouette: Silhouette, like: NDArray[np.bool_]) -> NDArray[np.bool_]:
    """Return a silhouette as a mask of the whole view."""
    mask = np.zeros_like(like)
    h, w = silhouette.phi.shape
    mask[silhouette.top : silhouette.top + h, silhouette.left : silhouette.left + w] = (
        silhouette.phi > 0
    )
    return mask


def from_mask(picture: NDArray[np.uint8]) -> Silhouette:
    """Return the silhouette of a given mask, 0 to 255: blurred a little, so that it has slopes."""
    soft = cv2.GaussianBlur(picture.astype(np.float32), (0, 0), 0.8)
    return Silhouette(((soft - 127.5) / 64).astype(np.float32), 0, 0)


def cropped(silhouette: Silhouette, box: tuple[slice, slice]) -> Silhouette:
    """Return a part of a silhouette that begins at the view's corner."""
    rows, cols = box
    phi = np.ascontiguousarray(silhouette.phi[rows, cols])
    return replace(silhouette, phi=phi, left=cols.start, top=rows.start)


def _ratios(counts: Array, blur: float) -> Array:
    """Return log p₁/p₂ from counts, (2, n, 256) → (n, 256), smoothed by a Gaussian K_σ."""
    smooth = cv2.GaussianBlur(
        counts.reshape(-1, 256), (0, 0), sigmaX=blur, sigmaY=1e-6, borderType=cv2.BORDER_REPLICATE
    ).reshape(counts.shape)
    density = smooth / np.maximum(smooth.sum(axis=2, keepdims=True), 1) + _FLOOR
    return np.ascontiguousarray(np.log(density[0] / density[1]))
