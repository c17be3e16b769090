"""Joint centres of a moving skeleton, in whichever frames are asked for."""

import numpy as np
from numpy.typing import NDArray

from kinesphere.kernels.jit import kernel


@kernel
def joint_centres_kernel(
    rotations: NDArray[np.float64],
    origins: NDArray[np.float64],
    frames: NDArray[np.intp],
    parents: NDArray[np.intp],
    in_parent: NDArray[np.float64],
    in_child: NDArray[np.float64],
    centres: NDArray[np.float64],
) -> None:
    """Write every joint's centre in the world: by its parent, else by its child.

    Parameters
    ----------
    rotations, origins : (n_frames, n_limbs, 3, 3), (n_frames, n_limbs, 3) m
        ``world_from_limb``; NaN where unseen.
    frames : (n,)
    parents : (n_joints,)
        The limb that carries each joint; the child of joint ``j`` is limb ``j + 1``.
    in_parent, in_child : (n_joints, 3) m
    centres : (n, n_joints, 3) m
        Written; NaN where both limbs are unseen.
    """
    for k in range(len(frames)):
        f = frames[k]
        for j in range(len(parents)):
            limb, point = parents[j], in_parent[j]
            for _ in range(2):
                for i in range(3):
                    centres[k, j, i] = (
                        rotations[f, limb, i, 0] * point[0]
                        + rotations[f, limb, i, 1] * point[1]
                        + rotations[f, limb, i, 2] * point[2]
                        + origins[f, limb, i]
                    )
                if not np.isnan(centres[k, j, 0] + centres[k, j, 1] + centres[k, j, 2]):
                    break
                limb, point = j + 1, in_child[j]
