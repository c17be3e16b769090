"""The point two limbs share: algebraic estimates, and the robust one that knows what it knows."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

NOISE_FLOOR = 1e-6
"""m, least noise ever assumed: keeps weights finite on noise-free data."""
CELL = np.deg2rad(10.0)
"""rad, poses nearer to each other than this count as one: soft tissue errs alike in both."""


@dataclass(frozen=True)
class PairView:
    """What one limb's motion in another's frame looks like, for the centre they share."""

    child_in_parent: Array
    """(n_frames, n_child_markers, 3) m, the child's markers seen from the parent."""
    parent_in_child: Array | None = None
    """(n_frames, n_parent_markers, 3) m, the parent's markers seen from the child."""
    rotations: Array | None = None
    """(n_frames, 3, 3) ``parent_from_child``; None where the child has no pose of its own."""
    shifts: Array | None = None
    """(n_frames, 3) m, origin of the child in the parent."""


@dataclass(frozen=True)
class CentreFit:
    """A joint centre, and how well the motion alone knows it."""

    in_parent: Array
    """(3,) m."""
    in_child: Array | None
    """(3,) m; None where the child has no pose of its own."""
    noise: float
    """m, robust standard deviation of the distances it was fitted to."""
    data_covariance: Array
    """(3, 3) m² of the centre in the parent as far as the motion knows it; large where it does not."""
    covariance: Array
    """(3, 3) m² with the expectation taken in."""
    n_poses: int
    """Number of distinct poses, i.e. of independent looks at the centre."""


def score_centre(
    rotations: Array, shifts: Array, ridge: float = 1e-3
) -> tuple[Array, Array, float]:
    """Return the common point of two bodies in both frames, and its rms disagreement.

    Minimises ``Σ |c_parent - R c_child - t|²`` (SCoRE [1]_, here in the parent's frame) with a ridge
    that draws both towards their origins where the motion says nothing.

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
    for y in np.moveaxis(points, 1, 0) - expected:
        y = y[np.isfinite(y).all(axis=1)]
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
    view: PairView, expected: Array, spread: float | Array, *, rounds: int = 30
) -> CentreFit:
    """Fit the point that both limbs share, by maximum a posteriori.

    The data: every marker of the child keeps its distance to the centre carried by the parent, every
    marker of the parent its distance to the centre carried by the child, and the two centres agree.
    Each kind of residual has its own noise, estimated robustly, and a soft-L1 loss. Distances need no
    rotations, so noisy ones do not draw the centre towards the markers as they do in SCoRE.

    The expectation ``expected ± spread`` speaks where the motion does not. Residuals of similar
    poses are not independent (soft tissue), so frames count by the distinct poses they show.

    Parameters
    ----------
    view
        The limbs seen from each other.
    expected : (3,) m
        Expected centre in the parent's frame.
    spread
        m, its standard deviation; or (3, 3) m², its covariance.
    """
    prior = np.eye(3) / spread**2 if np.ndim(spread) == 0 else np.linalg.inv(np.asarray(spread))
    n_poses = count_poses(view, expected)
    best: tuple[float, Array] | None = None
    for start in _starts(view, expected):
        x, cost = _descend(view, start, expected, prior * 0.01, n_poses, rounds)
        if best is None or cost < best[0] * (1 - 1e-9):
            best = (cost, x)
    assert best is not None
    x, _ = _descend(view, best[1], expected, prior, n_poses, rounds)
    hessian, _, _, noise = _normal_equations(view, x, n_poses)
    data, both = _centre_information(hessian), hessian.copy()
    both[:3, :3] += prior
    loose = 1e-6 * prior  # keeps directions without any information finite: a thousand spreads
    return CentreFit(
        in_parent=x[:3],
        in_child=x[3:] if len(x) == 6 else None,
        noise=noise,
        data_covariance=np.linalg.inv(data + loose),
        covariance=np.linalg.inv(_centre_information(both)),
        n_poses=n_poses,
    )


def count_poses(view: PairView, centre: Array) -> int:
    """Return how many distinct poses of the child the parent sees: cells of `CELL` on its spheres."""
    most = 1
    for y in np.moveaxis(view.child_in_parent, 1, 0) - centre:
        y = y[np.isfinite(y).all(axis=1)]
        if len(y) == 0:
            continue
        radius = max(float(np.median(np.linalg.norm(y, axis=1))), 1e-9)
        cells = np.floor(y / (radius * CELL)).astype(np.int64)
        most = max(most, len(np.unique(cells, axis=0)))
    return most


def _starts(view: PairView, expected: Array) -> list[Array]:
    """Return where to start: at the expectation, and where algebra puts the centre."""
    centres = [expected, sphere_centre(view.child_in_parent, expected)]
    if view.rotations is None or view.shifts is None:
        return centres
    in_child = [np.swapaxes(view.rotations, 1, 2) @ (c - view.shifts)[..., None] for c in centres]
    starts = [
        np.concatenate([c, np.nanmedian(k[..., 0], axis=0)])
        for c, k in zip(centres, in_child, strict=True)
    ]
    scored = np.concatenate(score_centre(view.rotations, view.shifts, ridge=1e-6)[:2])
    return [*starts, scored]


def _descend(
    view: PairView, start: Array, expected: Array, prior: Array, n_poses: int, rounds: int
) -> tuple[Array, float]:
    """Iterate damped Gauss-Newton with weights and noise of the current residuals."""
    x, cost = start, np.inf
    for _ in range(rounds):
        hessian, gradient, cost, _ = _normal_equations(view, x, n_poses)
        off = x[:3] - expected
        hessian[:3, :3] += prior
        gradient[:3] += prior @ off
        step = -np.linalg.solve(hessian + 1e-13 * np.trace(hessian) * np.eye(len(x)), gradient)
        length = np.linalg.norm(step)
        x = x + step * min(1.0, 0.05 / max(length, 1e-12))
        if length < 1e-8:
            break
    return x, cost


def _normal_equations(view: PairView, x: Array, n_poses: int) -> tuple[Array, Array, float, float]:
    """Return Hessian, gradient, cost and noise of the data at ``x``; cost is a log-likelihood."""
    n = len(x)
    hessian, gradient, cost = np.zeros((n, n)), np.zeros(n), 0.0
    noises = []
    views = [(view.child_in_parent, slice(0, 3))]
    if view.parent_in_child is not None and n == 6:
        views.append((view.parent_in_child, slice(3, 6)))
    for points, at in views:
        for y in np.moveaxis(points, 1, 0):
            arm = y[np.isfinite(y).all(axis=1)] - x[at]
            if len(arm) < 2:
                continue
            distance = np.maximum(np.linalg.norm(arm, axis=1), 1e-9)
            residual, jacobian, w, noise = _about_radius(distance, -arm / distance[:, None])
            share = n_poses / len(arm) / noise**2
            hessian[at, at] += share * (jacobian * w[:, None]).T @ jacobian
            gradient[at] += share * jacobian.T @ (w * residual)
            cost += n_poses * np.log(noise)
            noises.append(noise)
    if n == 6 and view.rotations is not None and view.shifts is not None:
        known = np.isfinite(view.rotations).all(axis=(1, 2)) & np.isfinite(view.shifts).all(axis=1)
        r, t = view.rotations[known], view.shifts[known]
        gap = x[:3] - r @ x[3:] - t
        size = np.linalg.norm(gap, axis=1)
        noise = max(float(np.median(size)) / 1.538, NOISE_FLOOR)  # median of a 3-d normal's length
        w = 1 / np.sqrt(1 + (size / (2 * noise)) ** 2)
        share = n_poses / len(r) / noise**2
        jacobian = np.concatenate([np.broadcast_to(np.eye(3), r.shape), -r], axis=2)
        hessian += share * np.einsum("nki,n,nkj->ij", jacobian, w, jacobian)
        gradient += share * np.einsum("nki,n,nk->i", jacobian, w, gap)
        cost += 3 * n_poses * np.log(noise)
    return hessian, gradient, cost, float(np.median(noises)) if noises else NOISE_FLOOR


def _about_radius(distance: Array, jacobian: Array) -> tuple[Array, Array, Array, float]:
    """Take the best radius out of distances and their derivatives; weigh by soft L1."""
    residual = distance - np.median(distance)
    for _ in range(3):
        noise = max(1.4826 * float(np.median(np.abs(residual))), NOISE_FLOOR)
        w = 1 / np.sqrt(1 + (residual / (2 * noise)) ** 2)
        residual = residual - np.average(residual, weights=w)
    jacobian = jacobian - np.average(jacobian, axis=0, weights=w)
    return residual, jacobian, w, noise


def _centre_information(hessian: Array) -> Array:
    """Return the information about the parent's centre alone, the child's solved out."""
    if len(hessian) == 3:
        return hessian
    own, cross, other = hessian[:3, :3], hessian[:3, 3:], hessian[3:, 3:]
    information: Array = own - cross @ np.linalg.pinv(other, hermitian=True) @ cross.T
    return information
