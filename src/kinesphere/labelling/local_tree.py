"""Alignment and k-d trees of two point sets that are to be matched leaf by leaf.

Huang & Xia 2010, sections 3.2 and 3.3, after Li, Meng & Holstein 2005.
"""

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from kinesphere.data import Array

PARALLEL = 1e-9
"""Below this sine two directions are one line, and any axis across turns one onto the other."""


def orientation_vector(points: Array) -> Array:
    """Return the weighted moment (3), (4) of points (m, 3): Σ (t − c) |t − c| / m."""
    off = points - points.mean(axis=0)
    return np.asarray((off * np.linalg.norm(off, axis=1, keepdims=True)).mean(axis=0))


def aligned(points: Array, reference: Array, axis: Array | None = None) -> Array:
    """Return points (m, 3) centred and turned so that their orientation vector is the reference's.

    Equation (5): t is minus the *centroid* (the paper's text says "of CO", which is a direction).
    The vector fixes two of three degrees of freedom; the turn about it stays free.

    Parameters
    ----------
    reference : (m, 3)
        The model's points; only their orientation vector counts.
    axis : (3,)
        The only axis to turn about, as Li et al. do about the vertical; any, if None.
    """
    off = points - points.mean(axis=0)
    own, wanted = orientation_vector(points), orientation_vector(reference)
    if axis is not None:
        own, wanted = own - (own @ axis) * axis, wanted - (wanted @ axis) * axis
    across = np.cross(own, wanted)
    sine, cosine = float(np.linalg.norm(across)), float(own @ wanted)
    size = float(np.linalg.norm(own) * np.linalg.norm(wanted))
    if sine <= PARALLEL * size:
        if cosine >= 0:
            return np.asarray(off)
        across = axis if axis is not None else np.cross(own, np.eye(3)[np.abs(own).argmin()])
        sine = 0.0
    turn = Rotation.from_rotvec(
        np.arctan2(sine, cosine) * np.asarray(across) / np.linalg.norm(across)
    )
    return np.asarray(turn.apply(off))


def match_leaves(model: Array, acquired: Array) -> NDArray[np.intp]:
    """Return for each model point the acquired point that ends in the same leaf, (m,).

    The model's tree splits where the interval between neighbours along x, y or z is widest (6);
    the acquired points are split along the same axis by the same number, leaf by leaf.

    Parameters
    ----------
    model, acquired : (m, 3)
        Aligned; as many of one as of the other.
    """
    found = np.zeros(len(model), dtype=np.intp)
    stack = [(np.arange(len(model)), np.arange(len(acquired)))]
    while stack:
        own, other = stack.pop()
        if len(own) == 1:
            found[own[0]] = other[0]
            continue
        axis, left = _widest_interval(model[own])
        own = own[np.argsort(model[own, axis], kind="stable")]
        other = other[np.argsort(acquired[other, axis], kind="stable")]
        stack += [(own[:left], other[:left]), (own[left:], other[left:])]
    return found


def _widest_interval(points: Array) -> tuple[int, int]:
    """Return the axis of the widest interval, and how many points lie below it."""
    intervals = np.diff(np.sort(points, axis=0), axis=0)
    axis = int(intervals.max(axis=0).argmax())
    return axis, int(intervals[:, axis].argmax()) + 1


def shape_from_distances(mean: Array, handed: Array | None = None) -> Array:
    """Return points (n, 3) whose distances are about ``mean`` (n, n), by classical scaling.

    Torgerson 1952. The points are a mirror image if ``handed`` says so: (n_quads, 5) of four
    indices and the sign of their volume.
    """
    n = len(mean)
    middle = np.eye(n) - 1 / n
    values, vectors = np.linalg.eigh(-middle @ np.nan_to_num(mean) ** 2 @ middle / 2)
    order = np.argsort(-values)[:3]
    points = np.zeros((n, 3))
    points[:, : len(order)] = vectors[:, order] * np.sqrt(np.maximum(values[order], 0.0))
    if handed is not None and len(handed):
        four = points[handed[:, :4].astype(np.intp)]
        volume = np.linalg.det(four[:, 1:] - four[:, :1])
        if (np.sign(volume) * handed[:, 4]).sum() < 0:
            points[:, 2] *= -1
    return points
