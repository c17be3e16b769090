"""How steady markers are with bodies."""

from collections.abc import Sequence

import numpy as np

from kinesphere.data import Array
from kinesphere.skeleton.discovery.joint_costs import Members

OWN_POSE = 3
"""Markers from which on a body has a pose of its own."""


def owners(bodies: Sequence[Members], n: int) -> Members:
    """Return the body of each of ``n`` markers, −1 for none."""
    owner = np.full(n, -1)
    for b, members in enumerate(bodies):
        owner[members] = b
    return owner


def steadiness(wander: Array, bodies: Sequence[Members]) -> Array:
    """Return the rms wander of each marker's distances to each body, (n, n_bodies) m.

    The marker itself left out; NaN for a loner's own body.
    """
    square = wander**2 + np.diag(np.full(len(wander), np.nan))
    steady = np.full((len(wander), len(bodies)), np.nan)
    for b, members in enumerate(bodies):
        to_members = square[:, members]
        known = np.isfinite(to_members)
        count = known.sum(axis=1)
        total = np.where(known, to_members, 0.0).sum(axis=1)
        steady[:, b] = np.sqrt(np.where(count > 0, total / np.maximum(count, 1), np.nan))
    return steady


def usual_wander(wander: Array, bodies: Sequence[Members]) -> float:
    """Return the median wander of a distance within a body, m; 0 where no body has two markers."""
    inner = [wander[np.ix_(b, b)][np.triu_indices(len(b), 1)] for b in bodies]
    known = np.concatenate([*inner, np.empty(0)])
    known = known[np.isfinite(known)]
    return float(np.median(known)) if len(known) else 0.0
