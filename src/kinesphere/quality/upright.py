"""Which of a file's six directions is up: what the body says, what the floor says.

The body: most of the time a person's head is above the feet. The floor: along the true up the
lowest marker stays where it is, standing or lying, while along every other direction the end of
the body moves about. Neither needs units, and neither alone settles an acrobat.
"""

from dataclasses import dataclass

import numpy as np

from kinesphere.data import DIRECTIONS, Array, Recording, vector_from_direction
from kinesphere.quality.body import LongAxes, labelled_columns

WITHIN = 0.8
"""Cosine of 37°: a person this close to a direction is upright along it; no two directions
qualify at once."""


@dataclass(frozen=True)
class Evidence:
    """What speaks for each direction, in the order of ``DIRECTIONS``."""

    upright: Array
    """(6,) share of person-frames in which the head is above the feet along it; NaN: no body."""
    sway: Array
    """(6,) how much the lowest marker along it moves, 10–90 % over frames, in sizes of the scene
    per frame; NaN: nothing seen."""
    floor: Array
    """(6,) height of the lowest marker along it, median over frames, in the same sizes."""
    extent: Array
    """(3,) median extent along each axis, in the same sizes."""
    below: str = "feet"
    """What the head is seen from, in words."""


def find_evidence(recording: Recording, long_axes: LongAxes) -> Evidence:
    """Weigh the six directions.

    Parameters
    ----------
    long_axes
        Which way bodies stand.
    """
    columns = labelled_columns(recording) or list(range(recording.n_markers))
    someone = recording.seen[:, columns].any(axis=1)
    points = recording.markers[someone][:, columns]
    if len(points) == 0:
        unknown = np.full(6, np.nan)
        return Evidence(unknown, unknown, unknown, unknown[:3], long_axes.below)
    low, high = np.nanmin(points, axis=1), np.nanmax(points, axis=1)  # (n_frames, 3)
    extent = np.median(high - low, axis=0)
    travel = high.max(axis=0) - low.min(axis=0)
    size = float(np.linalg.norm(extent)) or float(np.linalg.norm(travel)) or 1.0
    ends = np.stack([low, -high], axis=2).reshape(len(points), 6)  # the order of DIRECTIONS
    spread = np.percentile(ends, 90, axis=0) - np.percentile(ends, 10, axis=0)
    ways, below = long_axes
    along = ways @ np.array([vector_from_direction(d) for d in DIRECTIONS]).T
    upright = (along > WITHIN).mean(axis=0) if len(ways) else np.full(6, np.nan)
    floor = np.median(ends, axis=0) / size
    return Evidence(upright, spread / size, floor, extent / size, below)
