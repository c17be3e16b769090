"""Where straight lines leave a surface. Arrays only."""

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


def farthest_hits(vertices: Array, faces: NDArray[np.intp], starts: Array, along: Array) -> Array:
    """Return how far along each ray the last triangle lies, (n_rays,) m; NaN where it meets none.

    Parameters
    ----------
    vertices, faces : (n_vertices, 3) m, (n_faces, 3)
    starts, along : (n_rays, 3) m, (n_rays, 3)
        Unit vectors.

    References
    ----------
    Möller & Trumbore (1997), J. Graphics Tools 2(1), 21-28, doi:10.1080/10867651.1997.10487468.
    """
    a = vertices[faces[:, 0]]
    e1, e2 = vertices[faces[:, 1]] - a, vertices[faces[:, 2]] - a
    far = np.full(len(starts), np.nan)
    for i, (start, ray) in enumerate(zip(starts, along, strict=True)):
        across = np.cross(ray, e2)
        with np.errstate(divide="ignore", invalid="ignore"):
            inverse = 1 / np.einsum("ij,ij->i", e1, across)
            way = start - a
            u = np.einsum("ij,ij->i", way, across) * inverse
            turned = np.cross(way, e1)
            v = turned @ ray * inverse
            t = np.einsum("ij,ij->i", e2, turned) * inverse
            inside = (u >= 0) & (v >= 0) & (u + v <= 1) & (t > 0)
        if inside.any():
            far[i] = t[inside].max()
    return far
