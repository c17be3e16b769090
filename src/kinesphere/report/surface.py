"""The body's surface as the page carries it."""

from typing import Any

import numpy as np

from kinesphere.data import Skeleton, Surface, default_origins
from kinesphere.report.packing import Packed, pack

MOST_VERTICES = 32_000
"""What 16-bit codes number exactly; a finer surface stays out of the page."""
_PLACE_STEP = 1e-4  # m
_WEIGHT_STEP = 1e-3
_INDEX_STEP = 0.5  # halves, so that whole numbers are met wherever the middle of their range lies


def pack_surface(
    surface: Surface | None, skeleton: Skeleton
) -> tuple[dict[str, Any] | None, dict[str, Packed]]:
    """Return what ``assets/mesh.js`` draws: where limbs were bound, and arrays of the surface.

    Parameters
    ----------
    surface
        Bound to the skeleton in its default position; None, and one too fine, is left out.
    skeleton
    """
    if surface is None or not 0 < surface.n_vertices <= MOST_VERTICES:
        return None, {}
    shares = np.round(surface.weight_shares / _WEIGHT_STEP) * _WEIGHT_STEP
    shares[:, 0] += 1.0 - shares.sum(axis=1)  # rounded shares that do not add up would move points
    rest = [[round(float(v), 6) for v in origin] for origin in default_origins(skeleton)]
    return (
        {"rest": rest},
        {
            "mesh_vertices": pack(surface.vertices, _PLACE_STEP),
            "mesh_faces": pack(surface.faces.astype(np.float64), _INDEX_STEP),
            "mesh_limbs": pack(surface.weight_limbs.astype(np.float64), _INDEX_STEP),
            "mesh_weights": pack(shares, _WEIGHT_STEP),
        },
    )
