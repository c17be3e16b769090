"""Directions and the angles between them."""

import numpy as np

from kinesphere.data import Array
from kinesphere.geometry.vectors import lengths


def unit(vectors: Array, shortest: float = 1e-9) -> Array:
    """Return vectors divided by their length, (..., 3).

    NaN where that is ``shortest`` or less, in the vectors' unit: their direction is rounding error.
    """
    length = lengths(vectors)[..., None]
    with np.errstate(invalid="ignore", divide="ignore"):
        return np.asarray(np.where(length > shortest, vectors / length, np.nan))


def angle_between(a: Array, b: Array) -> Array:
    """Return the angle between vectors of any length, (..., 3) each → (...) rad, 0 to π.

    From sine and cosine: the cosine alone loses half the digits near 0 and π. NaN stays NaN.
    """
    return np.asarray(np.arctan2(lengths(np.cross(a, b)), np.einsum("...i,...i->...", a, b)))
