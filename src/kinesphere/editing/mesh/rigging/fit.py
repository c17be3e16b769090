"""The puppet fitted to a surface: every part of the one to its nearest part of the other."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import KDTree

from kinesphere.data import Array
from kinesphere.editing.mesh.rigging.puppet import Puppet
from kinesphere.geometry.samples import vertex_areas

_TURN = 0.08
"""m that a quarter turn of the normals counts as, for what is near: chest and back never are."""
_SLIDE = 0.2  # how much less a point is held along the surface than across it
_TRUST = 0.05  # share of the reach that a surface is off by; weighs what is likely of a pose


@dataclass(frozen=True, eq=False)
class Target:
    """Samples of the surface that is fitted to."""

    points: Array
    """(n, 3) m."""
    normals: Array
    """(n, 3)."""

    def __post_init__(self) -> None:
        object.__setattr__(self, "tree", KDTree(_with_normals(self.points, self.normals)))


def fit_puppet(
    puppet: Puppet,
    target: Target,
    start: Array,
    free: NDArray[np.bool_],
    reaches: tuple[float, ...],
    every: int = 1,
) -> Array:
    """Return the vector that lays the puppet onto the target.

    Gauss-Newton on distances across the surface, from the puppet to the target and back; far pairs
    count less (Geman-McClure), and ever less.

    Parameters
    ----------
    start : (n_numbers,)
    free : (n_numbers,)
        Which numbers may change.
    reaches : m
        From which distance on a pair counts less; one round each.
    every
        Look at each so-manieth vertex and sample only.
    """
    body = puppet.body
    chosen = np.arange(0, body.n_vertices, every)
    areas = vertex_areas(body.vertices, body.faces)[chosen]
    areas = areas / areas.sum()
    back = slice(None, None, every)
    samples, sample_normals = target.points[back], target.normals[back]
    vector, prior = start.copy(), puppet.spreads[free]
    for reach in reaches:
        whole = puppet.vertices(vector)
        normals = _normals(whole, body.faces)[chosen]
        placed = whole[chosen]
        slopes = puppet.slopes(vector, chosen)[free]
        _, near = target.tree.query(_with_normals(placed, normals))  # type: ignore[attr-defined]
        _, far = KDTree(_with_normals(placed, normals)).query(
            _with_normals(samples, sample_normals)
        )
        matrix = np.diag((_TRUST * reach / prior) ** 2)
        wanted = matrix @ (start - vector)[free]
        for at, goal, across, share in (
            (np.arange(len(chosen)), target.points[near], target.normals[near], areas),
            (far, samples, sample_normals, np.full(len(samples), 1 / len(samples))),
        ):
            off = goal - placed[at]
            weight = share / (1 + np.einsum("vi,vi->v", off, off) / reach**2) ** 2
            rows = np.einsum("kvi,vi->vk", slopes[:, at], across)
            matrix += rows.T @ (weight[:, None] * rows)
            wanted += rows.T @ (weight * np.einsum("vi,vi->v", off, across))
            flat = slopes[:, at].reshape(len(slopes), -1)
            thrice = np.repeat(_SLIDE**2 * weight, 3)
            matrix += flat @ (thrice[:, None] * flat.T)
            wanted += flat @ (thrice * off.ravel())
        matrix += 1e-9 * np.eye(len(matrix))
        vector[free] += np.clip(np.linalg.solve(matrix, wanted), -0.4, 0.4)
    return vector


def apart(puppet: Puppet, target: Target, vector: Array) -> tuple[Array, Array]:
    """Return how far puppet and target are from each other, (n_vertices,) and (n_samples,) m."""
    placed = puppet.vertices(vector)
    normals = _normals(placed, puppet.body.faces)
    features = _with_normals(placed, normals)
    there, _ = target.tree.query(features)  # type: ignore[attr-defined]
    back, _ = KDTree(features).query(_with_normals(target.points, target.normals))
    return np.asarray(there), np.asarray(back)


def _with_normals(points: Array, normals: Array) -> Array:
    return np.hstack([points, _TURN / np.sqrt(2) * normals])


def _normals(vertices: Array, faces: NDArray[np.intp]) -> Array:
    a, b, c = vertices[faces.T]
    across = np.cross(b - a, c - a)
    summed = np.stack(
        [
            np.bincount(faces.ravel(), np.repeat(across[:, k], 3), minlength=len(vertices))
            for k in range(3)
        ],
        axis=1,
    )
    return np.asarray(summed / np.maximum(np.linalg.norm(summed, axis=1, keepdims=True), 1e-15))
