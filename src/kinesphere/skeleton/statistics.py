"""Distances between markers over a recording: what labelling recognises a layout by."""

from itertools import combinations

import numpy as np

from kinesphere.data import MarkerStatistics, Recording
from kinesphere.geometry.handedness import FULL, quadruples_of
from kinesphere.geometry.signature import Signature, signature

STABLE = 0.9
"""Handedness from which on a quadruple counts as keeping its side: 95 % of the frames agree."""
QUADRUPLES = 3000
"""Most of them kept, the tightest first: near markers keep their side on other people as well."""


def marker_statistics(recording: Recording, labels: tuple[str, ...], name: str) -> MarkerStatistics:
    """Return the statistics of every distance between two markers, and which way fours turn.

    Parameters
    ----------
    labels
        Which markers, in this order; one the recording does not have is NaN throughout.
    name
        What to call the recording.
    """
    at = {label: i for i, label in enumerate(recording.labels)}
    markers = np.full((recording.n_frames, len(labels), 3), np.nan)
    for i, label in enumerate(labels):
        if label in at:
            markers[:, i] = recording.markers[:, at[label]]
    found = signature(markers)
    quadruples, signs = _stable_quadruples(found)
    return MarkerStatistics(labels, found.mean, found.std, name, quadruples, signs)


def _stable_quadruples(found: Signature) -> tuple[np.ndarray, np.ndarray]:
    """Return the tightest quadruples whose handedness is stable, and their mean sign."""
    quadruples = quadruples_of(found.n)
    signs = found.handedness / FULL
    around = sum(
        found.mean[quadruples[:, i], quadruples[:, j]] for i, j in combinations(range(4), 2)
    )
    stable = np.flatnonzero((np.abs(signs) >= STABLE) & np.isfinite(around))
    kept = stable[np.argsort(np.asarray(around)[stable], kind="stable")[:QUADRUPLES]]
    return quadruples[kept], signs[kept]
