"""What should stay the same about a joint centre, and what that tells about where it is."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from kinesphere.geometry.centre_views import Turning, View
from kinesphere.geometry.joint_turns import nearest
from kinesphere.geometry.medians import column_medians
from kinesphere.geometry.pose_errors import point_covariance
from kinesphere.geometry.pose_worth import noise_share

Array = NDArray[np.float64]

NOISE_FLOOR = 1e-6
"""Least scale of the residuals relative to the noise they are expected to have."""
FEW = 10
"""Frames below which nothing is said about what averages out."""
_DIFFERENCE = 1e-6  # m, step of the whitening's derivative, which is nearly a quadratic
_HALF_NORMAL = {1: 0.6745, 3: 1.538}  # median length of a standard normal vector
_APART = 1e-9  # m, least distance a direction is taken from


class Term(NamedTuple):
    """What should stay the same, less its usual value, over its expected noise."""

    residual: Array
    """(n, m, k): of m markers one distance each, or the centre's coordinates in the other limb."""
    jacobian: Array
    """(n, m, k, 3) 1/m, how the residual follows the centre."""
    seen: NDArray[np.bool_] | None
    """(n, m), or None where all are seen."""

    def scales(self) -> tuple[Array, Array, Array]:
        """Return robust scales (m,), soft-L1 weights (n, m; 0 where unseen) and counts (m,)."""
        length = np.abs(self.residual[..., 0])
        if self.residual.shape[2] > 1:
            length = np.sqrt(np.einsum("nmk,nmk->nm", self.residual, self.residual))
        scale, w = soft_weights(length, self.seen, self.residual.shape[2])
        count = np.full(len(scale), len(w)) if self.seen is None else self.seen.sum(axis=0)
        return scale, w, count


def find_terms(view: View, centre: Array) -> list[Term]:
    """Return the terms of a view: its markers' distances, its limb's orientation."""
    terms = []
    if view.sightings.points.shape[1]:
        terms.append(_distances(view, centre))
    if view.turning is not None and view.turning.known.any():
        terms.append(_place(view.turning, view.pose, centre))
    return terms


def _place(turning: Turning, seeing: Array, centre: Array) -> Term:
    """Return where the centre lies in the turning limb, less its mean place.

    Minimising it alone is SCoRE (Ehrig et al. 2006) with the inner centre solved out.
    """
    place = turning.place(centre)
    usual, products = turning.means
    middle = place.mean(axis=0)
    off = place - middle
    # the whitening at the centre and at a step from it in each direction
    tried = np.vstack([np.zeros(3), _DIFFERENCE * np.eye(3)])
    own = point_covariance(turning.pose, middle + tried @ usual.T)
    # the seeing limb's share, as the turning one sees it on average
    carried = point_covariance(seeing, centre + tried).reshape(4, 9) @ products.T
    values, vectors = np.linalg.eigh(
        own + turning.noise**2 * np.eye(3) + carried.reshape(own.shape)
    )
    scaled = vectors / np.sqrt(np.maximum(values, turning.noise**2))[:, None]
    w = scaled @ np.swapaxes(vectors, 1, 2)
    change = (w[1:] - w[0]) / _DIFFERENCE
    jacobian = w[0] @ (turning.back - usual) + np.moveaxis(off @ np.swapaxes(change, 1, 2), 0, 2)
    return Term((off @ w[0].T)[:, None], jacobian[:, None], None)


def _distances(view: View, centre: Array) -> Term:
    """Return every marker's distances to the centre."""
    points, seen, noise, complete = view.sightings
    mask = None if complete else seen
    arm = points - centre
    distance = np.maximum(np.sqrt(np.einsum("nmi,nmi->nm", arm, arm)), _APART)
    along = arm / distance[..., None]
    # variance of the seeing limb's pose along the arm, u' P u with u = (centre x along, along)
    u = np.concatenate([np.cross(centre, along), along], axis=2)
    pu = u @ view.pose
    variance = noise**2 + np.einsum("nmi,nmi->nm", u, pu)
    growth = 2 * np.cross(along, pu[..., :3])
    expected = np.sqrt(variance)
    off = (distance - column_medians(distance, mask)) / expected
    for _ in range(3):  # the radius: weighted mean of the distances
        w = soft_weights(np.abs(off), mask, 1)[1] / variance
        total = w.sum(axis=0)
        off = (distance - np.einsum("nm,nm->m", w, distance) / total) / expected
    usual = np.einsum("nm,nmi->mi", w, along) / total[:, None]
    change = (usual - along) / expected[..., None]
    jacobian = change - 0.5 * (off / variance)[..., None] * growth
    return Term(off[..., None], jacobian[:, :, None], mask)


def soft_weights(size: Array, seen: NDArray[np.bool_] | None, k: int) -> tuple[Array, Array]:
    """Return robust scales (m,) of residuals of ``k`` coordinates and their soft-L1 weights.

    Parameters
    ----------
    size : (n, m)
        Lengths of the residuals.
    """
    scale = np.maximum(column_medians(size, seen) / _HALF_NORMAL[k], NOISE_FLOOR)
    w = 1 / np.sqrt(1 + (size / (2 * scale)) ** 2)
    return scale, w if seen is None else np.where(seen, w, 0.0)


def averaging_share(view: View, centre: Array) -> float:
    """Return the share of what markers' distances stray that averages out over frames, 0…1.

    It differs between frames most alike in directions; those know nothing of the distances.
    Nothing is said to average out where hardly a frame shows all markers.
    """
    points, seen, *_ = view.sightings
    whole = seen.all(axis=1)
    if not points.shape[1] or whole.sum() < FEW:
        return 0.0
    arm = points[whole] - centre
    towards = arm / np.maximum(np.linalg.norm(arm, axis=2, keepdims=True), _APART)
    return noise_share(
        _distances(view, centre).residual[whole, :, 0], nearest(towards.reshape(len(arm), -1))
    )


def find_information(view: View, centre: Array, looks: float) -> Array:
    """Return what distances and orientation tell about the centre, (3, 3) 1/m².

    The directions to the markers are noisy themselves, which looks like motion; that share is
    taken off again.
    """
    scales = [scale for term in find_terms(view, centre) for scale in term.scales()[0]]
    scale = float(np.median(scales)) if scales else 1.0
    own = point_covariance(view.pose, centre)
    total = np.zeros((3, 3))
    points, seen, noises, _ = view.sightings
    for m, noise in enumerate(noises):
        y = points[seen[:, m], m]
        distance = np.maximum(np.linalg.norm(y - centre, axis=1), _APART)
        along = (y - centre) / distance[:, None]
        w = 1 / (noise**2 + ((along @ own) * along).sum(axis=1)) / scale**2
        spread = along - np.average(along, axis=0, weights=w)
        across = (np.eye(3) - along[:, :, None] * along[:, None, :]) / distance[:, None, None]
        shaky = across @ (noise**2 * np.eye(3) + point_covariance(view.pose, y)) @ across * scale**2
        told = (spread * w[:, None]).T @ spread - np.tensordot(w, shaky, 1)
        values, vectors = np.linalg.eigh(told)
        total += (vectors * np.maximum(values, 0.0)) @ vectors.T * looks / len(y)
    if view.turning is not None and view.turning.known.any():
        total += looks * _turn_information(view.turning, view.pose, centre)
    return total


def _turn_information(turning: Turning, seeing: Array, centre: Array) -> Array:
    """Return what one look at the other limb's orientation tells about the centre, (3, 3) 1/m²."""
    w = _place(turning, seeing, centre).scales()[1][:, 0]
    turns = turning.back - turning.means[0]
    place = turning.place(centre)
    off = np.linalg.norm(place - place.mean(axis=0), axis=1)
    size = max(float(np.median(off)) / _HALF_NORMAL[3], NOISE_FLOOR * turning.noise)
    told = np.einsum("nki,n,nkj->ij", turns, w, turns) / len(turns)
    # shaky orientations look like motion, each in the two directions across it
    shaky = (np.trace(turning.pose[:3, :3]) + np.trace(seeing[:3, :3])) * 2 / 3
    shaky *= min(1.0, (size / turning.noise) ** 2)
    values, vectors = np.linalg.eigh(told - shaky * np.eye(3))
    told_twice: Array = (vectors * np.maximum(values, 0.0) / size**2) @ vectors.T
    return told_twice
