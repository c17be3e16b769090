"""Skin that moves with a joint: how much, and a joint's centre that reckons with it.

Markers sit on skin, and skin follows the joint: the same pose is always wrong in the same way, so
that no number of frames averages it out, and a centre takes it up as if it were motion. Here the
errors of both limbs' poses are unknowns as well, linear in the joint's rotation. Their size is the
data's word: in proportion to what the markers' residuals show of it.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from kinesphere.geometry.centre_terms import soft_weights
from kinesphere.geometry.centre_views import Turning, View
from kinesphere.geometry.pose_errors import point_covariance
from kinesphere.geometry.rotations import hat, mean_rotation, rotation_log
from kinesphere.geometry.vectors import is_seen, lengths

Array = NDArray[np.float64]

LEAST = 1e-7
"""m, movement of a marker with the skin below which there is none: rounding is all it is."""
NONE = 1e-12
"""m, what stands for none."""
RIGID = 1.5
"""How many times more of the skin's movement is rigid, and shows in no residual, than is not: on
synthetic skin the errors of hips are least from 1 to 1.5."""
ONE_AXIS = 0.05
"""Share of the widest rotation's variance below which the second-widest counts as none."""
DENSE = np.deg2rad(5.0)
"""rad, poses of a hinge nearer to each other than this share their weight."""
FEW = 10
"""Poses below which nothing is said about skin."""
STILL = 1e-3
"""rad, rms rotation of a joint below which nothing can be said to go with it."""
LUCK = 1.0
DOUBT = 0.5
"""Relative standard deviation of what is known of shake."""
ROUNDING = 1e-13
"""Share of each unknown's own weight that keeps equations solvable: what rounding leaves."""
SETTLED = 1e-6
"""m, step that ends the fit."""


def joint_turns(rotations: Array) -> Array:
    """Return the joint's rotation away from its mean, rad; (n, 3, 3) → (n, 3)."""
    turns = rotation_log(mean_rotation(rotations).T @ rotations)
    centred: Array = turns - turns.mean(axis=0)
    return centred


def joint_modes(rotations: Array) -> Array:
    """Return the joint's rotation away from its mean, over its rms; (n, 3, 3) → (n, 3)."""
    turns = joint_turns(rotations)
    modes: Array = turns / max(float(np.sqrt((turns**2).sum(axis=1).mean() / 3)), STILL)
    return modes


def has_one_axis(turns: Array, blur: float) -> bool:
    """Return whether a joint turns about one axis alone, from its turns (n, 3) rad.

    Parameters
    ----------
    turns
        As `joint_turns` returns them.
    blur
        rad², variance of the rotation that noise and skin can feign: what turns farther than that
        about a second axis is a second axis, however small.
    """
    variances = np.linalg.eigvalsh(turns.T @ turns / len(turns))
    return bool(variances[1] < min(ONE_AXIS * variances[2], blur))


def feigned(view: View, hidden: float) -> float:
    """Return the variance of a joint's rotation, rad², that noise and skin can feign at most."""
    turning = view.turning
    assert turning is not None
    assert turning.skin is not None
    assert turning.skin_seeing is not None
    skin, noise = (turning.skin, turning.skin_seeing), (turning.pose, view.pose)
    most = [float(np.linalg.eigvalsh(c[:3, :3])[-1]) for c in (*skin, *noise)]
    return hidden**2 * (most[0] + most[1]) + most[2] + most[3]


def hinge_axis(view: View, hidden: float) -> Array | None:
    """Return the one axis a joint turns about, (3,); None if it has more.

    In the frame of the seeing limb. Fewer than `FEW` poses tell nothing.
    """
    turning = view.turning
    if turning is None or turning.skin is None or turning.known.sum() < FEW:
        return None
    r = turning.rotations[turning.known]
    turns = joint_turns(r)
    if not has_one_axis(turns, feigned(view, hidden)):
        return None
    axis: Array = mean_rotation(r) @ np.linalg.eigh(turns.T @ turns)[1][:, 2]
    return axis


def main_axis(view: View) -> Array | None:
    turning = view.turning
    if turning is None or turning.known.sum() < FEW:
        return None
    r = turning.rotations[turning.known]
    turns = joint_turns(r)
    values, vectors = np.linalg.eigh(turns.T @ turns)
    axis: Array = mean_rotation(r) @ vectors[:, 2]
    return axis, values[1] / max(values[2], 1e-300)


def skin_noise(local: Array, shape: Array, modes: Array) -> Array:
    """Return how far each marker moves in its limb with a joint, m rms in each direction, (m,).

    Parameters
    ----------
    local : (n_frames, n_markers, 3) m
        Markers in their limb's frame; NaN where not seen.
    shape : (n_markers, 3) m
    modes : (n_frames, 3)
        As `joint_modes` returns them.
    """
    n = local.shape[1]
    noise = np.zeros(n)
    for m in range(n):
        off = local[:, m] - shape[m]
        known = is_seen(off)
        if known.sum() < FEW:
            continue
        q = modes[known] - modes[known].mean(axis=0)
        slope = np.linalg.lstsq(q, off[known] - off[known].mean(axis=0), rcond=1e-6)[0]
        noise[m] = np.sqrt(np.mean((q @ slope) ** 2))
    # the fit itself takes up six of the coordinates: what is left looks smaller than it is
    noise *= np.sqrt(3 * n / max(3 * n - 6, 1))
    return np.where(noise > LEAST, noise, NONE)


def pose_weights(rotations: Array) -> Array:
    """Return weights that make every pose count alike, however long it was held, (n,) of mean 1."""
    weights = 1 / crowds(rotations)
    return np.asarray(weights / weights.mean())


def crowds(rotations: Array) -> Array:
    flat = rotations.reshape(len(rotations), 9)
    angle2 = np.maximum(3.0 - flat @ flat.T, 0.0)  # nearly the square of the angle between them
    return np.asarray(np.exp(-angle2 / (2 * DENSE**2)).sum(axis=1))


class SkinFit(NamedTuple):
    """A joint's centre where skin moves with the joint."""

    centre: Array
    """(3,) m, in the seeing limb."""
    information: Array
    """(3, 3) 1/m², what the motion tells about it."""


class _Skin(NamedTuple):
    """What goes with the joint."""

    modes: Array
    """(n, k): three, or none where the joint is a hinge."""
    seeing: Array
    """(6, 6) square root of the covariance of what it does to the seeing limb's pose."""
    turning: Array
    """(6, 6) the same of the turning limb's."""


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
    have a soft-L1 loss. The information reckons with ``hidden`` instead of `RIGID`.

    Errors that are not linear in the rotation stay, and no number of poses averages them out: as
    everywhere, a look is worth 1/``hidden``² of what its residual says.

    A hinge tells nothing apart that is linear in its one angle: there skin is not modelled, and
    poses count alike however long they were held, so that skin errs alike in trials that dwell
    elsewhere.

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
    modes, poses = joint_modes(rotations), looks
    near = _nearest(turning.back)
    crowd = np.ones(len(modes))
    if has_one_axis(joint_turns(rotations), feigned(view, hidden)):
        modes, crowd = modes[:, :0], crowds(turning.back)
    skin = _Skin(modes, RIGID * _root(turning.skin_seeing), RIGID * _root(turning.skin))
    x, inner = start, turning.place(start).mean(axis=0)
    z = np.zeros(12 * modes.shape[1])
    ones = np.concatenate([np.zeros(6), np.ones(len(z))])
    for _ in range(rounds):
        residual, columns, whitening = _equations(view, turning, x, inner, skin)
        scale, soft = soft_weights(lengths(residual + columns[:, :, 6:] @ z)[:, None], None, 3)
        strays = residual + columns[:, :, 6:] @ z
        white = np.median(((strays - strays[near]) ** 2).sum(1)) / 2 / np.median((strays**2).sum(1))
        white = float(min(white, 1.0))
        lasting = 1 - white + LUCK / np.sqrt(len(strays))
        share = 1 / (white + hidden**2 * lasting * crowd)
        share = share / share.sum()
        looks = _looks(white, len(strays), poses, hidden)
        w = share * soft[:, 0] * (looks / scale[0] ** 2)
        flat = columns.reshape(-1, columns.shape[2])
        weighed = (columns * w[:, None, None]).reshape(flat.shape)
        told = weighed.T @ flat
        rest = told[3:, 3:] + np.diag(ones[3:])
        rest[:3, :3] += 1e-9 * np.trace(told[3:6, 3:6]) * np.eye(3)
        gradient = weighed.T @ residual.ravel()
        shake, drawn = _shake(view, turning, x, whitening, w * min(1.0, scale[0] ** 2))
        follow = _solve(rest, told[3:, :3])
        left = told[:3, :3] - told[:3, 3:] @ follow
        kept, heard = _cleared(left, shake, drawn)
        pull = prior @ (x - expected)
        pull = pull + heard @ (gradient[:3] - follow.T @ gradient[3:] - drawn)
        step = -_solve(prior + heard @ kept, pull)
        length = float(np.linalg.norm(step))
        short = min(1.0, 0.05 / max(length, 1e-12))
        others = -_solve(rest, gradient[3:]) - follow @ step
        x, inner, z = x + short * step, inner + short * others[:3], others[3:]
        if length < SETTLED:
            break
    # for what is told, skin may be as large as settings allow for
    rest = rest - (1 - (RIGID / hidden) ** 2) * np.diag(ones[3:])
    left = told[:3, :3] - told[:3, 3:] @ _solve(rest, told[3:, :3])
    kept, heard = _cleared(left, shake, drawn)
    return SkinFit(x, heard @ kept)


def _nearest(rotations: Array) -> NDArray[np.int64]:
    flat = rotations.reshape(len(rotations), 9)
    alike = flat @ flat.T
    np.fill_diagonal(alike, -np.inf)
    return alike.argmax(axis=1)


def _looks(white: float, n: int, poses: float, hidden: float) -> float:
    white = min(white, 1.0)
    lasting = 1 - white + LUCK / np.sqrt(n)
    return 1 / (white / n + hidden**2 * lasting / poses)


def _shake(
    view: View, turning: Turning, x: Array, white: Array, weights: Array
) -> tuple[Array, Array]:
    """Return what shaking orientations feign: information (3, 3) and gradient (3,) by the centre."""
    back = turning.back
    metric = white.T @ white
    q, linear = _noise_gradient(metric, turning.pose)
    shake = np.einsum("n,nki,kl,nlj->ij", weights, back, q, back)
    drawn = np.einsum("n,nki,nk->i", weights, back, turning.place(x) @ q + linear)
    carried = np.einsum("n,nki,kl,nlj->ij", weights, back, metric, back)
    q, linear = _noise_gradient(carried, view.pose)
    return shake + q, drawn + q @ x + linear


_ARMS = np.concatenate([-hat(np.eye(3)), np.zeros((3, 3, 3))], axis=2)
_STILL = np.concatenate([np.zeros((3, 3)), np.eye(3)], axis=1)


def _noise_gradient(metric: Array, pose: Array) -> tuple[Array, Array]:
    """Return half the gradient of tr(metric · point_covariance(pose, p)) as q, l of q p + l."""
    moved = metric @ _ARMS @ pose  # (3, 3, 6)
    return np.einsum("iab,jab->ij", moved, _ARMS), np.einsum("iab,ab->i", moved, _STILL)


def _cleared(left: Array, shake: Array, drawn: Array) -> tuple[Array, Array]:
    """Return what is left of information without shake, and how gradients are heard."""
    values, vectors = np.linalg.eigh(left)
    root = vectors * np.sqrt(np.maximum(values, 1e-12 * values[2]))
    inverse = vectors / np.sqrt(np.maximum(values, 1e-12 * values[2]))
    told, axes = np.linalg.eigh(np.eye(3) - inverse.T @ shake @ inverse)
    axes = root @ axes
    kept = (axes * np.maximum(told, 0.0)) @ axes.T
    doubt = left + DOUBT**2 * np.outer(drawn, drawn)
    heard = np.linalg.solve(doubt, kept).T
    return kept, heard


def _solve(matrix: Array, right: Array) -> Array:
    """Solve symmetric equations whose unknowns may differ in size by 10⁸ and more."""
    sizes = 1 / np.sqrt(np.maximum(np.diag(matrix), 1e-300))
    scaled = sizes[:, None] * matrix * sizes + ROUNDING * np.eye(len(sizes))
    rows = sizes if right.ndim == 1 else sizes[:, None]
    solved: Array = rows * np.linalg.solve(scaled, rows * right)
    return solved


def _root(covariance: Array) -> Array:
    values, vectors = np.linalg.eigh(covariance)
    root: Array = vectors * np.sqrt(np.maximum(values, 0.0))
    return root


def _equations(
    view: View, turning: Turning, x: Array, inner: Array, skin: _Skin
) -> tuple[Array, Array, Array]:
    """Return residuals (n, 3) over their noise, and their derivatives (n, 3, 6 + 12 k).

    By the centre in either limb, and by the maps from the joint's rotation to their poses' errors.
    """
    n, k = skin.modes.shape
    products = turning.means[1]
    carried = (products @ point_covariance(view.pose, x).ravel()).reshape(3, 3)
    noise = point_covariance(turning.pose, inner) + carried + turning.noise**2 * np.eye(3)
    values, vectors = np.linalg.eigh(noise)
    w = (vectors / np.sqrt(np.maximum(values, turning.noise**2))) @ vectors.T
    back = w @ turning.back
    columns = np.empty((n, 3, 6 + 12 * k))
    columns[:, :, :3] = back
    columns[:, :, 3:6] = -w
    if k:
        seeing = np.concatenate([-hat(x), np.eye(3)], axis=1) @ skin.seeing
        own = np.concatenate([-hat(inner), np.eye(3)], axis=1) @ skin.turning
        middle = 6 + 6 * k
        moved = (back @ seeing)[:, :, None] * skin.modes[:, None, :, None]
        columns[:, :, 6:middle] = moved.reshape(n, 3, -1)
        moved = -(w @ own)[None, :, None] * skin.modes[:, None, :, None]
        columns[:, :, middle:] = moved.reshape(n, 3, -1)
    return (turning.place(x) - inner) @ w.T, columns, w
