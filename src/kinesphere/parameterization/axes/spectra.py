"""Two axes from free motion, by the spectra of the angles about them."""

from dataclasses import dataclass

import numpy as np
from scipy.linalg import cho_factor, cho_solve
from scipy.spatial.transform import Rotation

from kinesphere.data import Array
from kinesphere.geometry.rotations import rotation_about, tangent_basis
from kinesphere.parameterization.axes.free_motion import FLATTEST, FLOOR, AxesFit, FreeMotion
from kinesphere.parameterization.axes.joint_kernels import angles_and_loads

STRETCH = 20.0  # s that have waves of their own; longer ones cost more than they tell
LONGEST_REST = 2.0  # s; nobody keeps time over more, so longer ones count as that
FASTEST = 2.0  # Hz; what is faster counts as error
PER_WAVE = 2.5  # frames at least
FINENESS = 1.5  # waves per resolvable frequency: a rhythm may lie between two
SMOOTH = 0.1  # Hz, over which the usual size of waves changes
FREEDOM = 2.0  # of the waves about their usual size: rhythms stand out of a spectrum
FIRST_ERROR = 0.026  # rad, 1.5°
VAGUE = 1.0  # rad, of a mean angle
SMALLEST = 1e-8  # rad², usual variance of a wave
LARGEST_STEP = 0.15  # rad, of an axis in one round
SETTLED = 2e-4  # rad
ROUNDS = (12, 80)  # at least, at most


@dataclass(eq=False)
class _Stretch:
    """Some seconds of motion and what is thought of them."""

    rotations: Array
    """(n, 3, 3)"""
    waves: Array
    """(n, 2 n_waves): cosines, then sines, of every frequency."""
    angles: Array
    """(n, 3) rad, about the distal axis, the proximal one and the limb."""
    sizes: Array
    """(3, n_waves) rad², variance of a wave's coefficients."""


@dataclass(frozen=True, eq=False)
class _Belief:
    """What all stretches share."""

    axes: Array
    """(2, 3), distal first."""
    error: float
    """Standard deviation of a pose about each axis, rad."""
    usual: Array
    """(3, n_waves) rad², usual variance of a wave's coefficients."""
    step: float = np.inf
    """rad, by which the axes have just moved."""
    cost: float = np.inf
    """Negative logarithm of the evidence before that, less a constant."""


def sparsest_axes(motion: FreeMotion, start: Array) -> AxesFit:
    """Return the two axes about which the angles have the sparsest spectra.

    The three angles are sums of waves. A wave's coefficients have a variance of their own, spread
    about a spectrum that is smooth in frequency (an inverse-gamma distribution: heavy tails), and
    all of that is found with the axes, by expectation and maximization. People move in rhythms:
    about the right axes each angle has few, about wrong ones each has those of all three. This is
    sparse Bayesian learning (Tipping 2001, J. Mach. Learn. Res. 1, 211–244) of waves, axes being
    coefficients of which nothing is known. What is compared are poses, so gimbal lock and limbs
    out of reach need no care.

    Parameters
    ----------
    motion
        Thinned.
    start : (2, 3)
        Distal axis first, the distal one where the limb is in its reference.

    Returns
    -------
    AxesFit
        Its cost compares with that of `likeliest_axes` on the same frames.
    """
    stretches, frequencies = _stretches(motion, start)
    near = np.exp(-0.5 * ((frequencies[:, None] - frequencies) / SMOOTH) ** 2)
    near /= near.sum(axis=1, keepdims=True)
    belief = _Belief(start, FIRST_ERROR, stretches[0].sizes.copy())
    settled = 0
    for k in range(ROUNDS[1]):
        belief = _round(motion, stretches, belief, near)
        settled = settled + 1 if belief.step < SETTLED else 0
        if k + 1 >= ROUNDS[0] and settled > 2:
            break
    return AxesFit(belief.axes, belief.cost)


def _stretches(motion: FreeMotion, axes: Array) -> tuple[list[_Stretch], Array]:
    """Cut the motion; return its stretches and the frequencies, (n_waves,) Hz, of all of them."""
    gaps = np.minimum(np.diff(motion.times), LONGEST_REST)
    times = np.concatenate([[0.0], np.cumsum(gaps)])
    gap = float(np.median(gaps))
    whole = float(times[-1]) + gap
    count = max(1, round(whole / STRETCH))
    length = whole / count
    fastest = min(FASTEST, 1 / (PER_WAVE * gap))
    frequencies = np.arange(1, int(fastest * length * FINENESS) + 1) / (length * FINENESS)
    angles, *_ = angles_and_loads(
        motion.rotations, axes[0], axes[1], motion.reference, motion.long_axis, FLATTEST
    )
    spread = np.clip(angles.var(axis=0), FLOOR**2, 1.0)
    sizes = np.repeat(spread[:, None] / len(frequencies), len(frequencies), axis=1)
    inside = np.minimum((times / length).astype(int), count - 1)
    stretches = []
    for i in np.unique(inside):
        at = inside == i
        turns = 2 * np.pi * np.outer(times[at] - (i + 0.5) * length, frequencies)
        waves = np.concatenate([np.cos(turns), np.sin(turns)], axis=1)
        stretches.append(_Stretch(motion.rotations[at], waves, angles[at], sizes.copy()))
    return stretches, frequencies


def _round(motion: FreeMotion, stretches: list[_Stretch], belief: _Belief, near: Array) -> _Belief:
    """Solve for waves and axes, then for the variances of waves and of errors."""
    axes, precision = belief.axes, 1 / belief.error**2
    bases = [tangent_basis(axis) for axis in axes]
    common, right = np.zeros((7, 7)), np.zeros(7)
    common[:3, :3] = np.eye(3) / VAGUE**2
    solved = []
    cost = 0.0
    for stretch in stretches:
        linear = _linearized(motion, stretch, axes, bases)
        products = precision * _products(linear, stretch.waves)
        covariance, share, narrowed = _posterior(products, stretch.sizes)
        m = len(covariance)
        mixed = products[m:, m:] - products[m:, :m] @ share
        common += mixed[:7, :7]
        right += mixed[:7, 7]
        cost += narrowed
        solved.append((stretch, linear, covariance, share))
    spread = np.linalg.inv(common)
    moved = spread @ right
    step = float(np.linalg.norm(moved[3:]))
    moved[3:] *= min(1.0, LARGEST_STEP / max(step, LARGEST_STEP))
    squares, misfit, free, told = [], 0.0, 0.0, 0
    for stretch, (by_angle, others, out), covariance, share in solved:
        w = (share[:, 7] - share[:, :7] @ moved).reshape(3, -1)
        loose = np.diag(covariance) + np.einsum("ia,ab,ib->i", share[:, :7], spread, share[:, :7])
        loose = loose.reshape(3, -1)
        untold = float((loose / _twice(stretch.sizes)).sum())
        squares.append((w**2 + loose).reshape(3, 2, -1).sum(axis=1))
        wave = stretch.waves @ w.T
        left = out - np.einsum("nik,nk->ni", by_angle, wave) - others @ moved
        stretch.angles = wave + moved[:3]
        misfit += float((left**2).sum())
        told += left.size
        free += w.size - untold
        cost -= 0.5 * untold
    cost += told * np.log(belief.error) + 0.5 * precision * misfit
    cost += _surprise(np.stack(squares), belief.usual)
    error = max(float(np.sqrt(misfit / max(told - free, 0.1 * told))), FLOOR)
    usual = _spectra(stretches, np.stack(squares), belief.usual, near)
    tilted = axes + np.stack([moved[3:5] @ bases[0], moved[5:] @ bases[1]])
    return _Belief(tilted / np.linalg.norm(tilted, axis=1)[:, None], error, usual, step, cost)


def _linearized(
    motion: FreeMotion, stretch: _Stretch, axes: Array, bases: list[Array]
) -> tuple[Array, Array, Array]:
    """Return how poses turn with angles, (n, 3, 3), with means and axes, (n, 3, 7), and the rest.

    The rest, (n, 3), is what waves, means and a change of axes have to make up for.
    """
    angles = stretch.angles
    proximal = rotation_about(axes[1], angles[:, 1])
    both = proximal @ rotation_about(axes[0], angles[:, 0])
    limb = motion.reference @ motion.long_axis
    posed = both @ rotation_about(limb, angles[:, 2]) @ motion.reference
    by_angle = np.stack(
        [proximal @ axes[0], np.broadcast_to(axes[1], angles.shape), both @ limb], axis=2
    )
    columns = [by_angle]
    for axis, basis, angle, before in (
        (axes[0], bases[0], angles[:, 0], proximal),
        (axes[1], bases[1], angles[:, 1], np.eye(3)),
    ):
        sine, cosine = np.sin(angle)[:, None, None], np.cos(angle)[:, None, None]
        columns.append(before @ (sine * basis.T + (1 - cosine) * np.cross(axis, basis).T))
    apart = Rotation.from_matrix(stretch.rotations @ np.swapaxes(posed, 1, 2)).as_rotvec()
    out = apart + np.einsum("nik,nk->ni", by_angle, angles)
    return by_angle, np.concatenate(columns, axis=2), out


def _products(linear: tuple[Array, Array, Array], waves: Array) -> Array:
    """Return the products of all columns: waves of each angle, means and axes, and the rest."""
    by_angle, others, out = linear
    few = np.concatenate([others, out[:, :, None]], axis=2)  # (n, 3, 8)
    m = waves.shape[1]
    products = np.empty((3 * m + 8, 3 * m + 8))
    products[3 * m :, 3 * m :] = np.tensordot(few, few, axes=([0, 1], [0, 1]))
    for k in range(3):
        rows = slice(k * m, (k + 1) * m)
        for i in range(k, 3):
            columns = slice(i * m, (i + 1) * m)
            load = (by_angle[:, :, k] * by_angle[:, :, i]).sum(axis=1)
            products[rows, columns] = waves.T @ (load[:, None] * waves)
            products[columns, rows] = products[rows, columns].T
        beside = np.einsum("ni,nij->nj", by_angle[:, :, k], few)
        products[rows, 3 * m :] = waves.T @ beside
        products[3 * m :, rows] = products[rows, 3 * m :].T
    return products


def _posterior(products: Array, sizes: Array) -> tuple[Array, Array, float]:
    """Return the covariance of the waves' coefficients, (m, m), and their shares, (m, 8).

    Third comes minus half the logarithm of the covariance's determinant.
    """
    m = 2 * sizes.size
    scale = np.sqrt(_twice(sizes)).ravel()  # keeps waves that are hardly there from overflowing
    whole = scale[:, None] * products[:m, :m] * scale + np.eye(m)
    factor = cho_factor(whole, lower=True)
    covariance = scale[:, None] * cho_solve(factor, np.eye(m)) * scale
    narrowed = float(np.log(np.diag(factor[0])).sum() - np.log(scale).sum())
    return covariance, covariance @ products[:m, m:], narrowed


def _surprise(squares: Array, usual: Array) -> float:
    """Return the negative logarithm of the bound on the evidence, as far as waves' sizes go."""
    heavy = FREEDOM / 2
    before, after = heavy * usual, heavy * usual + squares / 2
    told = (heavy + 1) * np.log(after) - heavy * np.log(before) - np.log(heavy)
    return float(told.sum())


def _spectra(stretches: list[_Stretch], squares: Array, usual: Array, near: Array) -> Array:
    """Give every wave its variance; return the usual ones, (3, n_waves).

    ``squares``, (n_stretches, 3, n_waves), are expected squares of a cosine and a sine together.
    """
    usual = 1 / np.mean((FREEDOM + 2) / (FREEDOM * usual + squares), axis=0)
    usual = np.maximum(1 / ((1 / usual) @ near.T), SMALLEST)
    for stretch, square in zip(stretches, squares, strict=True):
        stretch.sizes = (FREEDOM * usual + square) / (FREEDOM + 2)
    return usual


def _twice(sizes: Array) -> Array:
    """Return the variances of cosines and sines, (3, 2 n_waves)."""
    return np.concatenate([sizes, sizes], axis=1)
