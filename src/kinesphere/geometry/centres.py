"""The point two limbs share, by maximum a posteriori, and how well the motion knows it."""

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from kinesphere.geometry.algebraic_centres import sphere_centre
from kinesphere.geometry.centre_covariance import Told, covariance_of, data_covariance_of
from kinesphere.geometry.centre_descent import descend, mean_residual
from kinesphere.geometry.centre_terms import averaging_share, find_information
from kinesphere.geometry.centre_views import Turning as Turning
from kinesphere.geometry.centre_views import View as View
from kinesphere.geometry.distinct_poses import count_poses
from kinesphere.geometry.hinge_expectation import open_axis, tighter_along
from kinesphere.geometry.medians import column_medians
from kinesphere.geometry.pose_worth import overrated
from kinesphere.geometry.skin import fit_through_skin
from kinesphere.geometry.skin_noise import FEW
from kinesphere.geometry.vectors import lengths

Array = NDArray[np.float64]

UNKNOWNS = 4
"""A centre's coordinates and a distance to it: so many looks tell nothing."""
FAR = 10.0
"""Spreads from the expectation beyond which an algebraic centre is no place to start from."""


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
    off: float = 1.0,
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

    Where it is known how much of either limb's markers goes with the joint (`Turning.skin`), the
    steady centre alone counts, and that movement is fitted along: see
    `kinesphere.geometry.skin.fit_through_skin`. Distances would bring skin back in.

    The expectation ``expected ± spread`` speaks where the motion does not. Residuals of similar
    poses are not independent (soft tissue), so frames count by the distinct poses they show.

    Parameters
    ----------
    view
        The markers of one limb, seen from the other.
    expected : (3,) m
        Expected centre in the frame of the seeing limb.
    spread
        m, how far off it may be: it holds the centre as if that was its standard deviation.
    off
        In spreads, how far off it is in each direction: as such it is in the uncertainty.
    hidden
        How many times larger errors are that the fit absorbs (skin that moves with the pose) than
        those it leaves as residuals.
    hinge : (3,), optional
        Direction of the axis of a joint known to have only one. The expectation holds ``tighter``
        times tighter along it. Where both limbs have a pose and skin is known, that is along the
        axis that the motion shows, however firmly it is told; else where the motion knows the
        centre least along it, too. The uncertainty is that of the expectation all the same.
    tighter
    rounds
        Most steps of the descent.
    """
    n_poses = count_poses(view, expected)
    x, algebraic = expected, sphere_centre(view.points, expected)
    if np.linalg.norm(algebraic - expected) < FAR * spread:
        x = min((expected, algebraic), key=lambda start: mean_residual(view, start))
    prior = np.eye(3) / spread**2
    if _has_skin(view):
        if hinge is not None:
            prior = prior + tighter_along(view, expected, tighter) / spread**2
        x, told = _fit(view, x, expected, prior, n_poses, hidden, rounds)
    else:
        # nearly without expectation a centre may flee along the axis: no place to start from
        loose = _fit(view, x, expected, 0.01 * prior, n_poses, hidden, rounds)[1].pull
        along = None if hinge is None else open_axis(loose, spread, hinge)
        if along is not None:
            prior = prior + (tighter**2 - 1) / spread**2 * np.outer(along, along)
        x, told = _fit(view, x, expected, prior, n_poses, hidden, rounds)
        if along is not None:  # what was not asked has told nothing
            across = np.eye(3) - np.outer(along, along)
            told = Told(*(across @ one @ across for one in told))
    return CentreFit(
        centre=x,
        noise=_robust_noise(view, x),
        data_covariance=data_covariance_of(told, spread),
        prior=prior,
        covariance=covariance_of(told, prior, off, spread),
        n_poses=n_poses,
    )


def with_expectation(
    centre: Array,
    told: Told | Array,
    spread: float,
    noise: float,
    n_poses: int,
    off: Array | None = None,
) -> CentreFit:
    """Return a centre found in another way, from what the motion told about it.

    Parameters
    ----------
    told
        Or its information alone, (3, 3) 1/m², where that says what its variance is.
    off : (3,) m
        From where the centre was expected to where it is: where nothing is told it is astray by
        that, too.
    """
    told = told if isinstance(told, Told) else Told(told, told)
    prior = np.eye(3) / spread**2
    covariance = covariance_of(told, prior, 1.0, spread)
    if off is not None:
        untold_of = np.linalg.solve(prior + told.pull, prior @ off)
        covariance = covariance + np.outer(untold_of, untold_of)
    return CentreFit(
        centre=centre,
        noise=noise,
        data_covariance=data_covariance_of(told, spread),
        prior=prior,
        covariance=covariance,
        n_poses=n_poses,
    )


def untold(fit: CentreFit, spread: float) -> CentreFit:
    """Return a centre of which, for a reason of its own, the motion tells nothing after all."""
    nothing = data_covariance_of(Told(np.zeros((3, 3)), np.zeros((3, 3))), spread)
    unsure = fit.covariance + spread**2 * np.eye(3)
    return replace(fit, data_covariance=nothing, covariance=unsure)


def _has_skin(view: View) -> bool:
    """Return whether it is known what goes with the joint, and in poses enough to reckon with."""
    turning = view.turning
    return turning is not None and turning.skin is not None and bool(turning.known.sum() >= FEW)


def _fit(
    view: View,
    x: Array,
    expected: Array,
    prior: Array,
    n_poses: int,
    hidden: float,
    rounds: int,
) -> tuple[Array, Told]:
    """Return the centre, and what the motion tells about it."""
    turning = view.turning
    if _has_skin(view):
        fit = fit_through_skin(view, x, expected, prior, n_poses, hidden=hidden, rounds=rounds)
        return fit.centre, fit.told
    # distances and orientation are two readings of the same sightings
    n_poses = n_poses if n_poses > UNKNOWNS else 0
    looks = n_poses / hidden**2 / (1 if turning is None else 2)
    x = descend(view, x, expected, prior, looks, rounds)
    information = find_information(view, x, looks)
    share = averaging_share(view, x)
    seen = view.sightings.seen  # what is hidden is no look
    n_seen = round(float(seen.sum(axis=0).mean())) if seen.any() else len(seen)
    # any four looks fit, whatever errs: the rest is worth less, but draws the centre nowhere
    over = overrated(share, n_seen, n_poses, hidden) * n_poses / max(n_poses - UNKNOWNS, 1)
    # and no number of poses tells a centre better than what lasts lets it be the same
    lasts = (1 - share) * _robust_noise(view, x) ** 2
    return x, Told(information, over * information + lasts * information @ information)


def _robust_noise(view: View, centre: Array) -> float:
    """Return the robust standard deviation in m of the distances that should stay the same."""
    points, seen, _, complete = view.sightings
    if points.shape[1] == 0:
        return 0.0
    distances = lengths(points - centre)
    off = np.abs(distances - column_medians(distances, None if complete else seen))
    return 1.4826 * float(np.median(off[seen]))
