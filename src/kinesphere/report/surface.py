"""The body's surface as the page carries it: the four strongest limbs of each vertex."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from kinesphere.data import Array
from kinesphere.report.packing import Packed, pack

MOST_VERTICES = 32_000
"""What 16-bit codes number exactly; a larger surface stays out of the page."""
_CARRIERS = 4
_PLACE_STEP = 5e-5  # m
_WEIGHT_STEP = 1e-3
_INDEX_STEP = 0.5  # halves, so that whole numbers are met wherever the middle of their range lies


def pack_surface(
    vertices: Array,
    faces: NDArray[np.integer[Any]],
    weights: Array,
    rotations: Array,
    origins: Array,
) -> tuple[dict[str, Any], dict[str, Packed]] | None:
    """Return what ``assets/mesh.js`` draws, None for a surface too fine for a page.

    Parameters
    ----------
    vertices : (n_vertices, 3)
        m, where the surface was bound to the limbs.
    faces : (n_faces, 3)
        Indices of vertices, anticlockwise from outside.
    weights : (n_vertices, n_limbs)
        How much each limb carries a vertex.
    rotations : (n_limbs, 3, 3)
        ``world_from_limb`` where the surface was bound.
    origins : (n_limbs, 3)
        m, there too.
    """
    if not 0 < len(vertices) <= MOST_VERTICES:
        return None
    strongest = np.argsort(-weights, axis=1, kind="stable")[:, :_CARRIERS]
    shares = np.take_along_axis(weights, strongest, axis=1)
    lacking = _CARRIERS - strongest.shape[1]
    strongest = np.pad(strongest, ((0, 0), (0, max(0, lacking))))
    shares = np.pad(shares, ((0, 0), (0, max(0, lacking))))
    shares = np.round(shares / shares.sum(axis=1, keepdims=True) / _WEIGHT_STEP) * _WEIGHT_STEP
    shares[:, 0] += 1.0 - shares.sum(axis=1)  # rounded shares that do not add up to 1 would scale
    back = np.swapaxes(rotations, -1, -2)  # limb_from_world at binding
    shift = -(back @ origins[..., None])
    bind = np.concatenate([back, shift], axis=-1).reshape(len(rotations), 12)
    return (
        {"bind": [[round(float(v), 6) for v in row] for row in bind]},
        {
            "mesh_vertices": pack(vertices, _PLACE_STEP),
            "mesh_faces": pack(faces.astype(np.float64), _INDEX_STEP),
            "mesh_limbs": pack(strongest.astype(np.float64), _INDEX_STEP),
            "mesh_weights": pack(shares, _WEIGHT_STEP),
        },
    )
