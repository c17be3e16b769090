"""Two axes from free motion, by the spectra of the angles about them."""

from dataclasses import dataclass, field, replace

import numpy as np

from kinesphere.data import Array
from kinesphere.geometry.rotations import tangent_basis
from kinesphere.parameterization.axes.free_motion import FLOOR, AxesFit, FreeMotion
from kinesphere.parameterization.axes.stretches import stretches_of
from kinesphere.parameterization.axes.waves import (
    Stretch,
    both_of,
    linearized,
    posterior,
    products_of,
)

SMOOTH = 0.1  # Hz, over which the usual size of waves changes
FREEDOM = 2.0  # of the waves about their usual size: rhythms stand out of a spectrum
FIRST_ERROR = 0.026  # rad, 1.5°
LEAST_FREE = 0.1  # of the figures, that waves cannot follow
VAGUE = 1.0  # rad, of a mean angle
SMALLEST = 1e-8  # rad², usual variance of a wave
LARGEST_STEP = 0.15  # rad, of an axis in one round
SETTLED = 2e-4  # rad
ROUNDS = (12, 80)  # at least, at most
SPREAD_ROUNDS = 30  # after which spreads change by a hundredth


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
    spread: Array = field(default_factory=lambda: np.full((4, 4), np.inf))
    """(4, 4) rad², covariance of the axes in their tangent planes, waves' sizes given."""


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
    stretches, near, belief = _begun(motion, start)
    settled = 0
    for k in range(ROUNDS[1]):
        belief = _round(motion, stretches, belief, near)
        settled = settled + 1 if belief.step < SETTLED else 0
        if k + 1 >= ROUNDS[0] and settled > 2:
            break
    return AxesFit(belief.axes, belief.cost)


def spread_of_axes(motion: FreeMotion, axes: Array) -> Array:
    """Return the standard deviations of two axes, (2,) rad, the angles' waves being uncertain.

    The waves are fitted about the axes as they are; the sizes they then have let every angle take
    up what a tilt of an axis leaves. Where the angles share a rhythm nearly all of it can be taken
    up, and the spread is large, however alike axes from parts of the motion are. Sizes count as
    known and the angles as independent, so errors are larger.

    Parameters
    ----------
    motion
        Thinned.
    axes : (2, 3)
        As in `sparsest_axes`.
    """
    stretches, near, belief = _begun(motion, axes)
    for _ in range(SPREAD_ROUNDS):
        belief = replace(_round(motion, stretches, belief, near), axes=axes)
    variances = np.diag(belief.spread)
    return np.asarray(np.sqrt(variances.reshape(2, 2).sum(axis=1)))


def _begun(motion: FreeMotion, axes: Array) -> tuple[list[Stretch], Array, _Belief]:
    """Return stretches, how near frequencies are to each other, (n_waves, n_waves), and a start."""
    stretches, frequencies = stretches_of(motion, axes)
    near = np.exp(-0.5 * ((frequencies[:, None] - frequencies) / SMOOTH) ** 2)
    near /= near.sum(axis=1, keepdims=True)
    return stretches, near, _Belief(axes, FIRST_ERROR, stretches[0].sizes.copy())


def _round(motion: FreeMotion, stretches: list[Stretch], belief: _Belief, near: Array) -> _Belief:
    """Solve for waves and axes, then for the variances of waves and of errors."""
    bases = [tangent_basis(axis) for axis in belief.axes]
    precision = 1 / belief.error**2
    common, right = np.zeros((7, 7)), np.zeros(7)
    common[:3, :3] = np.eye(3) / VAGUE**2
    told = []
    for stretch in stretches:
        linear = linearized(motion, stretch, belief.axes, bases)
        products = precision * products_of(linear, stretch.waves)
        variances, share, narrowed = posterior(products, stretch.sizes)
        m = len(variances)
        mixed = products[m:, m:] - products[m:, :m] @ share
        common += mixed[:7, :7]
        right += mixed[:7, 7]
        told.append((linear, variances, share, narrowed))
    spread = np.linalg.inv(common)
    moved = spread @ right
    step = float(np.linalg.norm(moved[3:]))
    moved[3:] *= min(1.0, LARGEST_STEP / max(step, LARGEST_STEP))
    squares = np.empty((len(stretches), *belief.usual.shape))
    cost = misfit = free = 0.0
    n = sum(stretch.angles.size for stretch in stretches)
    for i, (stretch, ((by_angle, others, out), variances, share, narrowed)) in enumerate(
        zip(stretches, told, strict=True)
    ):
        w = (share[:, 7] - share[:, :7] @ moved).reshape(3, -1)
        loose = variances + np.einsum("ia,ab,ib->i", share[:, :7], spread, share[:, :7])
        loose = loose.reshape(3, -1)
        untold = float((loose / both_of(stretch.sizes)).sum())  # of the waves
        squares[i] = (w**2 + loose).reshape(3, 2, -1).sum(axis=1)
        wave = stretch.waves @ w.T
        left = out - np.einsum("nik,nk->ni", by_angle, wave) - others @ moved
        stretch.angles = wave + moved[:3]
        misfit += float((left**2).sum())
        free += w.size - untold
        cost += narrowed - 0.5 * untold
    cost += n * np.log(belief.error) + 0.5 * precision * misfit + _surprise(squares, belief.usual)
    tilted = belief.axes + np.stack([moved[3:5] @ bases[0], moved[5:] @ bases[1]])
    return _Belief(
        axes=tilted / np.linalg.norm(tilted, axis=1)[:, None],
        error=max(float(np.sqrt(misfit / max(n - free, LEAST_FREE * n))), FLOOR),
        usual=_spectra(stretches, squares, belief.usual, near),
        step=step,
        cost=float(cost),
        spread=np.asarray(spread[3:, 3:], dtype=np.float64),
    )


def _surprise(squares: Array, usual: Array) -> float:
    """Return the negative logarithm of the bound on the evidence, as far as waves' sizes go."""
    heavy = FREEDOM / 2
    before, after = heavy * usual, heavy * usual + squares / 2
    told = (heavy + 1) * np.log(after) - heavy * np.log(before) - np.log(heavy)
    return float(told.sum())


def _spectra(stretches: list[Stretch], squares: Array, usual: Array, near: Array) -> Array:
    """Give every wave its variance; return the usual ones, (3, n_waves).

    ``squares``, (n_stretches, 3, n_waves), are expected squares of a cosine and a sine together.
    """
    usual = 1 / np.mean((FREEDOM + 2) / (FREEDOM * usual + squares), axis=0)
    usual = np.maximum(1 / ((1 / usual) @ near.T), SMALLEST)
    for stretch, square in zip(stretches, squares, strict=True):
        stretch.sizes = (FREEDOM * usual + square) / (FREEDOM + 2)
    return usual
