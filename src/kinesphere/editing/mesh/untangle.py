"""Triangles that binding turned over, at shoulders and groin, are smoothed out again."""

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import csc_array, csr_array, eye_array
from scipy.sparse.linalg import splu

from kinesphere.data import Array

_EXPLICIT, _IMPLICIT = 256, 3  # rounds at most one by one; steps beyond
_ROUNDS = 200
_STEP = 0.5  # of the way to the middle of the neighbours
_RINGS = 2  # how far around a triangle vertices give way


def inverted_faces(
    vertices: Array, faces: NDArray[np.intp], weights: Array, source: Array, turns: Array
) -> NDArray[np.bool_]:
    """Return which triangles look away from where the limb that carries them most took them.

    Parameters
    ----------
    vertices, source : (n_vertices, 3) m
        As bound, and as the body came.
    faces, weights : (n_faces, 3), (n_vertices, n_limbs)
    turns : (n_limbs, 3, 3)
        How each limb was turned from the one to the other.
    """
    return _against(vertices, faces, _wanted(faces, weights, source, turns))


def neighbours(faces: NDArray[np.intp], count: int) -> csr_array:
    """Return which vertices share an edge, (count, count) ones."""
    edges = np.concatenate([faces[:, [k, (k + 1) % 3]] for k in range(3)])
    both = np.concatenate([edges, edges[:, ::-1]])
    near = csr_array((np.ones(len(both)), both.T), shape=(count, count))
    near.data[:] = 1.0
    return near


def softened(weights: Array, faces: NDArray[np.intp], rounds: int) -> Array:
    """Return weights that change more slowly over the surface, for the way into another pose.

    An arm lowered by 45° and moved by centimetres folds the armpit where weights change fast. Many
    rounds, as a fine mesh needs for the same softness, are taken as a few implicit steps.
    """
    near = neighbours(faces, len(weights))
    degree = np.maximum(np.asarray(near.sum(axis=1)).ravel(), 1.0)[:, None]
    if rounds > _EXPLICIT:
        count = len(weights)
        alone = csr_array(near.multiply(1 / degree))
        step = rounds / _IMPLICIT / 2
        system = csc_array(eye_array(count) * (1 + step) - alone * step)
        solve = splu(system)
        for _ in range(_IMPLICIT):
            weights = np.clip(solve.solve(weights), 0.0, 1.0)
        return np.asarray(weights / weights.sum(axis=1, keepdims=True))
    for _ in range(rounds):
        weights = (weights + (near @ weights) / degree) / 2
    return weights


def untangled(
    vertices: Array, faces: NDArray[np.intp], weights: Array, source: Array, turns: Array
) -> Array:
    """Return vertices moved towards their neighbours until no triangle is turned over.

    Only those near such a triangle move. Gives up where that does not help: the caller may count
    with `inverted_faces`.
    """
    moved, wanted = vertices.copy(), _wanted(faces, weights, source, turns)
    near = neighbours(faces, len(vertices))
    degree = np.asarray(near.sum(axis=1)).ravel()
    for _ in range(_ROUNDS):
        wrong = _against(moved, faces, wanted)
        if not wrong.any():
            break
        around = np.zeros(len(vertices))
        around[np.unique(faces[wrong])] = 1.0
        for _ in range(_RINGS):
            around = np.minimum(around + near @ around, 1.0)
        step = _STEP * (around > 0)
        middle = (near @ moved) / np.maximum(degree, 1.0)[:, None]
        moved += step[:, None] * (middle - moved)
    return moved


def _wanted(faces: NDArray[np.intp], weights: Array, source: Array, turns: Array) -> Array:
    """Return where the limb that carries a triangle most took its normal, (n_faces, 3)."""
    carriers = weights[faces].sum(axis=1).argmax(axis=1)
    return np.asarray(np.einsum("fij,fj->fi", turns[carriers], _normals(source, faces)))


def _against(vertices: Array, faces: NDArray[np.intp], wanted: Array) -> NDArray[np.bool_]:
    return np.asarray(np.einsum("fi,fi->f", wanted, _normals(vertices, faces)) <= 0)


def _normals(vertices: Array, faces: NDArray[np.intp]) -> Array:
    a, b, c = vertices[faces.T]
    return np.asarray(np.cross(b - a, c - a))
