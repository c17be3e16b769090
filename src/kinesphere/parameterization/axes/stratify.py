"""One representative per cell of the joint sphere (paper section 4.2)."""

import numpy as np

from kinesphere.data import Array
from kinesphere.kernels.jit import kernel


def one_per_cell(points: Array, cell: float) -> Array:
    """Return the first point of every cell, (n, 3) and cell size in rad → (m, 3).

    Cells are bands of equal colatitude, each cut into pieces about as wide as high.
    """
    colatitude = np.arccos(np.clip(points[:, 1], -1, 1))
    band = np.floor(colatitude / cell).astype(int)
    around = np.maximum(1, np.round(2 * np.pi * np.sin((band + 0.5) * cell) / cell))
    turn = (np.arctan2(points[:, 2], points[:, 0]) / (2 * np.pi)) % 1.0
    key = band * 100_000 + np.floor(turn * around).astype(int)
    _, first = np.unique(key, return_index=True)
    return np.asarray(points[np.sort(first)])


def windowed(points: Array, cell: float) -> Array:
    """Return representatives in order: a new one once the limb is a cell away from the last.

    The windowed stratification of the paper keeps the order and lets a cell count again when it is
    visited again; measuring from the last representative instead of a fixed lattice keeps a
    limb on a border from chattering.
    """
    chord = 2 * np.sin(cell / 2)
    kept = [0]
    last = points[0]
    steps = np.linalg.norm(np.diff(points, axis=0), axis=1)
    travelled = np.concatenate([[0.0], np.cumsum(steps)])
    i = 0
    while True:
        # nothing within a chord's length of path can be a chord away: skip it
        i = int(np.searchsorted(travelled, travelled[kept[-1]] + chord, side="left"))
        while i < len(points) and np.linalg.norm(points[i] - last) < chord:
            i += 1
        if i >= len(points):
            return np.asarray(points[kept])
        kept.append(i)
        last = points[i]


@kernel
def turning_weights(rotations: Array, cell: float) -> Array:
    """Return how much each rotation counts, (n, 3, 3) and cell size in rad → (n,).

    As `windowed`, of whole orientations, but nothing is left out: from one representative to the
    next, a turn by a cell, all frames together count 1.
    """
    weights = np.empty(len(rotations))
    least = 1.0 + 2.0 * np.cos(cell)  # the trace of a turn by a cell
    last = 0
    for i in range(len(rotations) + 1):
        trace = -np.inf
        if i < len(rotations):
            trace = 0.0
            for j in range(3):
                for k in range(3):
                    trace += rotations[last, j, k] * rotations[i, j, k]
        if trace <= least:
            weights[last:i] = 1.0 / max(1, i - last)
            last = i
    return weights
