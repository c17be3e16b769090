"""The one loop of normalization that runs over every frame and limb."""

import numpy as np

from kinesphere.data import Array
from kinesphere.kernels.jit import kernel


@kernel
def move_frames(
    rotations: Array, origins: Array, turns: Array, shifts: Array
) -> tuple[Array, Array]:  # pragma: no cover - compiled
    """Turn and shift every limb's frame within the limb.

    Parameters
    ----------
    rotations, origins : (n_frames, n_limbs, 3, 3), (n_frames, n_limbs, 3) m
        ``world_from_old``.
    turns, shifts : (n_limbs, 3, 3), (n_limbs, 3) m
        ``old_from_new``.

    Returns
    -------
    rotations, origins
        ``world_from_new``, of the same shapes; NaN stays NaN.
    """
    turned = np.empty_like(rotations)
    moved = np.empty_like(origins)
    for f in range(rotations.shape[0]):
        for i in range(rotations.shape[1]):
            for a in range(3):
                x, y, z = rotations[f, i, a, 0], rotations[f, i, a, 1], rotations[f, i, a, 2]
                for b in range(3):
                    turned[f, i, a, b] = (
                        x * turns[i, 0, b] + y * turns[i, 1, b] + z * turns[i, 2, b]
                    )
                moved[f, i, a] = (
                    origins[f, i, a] + x * shifts[i, 0] + y * shifts[i, 1] + z * shifts[i, 2]
                )
    return turned, moved
