"""How fast a limb twists: inner loops of movement phases."""

import numpy as np

from kinesphere.data import Array
from kinesphere.kernels.jit import kernel
from kinesphere.parameterization.samples import Frames


@kernel
def turned_between(rotations: Array, before: Frames, after: Frames) -> Array:
    """Return how far something turns from one frame to another, (n,) rad.

    Parameters
    ----------
    rotations : (n_frames, 3, 3)
        NaN gives NaN.
    before, after : (n,)
        Frames from which and to which it turns.
    """
    n = len(before)
    turned = np.empty(n)
    for f in range(n):
        a, b = rotations[before[f]], rotations[after[f]]
        chord = 0.0
        for i in range(3):
            for j in range(3):
                chord += (b[i, j] - a[i, j]) ** 2
        # the chord is precise for small angles, where the trace is not
        sine = np.sqrt(chord / 8.0)
        turned[f] = np.pi if sine > 1.0 else 2.0 * np.arcsin(sine)
    return turned
