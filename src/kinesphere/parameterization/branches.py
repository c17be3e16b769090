"""Which of a joint's two solutions counts, frame by frame."""

import numpy as np

from kinesphere.data import Array, Mask
from kinesphere.parameterization.kernels import Branches, smoothest_branches

CALM = 8.0  # Hz, faster than limbs turn: what is above it is noise
USUAL = 50.0  # Hz, where nobody says
SIZE = 2.0  # rad/s for each rad² of all angles: the other branch lies about a half turn off in two
# of them, so of paths that are as smooth the one of smaller angles is cheaper within a second
PATIENCE = 0.25  # rad per frame for a second: a leap between branches that lie apart. A limb spun
# about itself keeps its branch, one mistaken at a singularity finds back
UNSEEN = 0.1  # s; within longer gaps a limb may have passed a singularity, and no leap is told
BESIDE_REST = np.array([0.0, 1e-3])  # rad a frame, where no twist is known


def branches_of_small_twist(
    solutions: Array, twist_known: Mask, twist_cost: float, rate: float
) -> Branches:
    """Return the branch of every frame where the twist is what two axes leave over.

    Parameters
    ----------
    solutions : (n, 2, 3) rad
    twist_known : (n,)
    twist_cost
        rad a frame for each rad² of twist.
    rate
        Hz; 0 where unknown.
    """
    own = twist_cost * solutions[:, :, 2] ** 2
    return _path(solutions, twist_known, own, rate)


def branches_of_movement(solutions: Array, calm: Array, twist_known: Mask, rate: float) -> Branches:
    """Return the branch of every frame where the twist is a movement like the other angles.

    The path is chosen where noise hardly counts, and each frame takes the branch that is near it.

    Parameters
    ----------
    solutions, calm : (n, 2, 3) rad
        Of the poses, and of the poses smoothed.
    twist_known : (n,)
    rate
        Hz; 0 where unknown.
    """
    path = _path(calm, twist_known, np.zeros(calm.shape[:2]), rate)
    apart = np.abs(solutions - calm[np.arange(len(calm)), path][:, None])
    apart = np.minimum(apart, 2 * np.pi - apart)
    apart[~twist_known, :, 2] = 0.0
    first, second = apart.sum(axis=2).T
    return np.asarray(second < first, dtype=np.int8)


def _path(solutions: Array, twist_known: Mask, own: Array, rate: float) -> Branches:
    """Return the smoothest path, of similar ones that of smaller angles."""
    rate = rate or USUAL
    squares = np.einsum("nbi,nbi->nb", solutions, solutions)
    own = own + SIZE / rate * squares
    own = np.where(twist_known[:, None], own, BESIDE_REST)
    nearby = max(1, round(UNSEEN * rate))
    return smoothest_branches(solutions, twist_known, own, PATIENCE * rate, nearby)
