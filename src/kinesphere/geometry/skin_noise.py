"""How far markers move with skin that goes with a joint: the part that residuals show."""

import numpy as np
from numpy.typing import NDArray

from kinesphere.geometry.rotations import hat
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
    noise *= _left_by_fits(shape, is_seen(local))
    return np.where(noise > LEAST, noise, NONE)


def _left_by_fits(shape: Array, seen: NDArray[np.bool_]) -> float:
    """Return how many times as large skin is as what rigid fits leave of it on average.

    A fit takes up six of the coordinates that a frame shows, others in each set of markers that is
    seen: what goes with the joint is the mean of what they leave.
    """
    n, moved = len(shape), np.concatenate([-hat(shape), np.tile(np.eye(3), (len(shape), 1, 1))], 2)
    if seen.all():
        return float(np.sqrt(3 * n / max(3 * n - 6, 1)))
    sets, times = np.unique(seen, axis=0, return_counts=True)
    left, total = np.zeros((3 * n, 3 * n)), np.zeros(n)
    for shown, count in zip(sets, times, strict=True):
        own = np.repeat(shown, 3)
        basis = np.where(own[:, None], np.nan_to_num(moved).reshape(3 * n, 6), 0.0)
        left += count * (np.diag(own.astype(float)) - basis @ np.linalg.pinv(basis, rcond=1e-6))
        total += count * shown
    rows = np.repeat(np.maximum(total, 1), 3)
    squares = float(((left / rows[:, None]) ** 2).sum())
    often = 3 * int((total >= FEW).sum())
    return float(np.sqrt(often / max(squares, 1.0)))
