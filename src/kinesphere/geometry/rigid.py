"""Rigid fits: one shape to many frames, and the shape itself from frames with gaps."""

from typing import NamedTuple

import numba
import numpy as np
from numpy.typing import NDArray

from kinesphere.geometry.medians import column_medians
from kinesphere.geometry.rotations import nearest_rotation
from kinesphere.geometry.vectors import is_seen, lengths
from kinesphere.kernels.rigid import COLLINEAR, FITTED, TOO_FEW, fit_rigid_kernel

Array = NDArray[np.float64]

MIN_SPREAD = 0.005
"""m, least rms extent of a marker body beside its longest line: below it is a line, not a body."""


SETTLED = 0.003
"""Change of a shape in one round, as a share of its residual, that ends the rounds: a tenth of
what hundreds of frames of such residuals leave open."""
STILL = 1e-8
"""m, change that ends the rounds where there are no residuals to speak of."""


class RigidFit(NamedTuple):
    """Pose of a shape in every frame."""

    rotations: Array
    """(n_frames, 3, 3) ``world_from_shape``; NaN where there is no fit."""
    shifts: Array
    """(n_frames, 3) m; NaN where there is no fit."""
    status: NDArray[np.uint8]
    """(n_frames,) FITTED, TOO_FEW or COLLINEAR of `kinesphere.kernels.rigid`."""

    @property
    def fitted(self) -> NDArray[np.bool_]:
        """(n_frames,) True where there is a fit."""
        return np.asarray(self.status == FITTED)


def fit_rigid(
    shape: Array,
    points: Array,
    weights: Array | None = None,
    *,
    min_spread: float = MIN_SPREAD,
    into: tuple[Array, Array] | None = None,
) -> RigidFit:
    """Fit ``points ≈ rotation @ shape + shift`` in every frame by weighted least squares [1]_.

    Parameters
    ----------
    shape : (n_points, 3) m
        A point that is NaN takes no part.
    points : (n_frames, n_points, 3) m
        NaN where a point is not seen.
    weights : (n_points,) or (n_frames, n_points), optional
        Zero leaves a point out.
    min_spread
        m; a frame whose seen points lie on a line, to this rms extent, has no fit.
    into : (n_frames, 3, 3), (n_frames, 3) m, optional
        Rotations and shifts to be written, left as they are where there is no fit; new ones
        otherwise.

    References
    ----------
    .. [1] Horn (1987), J. Opt. Soc. Am. A 4(4), 629-642, doi:10.1364/JOSAA.4.000629.
    """
    seen = is_seen(points) & is_seen(shape)
    w = np.where(seen, 1.0 if weights is None else weights, 0.0)
    n_frames = len(points)
    rotations, shifts = into or (np.full((n_frames, 3, 3), np.nan), np.full((n_frames, 3), np.nan))
    status = np.zeros(n_frames, dtype=np.uint8)
    # uncompiled, the kernel takes a hundred times as long as batched singular values
    compiled = not getattr(numba.config, "DISABLE_JIT", False)
    fit = fit_rigid_kernel if compiled else fit_rigid_batched
    fit(
        np.ascontiguousarray(shape, dtype=np.float64),
        np.ascontiguousarray(points, dtype=np.float64),
        w,
        min_spread,
        rotations,
        shifts,
        status,
    )
    return RigidFit(rotations, shifts, status)


def tells_pose(
    shape: Array, seen: NDArray[np.bool_], *, min_spread: float = MIN_SPREAD
) -> NDArray[np.bool_]:
    """Return in which frames what is seen of a shape gives its pose: where `fit_rigid` succeeds.

    Parameters
    ----------
    shape : (n_points, 3) m
    seen : (n_frames, n_points)
    min_spread
        m, as `fit_rigid` takes it.
    """
    placed = np.isfinite(shape).all(axis=1)

    def tell(some: NDArray[np.bool_]) -> bool:
        points = shape[some & placed]
        return len(points) > 2 and line_spread(points) > min_spread

    if len(seen) and seen.all():  # as most often: nothing to sort
        return np.full(len(seen), tell(seen[0]))
    packed = np.packbits(seen, axis=1)
    _, first, which = np.unique(packed, axis=0, return_index=True, return_inverse=True)
    enough = np.array([tell(seen[frame]) for frame in first], dtype=np.bool_)
    return np.asarray(enough[which.ravel()])


def left_by_fit(seen: NDArray[np.bool_]) -> float:
    """Return how many times as large points' errors are as what rigid fits leave of them.

    A fit takes up six of the coordinates that a frame shows: the fewer are seen, the less is left.

    Parameters
    ----------
    seen : (n_frames, n_points)
        Frames that show no pose do not count.
    """
    count = seen.sum(axis=1)
    coordinates = 3 * float(count[count > 2].mean()) if (count > 2).any() else 3.0 * seen.shape[1]
    return float(np.sqrt(coordinates / max(coordinates - 6, 1)))


def fit_rigid_batched(
    shape: Array,
    points: Array,
    weights: Array,
    min_spread: float,
    rotations: Array,
    shifts: Array,
    status: NDArray[np.uint8],
) -> None:
    """Do what `fit_rigid_kernel` does, by singular values (Kabsch 1976) of all frames at once."""
    seen = weights > 0
    count = seen.sum(axis=1)
    total = np.maximum(weights.sum(axis=1), np.finfo(np.float64).tiny)[:, None]
    local = np.where(np.isfinite(shape), shape, 0.0)
    world = np.where(seen[..., None], points, 0.0)
    a = weights @ local / total
    b = (weights[..., None] * world).sum(axis=1) / total
    centred = (local - a[:, None]) * seen[..., None]
    spread = np.einsum("npi,npj->nij", centred, centred)
    trace = np.trace(spread, axis1=1, axis2=2)
    minors = (trace**2 - np.einsum("nij,nij->n", spread, spread)) / 2
    wide = minors > trace * count * min_spread**2
    status[:] = np.where(count < 3, TOO_FEW, np.where(wide, FITTED, COLLINEAR))
    good = status == FITTED
    cross = np.einsum("np,npi,npj->nij", weights, world - b[:, None], centred)[good]
    found = nearest_rotation(cross)
    rotations[good] = found
    shifts[good] = b[good] - (found @ a[good][..., None])[..., 0]


def into_frame(rotations: Array, shifts: Array, points: Array) -> Array:
    """Return world points seen from a moving frame, (n, 3, 3), (n, 3), (n, m, 3) → (n, m, 3)."""
    seen: Array = (points - shifts[:, None]) @ rotations
    return seen


def out_of_frame(rotations: Array, shifts: Array, points: Array) -> Array:
    """Return fixed points of a moving frame in the world, (n, 3, 3), (n, 3), (m, 3) → (n, m, 3)."""
    # one large product: a stack of small ones takes several times as long
    turned = (rotations.reshape(-1, 3) @ points.T).reshape(-1, 3, len(points))
    moved: Array = np.swapaxes(turned, 1, 2) + shifts[:, None]
    return moved


def fit_shape(
    points: Array,
    weights: Array | None = None,
    *,
    outlier: float = 0.003,
    rounds: int = 12,
    min_spread: float = MIN_SPREAD,
    start: Array | None = None,
) -> Array | None:
    """Return the shape of a marker body: generalised Procrustes analysis with gaps [1]_.

    Starts at the frame whose distances are the most usual ones, then aligns and averages in turn.
    A sighting far from where the shape puts it (a swap, a ghost) loses its weight: Geman and
    McClure's ``1 / (1 + r²/s²)²`` with ``s`` the larger of ``outlier`` and three times the median
    residual of its marker.

    Parameters
    ----------
    points : (n_frames, n_points, 3) m
        NaN where a point is not seen.
    weights : (n_points,), optional
        How much each point counts for the pose.
    outlier
        m, residual at which a sighting starts to be doubted.
    rounds
        Most alternations of aligning and averaging.
    min_spread
        m; as `fit_rigid` takes it.
    start : (n_points, 3) m, optional
        A shape to begin with, instead of the most usual frame.

    Returns
    -------
    (n_points, 3) m or None
        About the centroid, along the principal axes of the points; NaN for a point never seen
        together with the rest. None where no frame shows three points off a line.

    References
    ----------
    .. [1] Gower (1975), Psychometrika 40(1), 33-51, doi:10.1007/BF02291478.
    """
    seen = is_seen(points)
    if start is None:
        usual_frame = _usual_frame(points, seen, min_spread)
        if usual_frame is None:
            return None
        start = points[usual_frame] - points[usual_frame][seen[usual_frame]].mean(axis=0)
        start = np.where(seen[usual_frame][:, None], start, np.nan)
    shape = start
    w0 = np.ones(points.shape[1]) if weights is None else weights
    doubt = np.ones(seen.shape)
    for _ in range(rounds):
        fit = fit_rigid(shape, points, w0 * doubt, min_spread=min_spread)
        aligned = into_frame(fit.rotations, fit.shifts, points)
        known = is_seen(aligned)
        whole = bool(known.all())
        share = doubt if whole else np.where(known, doubt, 0.0)
        placed = aligned if whole else np.where(known[..., None], aligned, 0.0)
        with np.errstate(invalid="ignore"):
            mean = np.einsum("nm,nmi->mi", share, placed) / share.sum(axis=0)[:, None]
        if not np.isfinite(mean).all(axis=1).any():
            return None  # what seemed a shape fits no frame
        mean -= _centre(mean, w0)
        change = np.nanmax(np.abs(mean - shape)) if np.isfinite(mean - shape).any() else np.inf
        new = bool((np.isfinite(mean) & ~np.isfinite(shape)).any())
        shape = mean
        residual = lengths(aligned - mean)
        usual = np.nan_to_num(column_medians(residual, known), nan=0.0)
        s = np.maximum(outlier, 3 * usual)
        doubt = np.where(known, 1 / (1 + np.where(known, residual / s, 0.0) ** 2) ** 2, 1.0)
        if change < max(SETTLED * usual.max(), STILL) and not new:
            break
    return _principal(shape)


def _centre(shape: Array, weights: Array) -> Array:
    known = np.isfinite(shape).all(axis=1)
    centre: Array = weights[known] @ shape[known] / weights[known].sum()
    return centre


def _usual_frame(points: Array, seen: NDArray[np.bool_], min_spread: float) -> int | None:
    """Return the frame with most points seen whose distances are nearest their medians."""
    n = points.shape[1]
    i, j = np.triu_indices(n, 1)
    distances = lengths(points[:, i] - points[:, j])
    known = np.isfinite(distances)
    medians = column_medians(distances, known)
    off = np.where(known, np.abs(distances - medians), 0.0).sum(axis=1) / np.maximum(
        known.sum(axis=1), 1
    )
    order = np.lexsort((off, -seen.sum(axis=1)))
    for frame in order[:200]:
        shape = points[frame][seen[frame]]
        if len(shape) >= 3 and line_spread(shape) > min_spread:
            return int(frame)
    return None


def line_spread(points: Array) -> float:
    """Return the rms extent in m of points beside the line that fits them best, (n, 3) → m."""
    s = np.linalg.svd(points - points.mean(axis=0), compute_uv=False)
    return float(np.sqrt((s[1:] ** 2).sum() / len(points)))


def _principal(shape: Array) -> Array:
    """Turn a shape about its centroid onto its principal axes, signs by third moments."""
    known = np.isfinite(shape).all(axis=1)
    p = shape[known] - shape[known].mean(axis=0)
    _, _, vt = np.linalg.svd(p)
    skew = ((p @ vt.T) ** 3).sum(axis=0)
    vt = np.where(skew < 0, -1.0, 1.0)[:, None] * vt
    if np.linalg.det(vt) < 0:
        vt[2] *= -1
    turned = np.full_like(shape, np.nan)
    turned[known] = p @ vt.T
    return turned
