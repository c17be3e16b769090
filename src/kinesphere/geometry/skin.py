"""Skin that moves with a joint: how much, and a joint's centre that reckons with it.

Markers sit on skin, and skin follows the joint: the same pose is always wrong in the same way, so
that no number of frames averages it out, and a centre takes it up as if it were motion. Here the
errors of both limbs' poses are unknowns as well, linear in the joint's rotation. Their size is the
data's word: in proportion to what the markers' residuals show of it.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from kinesphere.geometry.centre_covariance import Told, scatter_of
from kinesphere.geometry.centre_terms import soft_weights
from kinesphere.geometry.centre_views import View
from kinesphere.geometry.joint_turns import (
    crowds,
    has_one_axis,
    joint_turns,
    modes_of,
    nearest_poses,
)
from kinesphere.geometry.pose_worth import crowding, noise_share, pose_worth
from kinesphere.geometry.shake import clear_of_shake, doubt_of, find_shake
from kinesphere.geometry.skin_equations import Skin, equations, root_of
from kinesphere.geometry.vectors import lengths

Array = NDArray[np.float64]

RIGID = 1.5
"""How many times more of the skin's movement is rigid, and shows in no residual, than is not: on
synthetic skin the errors of hips are least from 1 to 1.5."""
SKIN_TOLD = 2 / 3
"""Share of the skin that settings allow for that is to be expected. With half of it synthetic
centres are off by 0.6 of what is told, hips of one person in several trials by 1.6."""
ROUNDING = 1e-13
"""Share of each unknown's own weight that keeps equations solvable: what rounding leaves."""
SETTLED = 1e-6
"""m, step that ends the fit."""


def feigned(view: View, hidden: float) -> float:
    """Return the variance of a joint's rotation, rad², that noise and skin can feign at most."""
    turning = view.turning
    assert turning is not None
    assert turning.skin is not None
    assert turning.skin_seeing is not None
    skin, noise = (turning.skin, turning.skin_seeing), (turning.pose, view.pose)
    most = [float(np.linalg.eigvalsh(c[:3, :3])[-1]) for c in (*skin, *noise)]
    return hidden**2 * (most[0] + most[1]) + most[2] + most[3]


class SkinFit(NamedTuple):
    """A joint's centre where skin moves with the joint."""

    centre: Array
    """(3,) m, in the seeing limb."""
    told: Told
    """What the motion tells about it."""


def fit_through_skin(
    view: View,
    start: Array,
    expected: Array,
    prior: Array,
    looks: float,
    *,
    hidden: float = 1.0,
    rounds: int = 50,
) -> SkinFit:
    """Fit the point two limbs share, pose errors that go with the joint among the unknowns.

    SCoRE's residual [1]_ in the turning limb, over the noise that both poses give it, with a linear
    map from the joint's rotation to each pose's error. The maps have a normal prior: the covariance
    each pose would have if its markers moved `RIGID` times as far as `skin_noise` says. Residuals
    have a soft-L1 loss.

    Errors that are not linear in the rotation stay. What of the residuals is alike in poses alike
    no number of frames averages out: of that, a look is worth 1/``hidden``². A joint that turns
    little tells skin and centre apart badly: see `kinesphere.geometry.pose_worth.crowding`.

    A hinge tells nothing apart that is linear in its one angle: there skin is not modelled, and as
    far as errors last, poses count alike however long they were held, so that skin errs alike in
    trials that dwell elsewhere.

    How uncertain the centre is follows from what was weighed, not from the weights: residuals of
    poses alike, skin of `SKIN_TOLD` times ``hidden`` times what residuals show, and what is not
    known of the shake.

    What noise in the orientations feigns is taken off, as far as the residuals are noise: see
    `kinesphere.geometry.shake`.

    Parameters
    ----------
    view
        With a turning limb of which `Turning.skin` is known.
    start, expected : (3,) m
    prior : (3, 3) 1/m²
    looks
        How many independent looks at the centre all the frames make.
    hidden
        As `kinesphere.geometry.centres.fit_centre` takes it.
    rounds
        Most steps of the descent.

    References
    ----------
    .. [1] Ehrig et al. (2006), J. Biomech. 39(15), 2798-2809, doi:10.1016/j.jbiomech.2005.10.002.
    """
    turning = view.turning
    assert turning is not None
    assert turning.skin is not None
    assert turning.skin_seeing is not None
    rotations = turning.rotations[turning.known]
    turns, near = joint_turns(rotations), nearest_poses(turning.back)
    hinge, modes = has_one_axis(turns, feigned(view, hidden)), modes_of(turns)
    alike = crowds(rotations)
    crowd = alike if hinge else crowding(turns, alike)
    whole = Skin(modes, RIGID * root_of(turning.skin_seeing), RIGID * root_of(turning.skin))
    skin = whole._replace(modes=modes[:, :0]) if hinge else whole
    x, inner = start, turning.place(start).mean(axis=0)
    z, length = np.zeros(12 * skin.modes.shape[1]), np.inf
    ones = np.concatenate([np.zeros(3), np.ones(len(z))])
    for _ in range(rounds):
        residual, columns, whitening = equations(view, turning, x, inner, skin)
        strays = residual + columns[:, :, 6:] @ z
        scale, soft = soft_weights(lengths(strays)[:, None], None, 3)
        share = noise_share(strays, near)
        w = soft[:, 0] / scale[0] ** 2 * pose_worth(share, crowd, looks, hidden)
        flat = columns.reshape(-1, columns.shape[2])
        weighed = (columns * w[:, None, None]).reshape(flat.shape)
        told, gradient = weighed.T @ flat, weighed.T @ residual.ravel()
        others = told[3:, 3:] + np.diag(ones)
        others[:3, :3] += 1e-9 * np.trace(told[3:6, 3:6]) * np.eye(3)
        # poses say how large their noise is, unless what is left is less
        squares = np.einsum("nk,nk->n", strays, strays)
        size = min(1.0, float(w @ squares / w.sum()) / 3)
        # what lasts and is fitted along does not shake: the share that does is known to lie between
        # `share` and one, for poses alike shake alike
        size *= 1.0 if hinge else np.sqrt(share)
        shake, drawn = find_shake(view, turning, x, whitening, w * size)
        doubt = doubt_of(shake, drawn + shake @ (expected - x), prior)
        follow = _solve(others, told[3:, :3])
        curve, heard = clear_of_shake(told[:3, :3] - told[:3, 3:] @ follow, shake, doubt)
        if length < SETTLED:  # all of it is told at the centre itself
            break
        score = gradient[:3] - follow.T @ gradient[3:] - drawn
        step = -_solve(prior + heard @ curve, prior @ (x - expected) + heard @ score)
        moved = -_solve(others, gradient[3:]) - follow @ step
        length = float(np.linalg.norm(step))
        short = min(1.0, 0.05 / max(length, 1e-12))
        x, inner, z = x + short * step, inner + short * moved[:3], moved[3:]
    free = columns[:, :, :3] - columns[:, :, 3:] @ follow
    pushed = follow[3:].T  # by skin as far as it is not fitted along: of a hinge by all of it
    if hinge:
        moved = equations(view, turning, x, inner, whole)[1][:, :, 6:]
        pushed = np.einsum("nki,n,nkj->ij", free, w, moved, optimize=True)
    scores = np.einsum("nki,nk->ni", free, w[:, None] * strays)
    scatter = scatter_of(scores, share, alike)
    scatter += (SKIN_TOLD * hidden / RIGID) ** 2 * pushed @ pushed.T + doubt
    return SkinFit(x, Told(heard @ curve, heard @ scatter @ heard.T))


def _solve(matrix: Array, right: Array) -> Array:
    """Solve symmetric equations whose unknowns may differ in size by 10⁸ and more."""
    sizes = 1 / np.sqrt(np.maximum(np.diag(matrix), 1e-300))
    scaled = sizes[:, None] * matrix * sizes + ROUNDING * np.eye(len(sizes))
    rows = sizes if right.ndim == 1 else sizes[:, None]
    solved: Array = rows * np.linalg.solve(scaled, rows * right)
    return solved
