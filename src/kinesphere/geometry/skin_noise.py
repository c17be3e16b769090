"""How far markers move with skin that goes with a joint: the part that residuals show."""

import numpy as np
from numpy.typing import NDArray

from kinesphere.geometry.rigid import left_by_fit
from kinesphere.geometry.vectors import is_seen

Array = NDArray[np.float64]

LEAST = 1e-7
"""m, movement of a marker with the skin below which there is none: rounding is all it is."""
NONE = 1e-12
"""m, what stands for none."""
BY_CHANCE = 0.05
"""Share of the variance that goes with a joint which is left to skin if chance explains it all."""
FEW = 10
"""Poses below which nothing is said about skin."""


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
    noise, chance = np.zeros(n), np.zeros(n)
    for m in range(n):
        off = local[:, m] - shape[m]
        known = is_seen(off)
        if known.sum() < FEW:
            continue
        q = modes[known] - modes[known].mean(axis=0)
        off = off[known] - off[known].mean(axis=0)
        slope = np.linalg.lstsq(q, off, rcond=1e-6)[0]
        noise[m] = np.sqrt(np.mean((q @ slope) ** 2))
        chance[m] = 3 * np.mean((off - q @ slope) ** 2) / max(len(q) - 4, 1)
    # noise goes with a joint by chance, too: as much of it in every marker, give or take
    total, most = float((noise**2).sum()), 1 + 2 * np.sqrt(2 / (9 * n))
    noise *= np.sqrt(max(1 - most * chance.sum() / max(total, 1e-300), BY_CHANCE))
    noise *= left_by_fit(is_seen(local))
    return np.where(noise > LEAST, noise, NONE)
