"""How uncertain a joint's centre is: how firmly it was held, and how far what held it may err.

A fit weighs its data as it must lest it be led astray: looks at skin count for little, hinges are
held tightly to where they are expected. Weights that careful are no statement of how far off the
centre is. That follows from what was weighed, by the sandwich of estimating equations (Huber 1967,
Proc. 5th Berkeley Symp. 1, 221-233; White 1982, doi:10.2307/1912526).
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from kinesphere.geometry.pose_worth import COHERENT

Array = NDArray[np.float64]

ROUNDING = 1e-13
"""Share of the largest eigenvalue below which one is nothing but rounding."""
SILENT = 1e-6
"""Share of the expectation's information left where motion is silent: a thousand spreads."""


class Told(NamedTuple):
    """What the motion tells about a centre."""

    pull: Array
    """(3, 3) 1/m², how firmly it holds the centre: the weights' own curvature."""
    scatter: Array
    """(3, 3) 1/m², variance of the force it does so with. Equal to `pull` if weights were right."""


def covariance_of(told: Told, prior: Array, off: float, spread: float) -> Array:
    """Return how uncertain a centre is that motion and an expectation hold together, (3, 3) m².

    Parameters
    ----------
    prior : (3, 3) 1/m²
        How firmly the centre is held where it is expected.
    off
        How far off the expectation is, in each direction, in spreads.
    spread
        m.
    """
    return _sandwich(told, prior, prior @ prior * (off * spread) ** 2)


def data_covariance_of(told: Told, spread: float) -> Array:
    """Return how uncertain a centre is by the motion alone, (3, 3) m².

    A thousand spreads where it is silent.
    """
    faint = SILENT * np.eye(3) / spread**2
    return _sandwich(told, faint, faint)


def scatter_of(scores: Array, share: float, crowd: Array) -> Array:
    """Return the variance of the sum of scores whose noise averages out, and whose rest does not.

    Poses alike err alike as far as errors last: there a frame stands for all like it. The product
    of the scores of all pairs alike would vanish where a joint hardly turns, for their sum does.

    Parameters
    ----------
    scores : (n, 3)
        Of each pose, at the fit.
    share
        Of the residuals' variance, what averages out, 0 to 1.
    crowd : (n,)
        How many poses are like each. A share of all, `COHERENT`, errs alike whatever their poses.
    """
    times = share + (1 - share) * np.maximum(crowd, COHERENT * len(crowd))
    variance: Array = (scores * times[:, None]).T @ scores
    return variance


def _sandwich(told: Told, prior: Array, force: Array) -> Array:
    """Return H⁻¹ F H⁻¹ with H = prior + pull and F = force + scatter, (3, 3).

    Motion without noise may know one direction 10¹⁶ times better than another: their sum is
    singular in rounding, so the prior is made the unit and eigenvalues are inverted one by one.
    What scatters where nothing pulls is rounding, and may be negative.
    """
    values, vectors = np.linalg.eigh(prior)
    root = (vectors / np.sqrt(values)) @ vectors.T
    known, axes = np.linalg.eigh(root @ told.pull @ root)
    back = root @ axes / (np.maximum(known, 0.0) + 1)
    pulled = known > ROUNDING * known[-1]
    scatter = np.outer(pulled, pulled) * (axes.T @ root @ told.scatter @ root @ axes)
    covariance: Array = back @ (axes.T @ root @ force @ root @ axes + scatter) @ back.T
    return (covariance + covariance.T) / 2
