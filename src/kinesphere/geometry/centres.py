"""The point two limbs share, by maximum a posteriori, and how well the motion knows it."""

from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from kinesphere.geometry.algebraic_centres import sphere_centre
from kinesphere.geometry.rigid import point_covariance

Array = NDArray[np.float64]

NOISE_FLOOR = 1e-6
"""Least scale of the residuals relative to the noise they are expected to have."""
CELL = np.deg2rad(10.0)
"""rad, poses nearer to each other than this count as one: soft tissue errs alike in both."""
ALIGNED = 0.8
"""Least cosine between the axis of a hinge and the direction its motion knows least."""
FIRM = 16.0
"""Information from the motion, in the expectation's units, above which a hinge is left to it."""
FAR = 10.0
"""Spreads from the expectation beyond which an algebraic centre is no place to start from."""
_DIFFERENCE = 1e-6  # m, step of the variance's derivative, which is a quadratic: nearly exact


@dataclass(frozen=True)
class Turning:
    """How a limb with a pose of its own turns in the frame of the limb that sees it."""

    rotations: Array
    """(n_frames, 3, 3) from the turning limb into the seeing one; NaN where unknown."""
    shifts: Array
    """(n_frames, 3) m, its origin."""
    pose: Array
    """(6, 6) uncertainty of its pose, as `pose_covariance` returns it."""
    noise: float
    """m, what a point fixed in both limbs may stray in each direction for other reasons."""

    @cached_property
    def known(self) -> NDArray[np.bool_]:
        """(n_frames,) True where both limbs have a pose."""
        turned = np.isfinite(self.rotations).all(axis=(1, 2))
        return np.asarray(turned & np.isfinite(self.shifts).all(axis=1))

    @cached_property
    def back(self) -> Array:
        """(n_known, 3, 3) from the seeing limb into the turning one."""
        return np.swapaxes(self.rotations[self.known], 1, 2)

    @cached_property
    def means(self) -> tuple[Array, Array]:
        """(3, 3) mean of `back`, and (9, 9) mean of its products with itself."""
        products = np.einsum("nij,nlk->iljk", self.back, self.back).reshape(9, 9) / len(self.back)
        return self.back.mean(axis=0), products

    def place(self, centre: Array) -> Array:
        """Return where a point of the seeing limb lies in the turning one, (n_known, 3) m."""
        moved: Array = (self.back @ (centre - self.shifts[self.known])[..., None])[..., 0]
        return moved


@dataclass(frozen=True)
class View:
    """Markers of one limb as another limb sees them, and how noisy that is."""

    points: Array
    """(n_frames, n_markers, 3) m; NaN where not seen."""
    noise: Array
    """(n_markers,) m, standard deviation of each marker in every direction."""
    pose: Array
    """(6, 6) uncertainty of the seeing limb's own pose, as `pose_covariance` returns it."""
    turning: Turning | None = None
    """The orientation of the limb that is seen, where its markers give one."""


@dataclass(frozen=True)
class CentreFit:
    """A joint centre, and how well the motion alone knows it."""

    centre: Array
    """(3,) m, in the frame of the seeing limb."""
    noise: float
    """m, robust standard deviation of the distances that should stay the same."""
    data_covariance: Array
    """(3, 3) m² of the centre by the motion alone; a thousand spreads where it is silent."""
    prior: Array
    """(3, 3) 1/m², how firmly the centre was expected where it was."""
    covariance: Array
    """(3, 3) m² with the expectation taken in."""
    n_poses: int
    """Number of distinct poses, i.e. of independent looks at the centre."""


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

    The data: every marker keeps its distance to the centre; and where the limb has an orientation,
    the centre stays where it is in that limb, too. Residuals have a soft-L1 loss, and each
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
    # distances and orientation are two readings of the same sightings
    looks = n_poses / hidden**2 / (1 if view.turning is None else 2)
    x, algebraic = expected, sphere_centre(view.points, expected)
    if np.linalg.norm(algebraic - expected) < FAR * spread:
        x = min((expected, algebraic), key=lambda start: _cost(view, start))
    prior = np.eye(3) / spread**2
    x = _descend(view, x, expected, 0.01 * prior, looks, rounds)
    if hinge is not None:
        values, vectors = np.linalg.eigh(_information(view, x, looks))
        weakest = vectors[:, 0]
        if abs(weakest @ hinge) > ALIGNED and values[0] * spread**2 < FIRM:
            prior = prior + (tighter**2 - 1) / spread**2 * np.outer(weakest, weakest)
    x = _descend(view, x, expected, prior, looks, rounds)
    information = _information(view, x, looks)
    distances = np.linalg.norm(view.points - x, axis=2)
    off = np.abs(distances - _median(distances))
    return CentreFit(
        centre=x,
        noise=1.4826 * float(_median(off.reshape(-1, 1))[0]),
        data_covariance=np.asarray(np.linalg.inv(information + 1e-6 * prior)),
        prior=prior,
        covariance=np.asarray(np.linalg.inv(information + prior)),
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


class _Term(NamedTuple):
    """What should stay the same, less its usual value, over its expected noise."""

    residual: Array
    """(n, k): one distance, or the three coordinates of the centre in the other limb."""
    jacobian: Array
    """(n, k, 3) 1/m, how the residual follows the centre."""


def _cost(view: View, x: Array) -> float:
    """Return how badly a start fits: the mean size of the residuals."""
    off = [np.abs(term.residual).ravel() for term in _terms(view, x)]
    return float(np.mean(np.concatenate(off))) if off else 0.0


def _descend(
    view: View, x: Array, expected: Array, prior: Array, looks: float, rounds: int
) -> Array:
    """Iterate Gauss-Newton; weights and scale of the residuals follow the current point."""
    for _ in range(rounds):
        hessian, gradient = prior, prior @ (x - expected)
        for residual, jacobian in _terms(view, x):
            if len(residual) == 0:
                continue
            scale, w = _scale(residual)
            share = looks / len(residual) / scale**2
            hessian = hessian + share * np.einsum("nki,n,nkj->ij", jacobian, w, jacobian)
            gradient = gradient + share * np.einsum("nki,n,nk->i", jacobian, w, residual)
        step = -np.linalg.solve(hessian, gradient)
        length = float(np.linalg.norm(step))
        x = x + step * min(1.0, 0.05 / max(length, 1e-12))
        if length < 1e-7:
            break
    return x


def _terms(view: View, centre: Array) -> list[_Term]:
    """Return what should stay the same about a centre, and how it follows the centre."""
    terms = _distances(view, centre)
    if view.turning is not None and view.turning.known.any():
        terms.append(_place(view.turning, view.pose, centre))
    return terms


def _place(turning: Turning, seeing: Array, centre: Array) -> _Term:
    """Return where the centre lies in the turning limb, less its mean place.

    Minimising it alone is SCoRE (Ehrig et al. 2006) with the inner centre solved out.
    """
    place = turning.place(centre)
    usual, products = turning.means
    off = place - place.mean(axis=0)

    def whitener(c: Array) -> Array:
        here = place.mean(axis=0) + usual @ (c - centre)
        own = point_covariance(turning.pose, here) + turning.noise**2 * np.eye(3)
        # the seeing limb's share, as the turning one sees it on average
        carried = (products @ point_covariance(seeing, c).ravel()).reshape(3, 3)
        values, vectors = np.linalg.eigh(own + carried)
        scaled: Array = (vectors / np.sqrt(np.maximum(values, turning.noise**2))) @ vectors.T
        return scaled

    w = whitener(centre)
    change = np.stack([whitener(centre + _DIFFERENCE * e) - w for e in np.eye(3)], axis=-1)
    jacobian = w @ (turning.back - usual) + np.einsum("ijk,nj->nik", change / _DIFFERENCE, off)
    return _Term(off @ w.T, jacobian)


def _distances(view: View, centre: Array) -> list[_Term]:
    """Return every marker's distances to the centre."""
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
        terms.append(_Term(off[:, None], jacobian[:, None]))
    return terms


def _scale(residual: Array) -> tuple[float, Array]:
    """Return the robust scale of residuals and their soft-L1 weights, (n,) or (n, k) → (n,)."""
    size = np.abs(residual) if residual.ndim == 1 else np.linalg.norm(residual, axis=1)
    usual = 0.6745 if residual.ndim == 1 or residual.shape[1] == 1 else 1.538  # median of |normal|
    scale = max(float(np.median(size)) / usual, NOISE_FLOOR)
    return scale, 1 / np.sqrt(1 + (size / (2 * scale)) ** 2)


def _information(view: View, centre: Array, looks: float) -> Array:
    """Return what distances tell about the centre, (3, 3) 1/m².

    The directions to the markers are noisy themselves, which looks like motion; that share is
    taken off again.
    """
    scales = [_scale(term.residual)[0] for term in _terms(view, centre)]
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
    if view.turning is not None and view.turning.known.any():
        total += looks * _turn_information(view.turning, view.pose, centre)
    return total


def _turn_information(turning: Turning, seeing: Array, centre: Array) -> Array:
    """Return what one look at the other limb's orientation tells about the centre, (3, 3) 1/m²."""
    w = _scale(_place(turning, seeing, centre).residual)[1]
    turns = turning.back - turning.means[0]
    place = turning.place(centre)
    off = np.linalg.norm(place - place.mean(axis=0), axis=1)
    size = max(float(np.median(off)) / 1.538, NOISE_FLOOR * turning.noise)
    told = np.einsum("nki,n,nkj->ij", turns, w, turns) / len(turns)
    # shaky orientations look like motion, each in the two directions across it
    shaky = (np.trace(turning.pose[:3, :3]) + np.trace(seeing[:3, :3])) * 2 / 3
    shaky *= min(1.0, (size / turning.noise) ** 2)
    values, vectors = np.linalg.eigh(told - shaky * np.eye(3))
    information: Array = (vectors * np.maximum(values, 0.0) / size**2) @ vectors.T
    return information


def _median(values: Array) -> Array:
    """Return the median of each column, NaN left out; 0 for a column of nothing else."""
    columns = [column[np.isfinite(column)] for column in values.T]
    return np.array([np.median(column) if len(column) else 0.0 for column in columns])
