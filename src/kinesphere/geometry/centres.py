"""The point two limbs share, by maximum a posteriori, and how well the motion knows it."""

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from kinesphere.geometry.rigid import point_covariance

Array = NDArray[np.float64]

NOISE_FLOOR = 1e-6
"""Least scale of the residuals relative to the noise they are expected to have."""
CELL = np.deg2rad(10.0)
"""rad, poses nearer to each other than this count as one: soft tissue errs alike in both."""
ALIGNED = 0.8
"""Least cosine between the axis of a hinge and the direction its motion knows least."""
_DIFFERENCE = 1e-6  # m, step of the variance's derivative, which is a quadratic: nearly exact


@dataclass(frozen=True)
class View:
    """Markers of one limb as another limb sees them, and how noisy that is."""

    points: Array
    """(n_frames, n_markers, 3) m; NaN where not seen."""
    noise: Array
    """(n_markers,) m, standard deviation of each marker in every direction."""
    pose: Array
    """(6, 6) uncertainty of the seeing limb's own pose, as `pose_covariance` returns it."""


@dataclass(frozen=True)
class CentreFit:
    """A joint centre, and how well the motion alone knows it."""

    centre: Array
    """(3,) m, in the frame of the seeing limb."""
    noise: float
    """m, robust standard deviation of the distances that should stay the same."""
    data_covariance: Array
    """(3, 3) m² of the centre as far as the motion knows it; a thousand spreads where it does not."""
    prior: Array
    """(3, 3) 1/m², how firmly the centre was expected where it was."""
    covariance: Array
    """(3, 3) m² with the expectation taken in."""
    n_poses: int
    """Number of distinct poses, i.e. of independent looks at the centre."""


def score_centre(
    rotations: Array, shifts: Array, ridge: float = 1e-3
) -> tuple[Array, Array, float]:
    """Return the common point of two bodies in both frames, and its rms disagreement.

    Minimises ``Σ |c_parent - R c_child - t|²`` (SCoRE [1]_, here in the parent's frame) with a
    ridge that draws both towards their origins where the motion says nothing.

    Parameters
    ----------
    rotations, shifts : (n_frames, 3, 3), (n_frames, 3) m
        ``parent_from_child``; frames with NaN take no part.
    ridge
        As a share of the number of frames.

    Returns
    -------
    in_parent, in_child : (3,) m
    rms : m

    References
    ----------
    .. [1] Ehrig et al. (2006), J. Biomech. 39(15), 2798-2809, doi:10.1016/j.jbiomech.2005.10.002.
    """
    known = np.isfinite(rotations).all(axis=(1, 2)) & np.isfinite(shifts).all(axis=1)
    r, t = rotations[known], shifts[known]
    n = len(r)
    if n == 0:
        return np.full(3, np.nan), np.full(3, np.nan), np.inf
    a = np.concatenate([np.broadcast_to(np.eye(3), (n, 3, 3)), -r], axis=2)
    normal = np.einsum("nki,nkj->ij", a, a) + ridge * n * np.eye(6)
    c = np.linalg.solve(normal, np.einsum("nki,nk->i", a, t))
    rms = float(np.sqrt(((a @ c - t) ** 2).sum(axis=1).mean()))
    return c[:3], c[3:], rms


def sphere_centre(points: Array, expected: Array, ridge: float = 1e-4) -> Array:
    """Return the common centre of the spheres that points move on, algebraically.

    Gamage and Lasenby's linear equations [1]_, with a small pull towards the expected centre where
    the motion leaves it free.

    Parameters
    ----------
    points : (n_frames, n_points, 3) m
        NaN where not seen.
    expected : (3,) m
    ridge
        Weight of the pull as a share of the points' widest motion.

    References
    ----------
    .. [1] Gamage & Lasenby (2002), J. Biomech. 35(1), 87-93, doi:10.1016/S0021-9290(01)00160-9.
    """
    normal, right = np.zeros((3, 3)), np.zeros(3)
    for seen in np.moveaxis(points, 1, 0) - expected:
        y = seen[np.isfinite(seen).all(axis=1)]
        if len(y) < 2:
            continue
        centred = y - y.mean(axis=0)
        normal += 2 * centred.T @ centred
        right += centred.T @ (y**2).sum(axis=1)
    if not normal.any():
        return expected
    normal += ridge * np.linalg.eigvalsh(normal)[2] * np.eye(3)
    centre: Array = expected + np.linalg.solve(normal, right)
    return centre


def fit_centre(
    view: View,
    expected: Array,
    spread: float,
    *,
    hidden: float = 1.0,
    hinge: Array | None = None,
    tighter: float = 10.0,
    rounds: int = 50,
) -> CentreFit:
    """Fit the point that markers turn about, by maximum a posteriori.

    The data: every marker keeps its distance to the centre. Residuals have a soft-L1 loss, and each
    is measured against the noise it should have, that of the seeing limb's own pose included: an
    orientation shaky about a limb's long axis makes a centre far from that axis shaky, and without
    this the fit would flee to the axis (errors in variables; as in Sampson's distance the weight
    follows the centre).

    The expectation ``expected ± spread`` speaks where the motion does not. Residuals of similar
    poses are not independent (soft tissue), so frames count by the distinct poses they show.

    Parameters
    ----------
    view
        The markers of one limb, seen from the other.
    expected : (3,) m
        Expected centre in the frame of the seeing limb.
    spread
        m, its standard deviation.
    hidden
        How many times larger errors are that the fit absorbs (skin that moves with the pose) than
        those it leaves as residuals.
    hinge : (3,), optional
        Direction of the axis of a joint known to have only one. Where the motion knows the centre
        least along it, too, the expectation holds ``tighter`` times tighter there: what residuals
        tell about that direction is how they were spoilt.
    tighter
    rounds
        Most steps of the descent.
    """
    n_poses = count_poses(view, expected)
    looks = n_poses / hidden**2
    starts = (expected, sphere_centre(view.points, expected))
    x = min(starts, key=lambda start: _cost(view, start, expected, spread))
    prior = np.eye(3) / spread**2
    x = _descend(view, x, expected, 0.01 * prior, looks, rounds)
    if hinge is not None:
        weakest = np.linalg.eigh(_information(view, x, looks))[1][:, 0]
        if abs(weakest @ hinge) > ALIGNED:
            prior = prior + (tighter**2 - 1) / spread**2 * np.outer(weakest, weakest)
    x = _descend(view, x, expected, prior, looks, rounds)
    information = _information(view, x, looks)
    distances = np.linalg.norm(view.points - x, axis=2)
    off = np.abs(distances - _median(distances))
    return CentreFit(
        centre=x,
        noise=1.4826 * float(_median(off.reshape(-1, 1))[0]),
        data_covariance=np.linalg.inv(information + 1e-6 * prior),
        prior=prior,
        covariance=np.linalg.inv(information + prior),
        n_poses=n_poses,
    )


def count_poses(view: View, centre: Array) -> int:
    """Return how many distinct poses there are: cells of `CELL` on the markers' spheres."""
    most = 1
    for seen in np.moveaxis(view.points, 1, 0) - centre:
        y = seen[np.isfinite(seen).all(axis=1)]
        if len(y) == 0:
            continue
        radius = max(float(np.median(np.linalg.norm(y, axis=1))), 1e-9)
        cells = np.floor(y / (radius * CELL)).astype(np.int64)
        most = max(most, len(np.unique(cells, axis=0)))
    return most


class _Distances(NamedTuple):
    """One marker's distances to the centre."""

    residual: Array
    """(n,) distance less the usual one, over its expected noise."""
    jacobian: Array
    """(n, 3) 1/m, how the residual follows the centre."""


def _cost(view: View, x: Array, expected: Array, spread: float) -> float:
    """Return how badly a start fits, its distance from the expectation taken in mildly."""
    terms = _distances(view, x)
    off = np.concatenate([np.abs(term.residual) for term in terms]) if terms else np.zeros(1)
    far = float(np.linalg.norm(x - expected)) / (10 * spread)
    return float(np.log(np.mean(off) + NOISE_FLOOR)) + max(0.0, far - 1.0)


def _descend(
    view: View, x: Array, expected: Array, prior: Array, looks: float, rounds: int
) -> Array:
    """Iterate Gauss-Newton; weights and scale of the residuals follow the current point."""
    for _ in range(rounds):
        hessian, gradient = prior, prior @ (x - expected)
        for residual, jacobian in _distances(view, x):
            scale, w = _scale(residual)
            share = looks / len(residual) / scale**2
            hessian = hessian + share * (jacobian * w[:, None]).T @ jacobian
            gradient = gradient + share * jacobian.T @ (w * residual)
        step = -np.linalg.solve(hessian, gradient)
        length = float(np.linalg.norm(step))
        x = x + step * min(1.0, 0.05 / max(length, 1e-12))
        if length < 1e-8:
            break
    return x


def _distances(view: View, centre: Array) -> list[_Distances]:
    """Return every marker's distances to the centre, and how they follow it."""
    own = point_covariance(view.pose, centre)
    moved = point_covariance(view.pose, centre + _DIFFERENCE * np.eye(3))
    terms = []
    for seen, noise in zip(np.moveaxis(view.points, 1, 0), view.noise, strict=True):
        arm = seen[np.isfinite(seen).all(axis=1)] - centre
        if len(arm) < 2:
            continue
        distance = np.maximum(np.linalg.norm(arm, axis=1), 1e-9)
        along = arm / distance[:, None]
        variance = noise**2 + ((along @ own) * along).sum(axis=1)
        growth = (np.einsum("ni,kij,nj->nk", along, moved - own, along)) / _DIFFERENCE
        expected = np.sqrt(variance)
        off = (distance - np.median(distance)) / expected
        for _ in range(3):  # the radius: weighted mean of the distances
            w = _scale(off)[1] / variance
            off = (distance - (w * distance).sum() / w.sum()) / expected
        change = -along + np.average(along, axis=0, weights=w)
        jacobian = change / expected[:, None] - 0.5 * (off / variance)[:, None] * growth
        terms.append(_Distances(off, jacobian))
    return terms


def _scale(residual: Array) -> tuple[float, Array]:
    """Return the robust scale of residuals and their soft-L1 weights, (n,)."""
    scale = max(1.4826 * float(np.median(np.abs(residual))), NOISE_FLOOR)
    return scale, 1 / np.sqrt(1 + (residual / (2 * scale)) ** 2)


def _information(view: View, centre: Array, looks: float) -> Array:
    """Return what distances tell about the centre, (3, 3) 1/m².

    The directions to the markers are noisy themselves, which looks like motion; that share is
    taken off again.
    """
    scales = [_scale(term.residual)[0] for term in _distances(view, centre)]
    scale = float(np.median(scales)) if scales else 1.0
    own = point_covariance(view.pose, centre)
    total = np.zeros((3, 3))
    for seen, noise in zip(np.moveaxis(view.points, 1, 0), view.noise, strict=True):
        y = seen[np.isfinite(seen).all(axis=1)]
        if len(y) < 2:
            continue
        distance = np.maximum(np.linalg.norm(y - centre, axis=1), 1e-9)
        along = (y - centre) / distance[:, None]
        w = 1 / (noise**2 + ((along @ own) * along).sum(axis=1)) / scale**2
        spread = along - np.average(along, axis=0, weights=w)
        across = (np.eye(3) - along[:, :, None] * along[:, None, :]) / distance[:, None, None]
        shaky = across @ (noise**2 * np.eye(3) + point_covariance(view.pose, y)) @ across * scale**2
        told = np.einsum("ni,n,nj->ij", spread, w, spread) - np.einsum("n,nij->ij", w, shaky)
        values, vectors = np.linalg.eigh(told)
        total += (vectors * np.maximum(values, 0.0)) @ vectors.T * looks / len(y)
    return total


def _median(values: Array) -> Array:
    """Return the median of each column, NaN left out; 0 for a column of nothing else."""
    columns = [column[np.isfinite(column)] for column in values.T]
    return np.array([np.median(column) if len(column) else 0.0 for column in columns])
