"""What a pose is worth for a centre: noise averages out over frames, skin does not."""

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

LUCK = 3.0
"""Standard errors of the share of residuals that lasts by which it may be larger than it looks."""
NARROW = np.deg2rad(10.0)
"""rad, rms rotation about its widest axis at which a joint turns little: see `crowding`."""


COHERENT = 0.02
"""Share of all poses, whatever they are like, in which what lasts errs alike at least."""


def noise_share(strays: Array, near: NDArray[np.int64]) -> float:
    """Return the share of the residuals' variance that averages out, 0…1.

    It differs between poses most alike; the rest lasts.

    Parameters
    ----------
    strays : (n, 3)
        Residuals.
    near : (n,)
        As `kinesphere.geometry.joint_turns.nearest_poses` returns it.
    """
    apart = np.median(_squares(strays - strays[near])) / 2
    return min(float(apart / max(np.median(_squares(strays)), 1e-300)), 1.0)


def _squares(vectors: Array) -> Array:
    """Return the squares of lengths, (n, k) → (n,)."""
    return np.asarray(np.einsum("nk,nk->n", vectors, vectors))


def pose_worth(share: float, crowd: Array, looks: float, hidden: float) -> Array:
    """Return what each pose is worth, in looks at the centre, (n,).

    What lasts is alike in poses alike, as is ``hidden``² times as much that no residual shows:
    frames of one pose share it.

    Parameters
    ----------
    share
        As `noise_share` returns it.
    crowd : (n,)
        How many frames share what lasts with each pose.
    looks
        How many independent poses there are.
    hidden
        As `kinesphere.geometry.centres.fit_centre` takes it.
    """
    n = len(crowd)
    lasting = hidden**2 * (1 - share + LUCK / np.sqrt(n))
    shares = 1 / (share + lasting * crowd)
    worth: Array = shares / shares.sum() / (share / n + lasting / looks)
    return worth


def overrated(share: float, n_frames: int, n_poses: int, hidden: float) -> float:
    """Return how many times a centre's variance is what looks say that take all strays to last.

    Such looks are as many as poses, each worth 1/``hidden``² of what its residual says. What lasts
    errs alike in a share of all poses: that much no number of them averages out.

    Parameters
    ----------
    share
        As `noise_share` returns it.
    """
    averages = share * n_poses / hidden**2 / max(n_frames, n_poses)
    return averages + (1 - share) * (1 + COHERENT * n_poses)


def crowding(turns: Array, crowd: Array) -> Array:
    """Return how many frames share what lasts with each pose, where skin is fitted along, (n,).

    Where a joint turns far, skin that goes with it is told apart from its centre, and every frame
    counts as one. Where it turns little it is not: there a frame shares what lasts with all whose
    pose is like it, lest the many at rest, in which other joints move the skin, outvote the few
    that tell anything. Between the two the one fades into the other.

    Parameters
    ----------
    turns : (n, 3) rad
        As `kinesphere.geometry.joint_turns.joint_turns` returns them.
    crowd : (n,)
        As `kinesphere.geometry.joint_turns.crowds` returns it.
    """
    widest = float(np.linalg.eigvalsh(turns.T @ turns / len(turns))[2])
    little = 1 / (1 + (widest / NARROW**2) ** 2)
    shared: Array = crowd**little
    return shared
