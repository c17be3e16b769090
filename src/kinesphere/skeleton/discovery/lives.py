"""Recordings in which markers live for seconds each: joined before anything is counted."""

from dataclasses import replace

import numpy as np

from kinesphere.data import Mask, Recording
from kinesphere.geometry.lifetimes import longest_runs
from kinesphere.skeleton.discovery.followed import SHORTEST, follow
from kinesphere.skeleton.discovery.reunited import reunite
from kinesphere.skeleton.discovery.size import PERSON, subject_size
from kinesphere.skeleton.settings import SkeletonSettings

BROKEN = 0.5
"""Pieces that were joined for each marker that is seen at once, from which all are broken."""


def find_lives(
    recording: Recording, ghost_s: float, limits: SkeletonSettings | None = None
) -> dict[int, int]:
    """Return which columns go on in which other one: that of the same marker that is seen most.

    A marker's life of seconds is a small share of a long recording: joined, it is no reflection.

    Parameters
    ----------
    recording
    ghost_s
        s; what is never around for so long is a reflection, and no piece.
    limits
        What counts as an outlier and as a line where limbs are compared.
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
    tracks, joined = follow(markers / (subject_size(markers) / PERSON), recording.rate)
    if all_broken(len(columns) - len(tracks), recording.seen):
        tracks = reunite(tracks, joined, recording.rate, limits or SkeletonSettings())
    often = seen.sum(axis=0)
    lives: dict[int, int] = {}
    for track in tracks:
        kept, *rest = sorted((int(columns[m]) for m in track), key=lambda c: (-often[c], c))
        lives |= dict.fromkeys(rest, kept)
    return dict(sorted(lives.items()))


def all_broken(n_joined: int, seen: Mask) -> bool:
    """Return whether so many pieces were joined that hardly a marker is whole."""
    return bool(n_joined >= BROKEN * int(seen.sum(axis=1).max(initial=0)))


def with_lives_joined(recording: Recording, lives: dict[int, int]) -> Recording:
    """Return the recording with each marker in one column; those of its pieces are gone."""
    if not lives:
        return recording
    kept = [m for m in range(recording.n_markers) if m not in lives]
    at = {m: i for i, m in enumerate(kept)}
    markers = recording.markers[:, kept]
    for piece, whole in lives.items():
        lost = np.isnan(markers[:, at[whole]])
        markers[:, at[whole]] = np.where(lost, recording.markers[:, piece], markers[:, at[whole]])
    labels = tuple(recording.labels[m] for m in kept)
    return replace(recording, markers=markers, labels=labels, residuals=None, confidence=None)
