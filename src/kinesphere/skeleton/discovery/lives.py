"""Recordings in which markers live for seconds each: joined before anything is counted."""

from dataclasses import replace

import numpy as np

from kinesphere.data import Mask, Recording
from kinesphere.geometry.lifetimes import longest_runs
from kinesphere.skeleton.discovery.copies import with_pieces_joined
from kinesphere.skeleton.discovery.followed import SHORTEST, follow
from kinesphere.skeleton.discovery.size import PERSON, subject_size


def find_lives(recording: Recording, ghost_s: float) -> dict[int, int]:
    """Return which columns go on in which other one: that of the same marker that is seen most.

    A marker's life of seconds is a small share of a long recording: joined, it is no reflection.

    Parameters
    ----------
    recording
    ghost_s
        s; what is never around for so long is a reflection, and no piece.
    """
    seen: Mask = recording.seen
    whole = seen[:1].any(axis=0) & seen[-1:].any(axis=0)
    broken: Mask = np.asarray(seen.any(axis=0) & ~whole)
    if broken.sum() < 2:
        return {}
    least = max(ghost_s, SHORTEST) * recording.rate
    around = longest_runs(seen, 1) >= min(least, len(seen) / 2)
    columns = np.flatnonzero(around & seen.any(axis=0))
    if broken[columns].sum() < 2:
        return {}
    markers = recording.markers[:, columns]
    tracks, _ = follow(markers / (subject_size(markers) / PERSON), recording.rate)
    often = seen.sum(axis=0)
    lives: dict[int, int] = {}
    for track in tracks:
        kept, *rest = sorted((int(columns[m]) for m in track), key=lambda c: (-often[c], c))
        lives |= dict.fromkeys(rest, kept)
    return dict(sorted(lives.items()))


def with_lives_joined(recording: Recording, lives: dict[int, int]) -> Recording:
    """Return the recording with each marker in one column, and nothing in those of its pieces."""
    if not lives:
        return recording
    markers = with_pieces_joined(recording.markers, lives)
    markers[:, [*lives]] = np.nan
    return replace(recording, markers=markers)
