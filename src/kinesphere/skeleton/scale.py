"""Lengths that suit people: shrunk for a hand, and others where the unit must be wrong."""

from dataclasses import replace

import numpy as np

from kinesphere.data import Array
from kinesphere.skeleton.averages import median_seen
from kinesphere.skeleton.settings import SkeletonSettings

PERSON = 0.2
"""m, rms extent of all markers about their middle from which a subject counts as a person's size:
people have 0.40 to 0.66 m, a single arm or foot with its shank 0.16 to 0.18 m, a hand 0.05 m."""
TINY = 0.006
"""m, the same of markers along 2 cm: less than a finger, and hardly more than a single marker."""


def size_share(markers: Array) -> float:
    """Return the markers' extent as a share of a person's, at most 1, (n, m, 3) m → 0…1.

    Frames count by their median, so a few ghosts do not matter; 1 where nothing is seen.
    """
    usual = _extent(markers)
    return min(1.0, usual / PERSON) if usual > 0 else 1.0


def times_too_large(markers: Array) -> float:
    """Return 1, or the power of ten by which lengths are too large or small for any body.

    From ten times `PERSON` on nobody is as large and below `TINY` nothing bears markers: a unit was
    taken for another one. What comes out is below ten times `PERSON`, or above a tenth.

    Parameters
    ----------
    markers : (n_frames, n, 3) m
    """
    usual = _extent(markers)
    if not usual > 0 or TINY <= usual < PERSON:
        return 1.0
    return float(10.0 ** np.trunc(np.log10(usual / PERSON)))


def _extent(markers: Array) -> float:
    """Return the usual rms distance of markers from their middle, in m; NaN if none are seen."""
    seen = np.asarray(np.isfinite(markers).all(axis=2))
    count = np.maximum(seen.sum(axis=1), 1)
    at = np.where(seen[..., None], markers, 0.0)
    middle = at.sum(axis=1) / count[:, None]
    square = np.where(seen[..., None], (markers - middle[:, None]) ** 2, 0.0).sum(axis=(1, 2))
    extent = np.where(seen.sum(axis=1) > 1, np.sqrt(square / count), np.nan)
    return float(median_seen(extent))


def scaled(settings: SkeletonSettings, share: float) -> SkeletonSettings:
    """Return the settings with the lengths that tell a shape from a line shrunk by ``share``."""
    least = 0.01  # mm, the settings' own lower bound
    return replace(
        settings,
        outlier_mm=max(share * settings.outlier_mm, least),
        min_spread_mm=max(share * settings.min_spread_mm, least),
        adopt_mm=max(share * settings.adopt_mm, least),
    )
