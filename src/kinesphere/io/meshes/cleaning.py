"""Triangles as files hold them become one surface: merged, nothing flat, outside out."""

import numpy as np
from numpy.typing import NDArray

from kinesphere.data import Array
from kinesphere.errors import BadSurface

MOST_FACES = 300_000
"""More than any program plays at ease; binding them would take minutes."""
_SAME = 1e-6  # of the size: corners nearer than that are one vertex
_FEWEST = 100  # triangles; a body cannot be told of fewer


def cleaned(
    vertices: Array, faces: NDArray[np.intp], what: str
) -> tuple[NDArray[np.intp], NDArray[np.intp]]:
    """Return which vertices to keep, (n,), and faces in terms of these, (n_faces, 3).

    Files split vertices where texture or shading has an edge (STL: everywhere); a surface that
    bends is of one piece.

    Parameters
    ----------
    vertices, faces
        As read.
    what
        The file, for errors.

    Raises
    ------
    BadSurface
        If there are too few or too many triangles, or numbers that are none.
    """
    if len(faces) > MOST_FACES:
        raise BadSurface(
            f"{what} has {len(faces):,} triangles; at most {MOST_FACES:,} are taken: decimate it "
            "first, 20,000 are plenty"
        )
    if len(faces) and (faces.min() < 0 or faces.max() >= len(vertices)):
        raise BadSurface(
            f"{what}: a triangle names vertex {faces.max()}; there are {len(vertices)}, from 0"
        )
    used = np.unique(faces)
    wrong = used[~np.isfinite(vertices[used]).all(axis=1)]
    if len(wrong):
        raise BadSurface(f"{what}: vertex {wrong[0]} is {vertices[wrong[0]]}, no place")
    kept = used
    size = float(np.ptp(vertices[used], axis=0).max()) if len(used) else 0.0
    if size > 0:
        corner = vertices[used].min(axis=0)
        cells = np.rint((vertices[used] - corner) / (_SAME * size)).astype(np.int64)
        _, first, merged = np.unique(cells, axis=0, return_index=True, return_inverse=True)
        rank = np.argsort(np.argsort(first))  # in the order of the file
        to = np.zeros(len(vertices), dtype=np.intp)
        to[used] = rank[merged.ravel()]
        faces, kept = to[faces], used[np.sort(first)]
        a, b, c = vertices[kept][faces.T]
        area = np.linalg.norm(np.cross(b - a, c - a), axis=1)
        faces = faces[area > (_SAME * size) ** 2]
    else:
        faces = faces[:0]
    if len(faces) < _FEWEST:
        raise BadSurface(
            f"{what} has {len(faces)} triangles with an area; a body needs {_FEWEST} and more"
        )
    if _volume(vertices[kept], faces) < 0:
        faces = faces[:, ::-1]
    again, faces = np.unique(faces, return_inverse=True)
    return kept[again], faces.reshape(-1, 3)


def _volume(vertices: Array, faces: NDArray[np.intp]) -> float:
    a, b, c = (vertices - vertices.mean(axis=0))[faces.T]
    return float(np.einsum("fi,fi->", np.cross(a, b), c))
