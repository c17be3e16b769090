"""Which of a joint's two solutions counts where turns about the limb are movements."""

import numpy as np

from kinesphere.data import Array, Mask
from kinesphere.parameterization.kernels import Branches, smoothest_branches

CALM = 8.0  # Hz, faster than limbs turn: what is above it is noise
NEVER = 1e6  # rad: where nothing speaks for small twists, nothing mends a leap between branches


def branches_of_movement(solutions: Array, calm: Array, twist_known: Mask) -> Branches:
    """Return the branch of every frame where the twist is a movement like the other angles.

    The path is chosen where noise hardly counts, and each frame takes the branch that is near it.
    Its mirror image is as smooth; of the two, the one of smaller angles serves.

    Parameters
    ----------
    solutions, calm : (n, 2, 3) rad
        Of the poses, and of the poses smoothed.
    twist_known : (n,)
    """
    at = np.arange(len(calm))
    path = smoothest_branches(calm, twist_known, 0.0, NEVER)
    told = np.where(twist_known[:, None], calm[at, path], 0.0)
    mirrored = np.where(twist_known[:, None], calm[at, 1 - path], 0.0)
    if np.nansum(mirrored**2) < np.nansum(told**2):
        path = 1 - path
    apart = np.abs(solutions - calm[at, path][:, None])
    apart = np.minimum(apart, 2 * np.pi - apart)
    apart[~twist_known, :, 2] = 0.0
    first, second = apart.sum(axis=2).T
    return np.asarray(second < first, dtype=np.int8)
