"""Distances between markers over a recording: what labelling recognises a layout by."""

import numpy as np

from kinesphere.data import MarkerStatistics, Recording
from kinesphere.skeleton.sampling import spread_frames

FRAMES = 500
"""Most frames looked at."""


def marker_statistics(recording: Recording, labels: tuple[str, ...], name: str) -> MarkerStatistics:
    """Return mean and standard deviation of every distance between two markers.

    Parameters
    ----------
    labels
        Which markers, in this order; one the recording does not have is NaN throughout.
    name
        What to call the recording.
    """
    at = {label: i for i, label in enumerate(recording.labels)}
    n = len(labels)
    markers = np.full((recording.n_frames, n, 3), np.nan)
    for i, label in enumerate(labels):
        if label in at:
            markers[:, i] = recording.markers[:, at[label]]
    markers = markers[spread_frames(markers, FRAMES)]
    mean, deviation = np.full((n, n), np.nan), np.full((n, n), np.nan)
    for i in range(n):
        distance = np.linalg.norm(markers - markers[:, i : i + 1], axis=2)
        known = np.isfinite(distance)
        count = known.sum(axis=0)
        some = count > 0
        total = np.where(known, distance, 0.0).sum(axis=0)
        mean[i, some] = total[some] / count[some]
        square = np.where(known, (distance - np.where(some, mean[i], 0.0)) ** 2, 0.0).sum(axis=0)
        deviation[i, some] = np.sqrt(square[some] / count[some])
    return MarkerStatistics(labels, mean, deviation, name)
