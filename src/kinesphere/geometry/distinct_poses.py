"""How many different poses a limb shows."""

import numpy as np
from numpy.typing import NDArray

from kinesphere.geometry.centre_views import View
from kinesphere.geometry.vectors import lengths

Array = NDArray[np.float64]

CELL = np.deg2rad(10.0)
"""rad, poses nearer to each other than this count as one: soft tissue errs alike in both."""


def count_poses(view: View, centre: Array) -> int:
    """Return how many distinct poses there are: cells of `CELL` on the markers' spheres."""
    most = 1
    for seen in np.moveaxis(view.points, 1, 0) - centre:
        y = seen[np.isfinite(seen).all(axis=1)]
        if len(y) == 0:
            continue
        radius = max(float(np.median(lengths(y))), 1e-9)
        cells = np.floor(y / (radius * CELL)).astype(np.int64)
        most = max(most, _count_distinct(cells))
    return most


def _count_distinct(cells: NDArray[np.int64]) -> int:
    """Return how many rows differ, (n, 3)."""
    ordered = cells[np.lexsort(cells.T)]
    return 1 + int((ordered[1:] != ordered[:-1]).any(axis=1).sum())
