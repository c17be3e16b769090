"""A subject's size and an order of its markers, so that neither unit nor file order matters."""

import numpy as np
from numpy.typing import NDArray

from kinesphere.data import Array
from kinesphere.geometry.even_frames import even_frames
from kinesphere.skeleton.averages import median_seen

PERSON = 0.8
"""m, `subject_size` of a person: 0.61 to 1.11 m on recordings of 36 to 62 markers. Twice as much
gives the same bodies and trees on twelve recordings, half as much on eleven of them."""
NEIGHBOUR = 2
"""Which neighbour's distance counts as the spacing: two copies have one of their own."""
FRAMES = 100
"""Frames that are looked at, spread over the recording."""


def subject_size(markers: Array) -> float:
    """Return the spacing of markers times the root of their number, in m.

    That is the side of a square they cover. It grows with the subject but, other than the markers'
    extent, hardly with the distance between two people or between a person and a thing; more
    markers on the same subject are nearer to each other and leave it alike.

    Parameters
    ----------
    markers : (n_frames, n, 3) m
        NaN where not seen.

    Returns
    -------
    float
        That of a person where no three markers are seen apart at once.
    """
    sizes = []
    for frame in _spread(markers):
        seen = frame[np.isfinite(frame).all(axis=1)]
        if len(seen) > NEIGHBOUR:
            spacing = float(np.median(np.sort(_apart(seen), axis=1)[:, NEIGHBOUR]))
            sizes.append(spacing * np.sqrt(len(seen)))
    size = float(np.median(sizes)) if sizes else 0.0
    return size if size > 0 else PERSON


def from_the_middle(markers: Array) -> NDArray[np.intp]:
    """Return the markers in the order of their usual distance from all the others, nearest first.

    Whatever goes by the order of markers after this (starts of a clustering, numbers of bodies) is
    the same however the file lists them.

    Parameters
    ----------
    markers : (n_frames, n, 3) m

    Returns
    -------
    (n,) columns; those that are never seen in the frames looked at last, as they were.
    """
    apart = np.array([_apart(frame) for frame in _spread(markers)])  # (n_sample, n, n)
    n = apart.shape[1]
    apart[:, np.arange(n), np.arange(n)] = np.nan
    usual = median_seen(np.moveaxis(apart, 1, 2).reshape(-1, n))
    return np.argsort(usual, kind="stable")


def _spread(markers: Array) -> Array:
    return np.asarray(markers[even_frames(len(markers), FRAMES)])


def _apart(points: Array) -> Array:
    return np.asarray(np.linalg.norm(points[:, None] - points[None], axis=2))
