"""Weights of one body given to another that lies on it."""

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import KDTree

from kinesphere.data import Array
from kinesphere.editing.mesh.untangle import softened

_NEAR = 6  # vertices that a weight is gathered from
_TURN = 0.08  # m that a quarter turn of the normals counts as: an arm takes nothing from the chest
_TOUCH = 1e-3  # m; what is nearer counts as there
_LEAST = 0.01  # share that is not worth a limb


def transferred(
    points: Array,
    normals: Array,
    source: Array,
    source_normals: Array,
    weights: Array,
) -> Array:
    """Return weights for points from those of the nearest vertices that look the same way.

    Parameters
    ----------
    points, normals : (n, 3)
    source, source_normals : (n_source, 3)
    weights : (n_source, n_limbs)

    Returns
    -------
    (n, n_limbs)
    """
    turn = _TURN / np.sqrt(2)
    tree = KDTree(np.hstack([source, turn * source_normals]))
    apart, near = tree.query(np.hstack([points, turn * normals]), k=_NEAR)
    share = 1 / (np.asarray(apart) + _TOUCH) ** 2
    share /= share.sum(axis=1, keepdims=True)
    return np.asarray(np.einsum("vk,vkl->vl", share, weights[near]))


def at_most_four(weights: Array, faces: NDArray[np.intp], rounds: int) -> Array:
    """Return weights smoothed over the surface, of four limbs at most, that add up to one."""
    smooth = softened(weights, faces, rounds)
    fourth = -np.sort(-smooth, axis=1)[:, min(3, smooth.shape[1] - 1)]
    kept = np.where((smooth >= fourth[:, None]) & (smooth > _LEAST), smooth, 0.0)
    for vertex in np.flatnonzero((kept > 0).sum(axis=1) > 4):  # ties
        kept[vertex, np.argsort(-kept[vertex], kind="stable")[4:]] = 0.0
    return np.asarray(kept / kept.sum(axis=1, keepdims=True))
