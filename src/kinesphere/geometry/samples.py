"""Points spread evenly over a surface. Arrays only."""

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
_GOLDEN = np.array([0.7548776662466927, 0.5698402909980532])  # of the plane: x³ = x + 1


def surface_samples(
    vertices: Array, faces: NDArray[np.intp], count: int
) -> tuple[Array, Array, NDArray[np.intp]]:
    """Return points of a surface, as dense everywhere, the same on every call.

    Every ``1 / count`` of the area holds one point; within triangles they follow the additive
    recurrence of the plastic number (Roberts 2018, "The unreasonable effectiveness of
    quasirandom sequences").

    Returns
    -------
    points, normals : (count, 3)
        In the unit of the vertices, and of unit length.
    faces : (count,)
        Which triangle each lies on.
    """
    a, b, c = vertices[faces.T]
    across = np.cross(b - a, c - a)
    area = np.linalg.norm(across, axis=1)
    shares = np.cumsum(area) / area.sum()
    face = np.searchsorted(shares, (np.arange(count) + 0.5) / count)
    face = np.minimum(face, len(faces) - 1)
    u, v = ((np.arange(1, count + 1)[:, None] * _GOLDEN) % 1.0).T
    far = u + v > 1
    u, v = np.where(far, 1 - u, u)[:, None], np.where(far, 1 - v, v)[:, None]
    points = a[face] + u * (b - a)[face] + v * (c - a)[face]
    return points, across[face] / area[face, None], face


def vertex_areas(vertices: Array, faces: NDArray[np.intp]) -> Array:
    """Return how much of the surface belongs to each vertex, (n_vertices,)."""
    a, b, c = vertices[faces.T]
    third = np.linalg.norm(np.cross(b - a, c - a), axis=1) / 6
    areas = np.bincount(faces.ravel(), np.repeat(third, 3), minlength=len(vertices))
    return np.asarray(areas, dtype=np.float64)
