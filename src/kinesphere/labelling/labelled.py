"""Tracks and the labels they bear, while a recording is being labelled."""

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from kinesphere.data import Array
from kinesphere.labelling.runs import Track


@dataclass
class Labelled:
    """Tracks with their labels: work in progress."""

    points: Array
    """(n_frames, n_labels, 3) m, what is labelled so far."""
    tracks: list[Track]
    labels: list[int]
    """Of each track, −1 for none."""
    confidence: list[float]
    fit: float = float("nan")
    cut: int = 0
    """Tracks cut because they stopped fitting."""
    windows_s: list[tuple[float, float]] = field(default_factory=list)
    """Start and end of the windows in which the body was recognised."""
    notes: list[str] = field(default_factory=list)


def give(state: Labelled, markers: Array, track: int, label: int, sure: float) -> None:
    """Let a track bear a label, where nobody else does."""
    kept = []
    for run in state.tracks[track]:
        place = state.points[run.start : run.end, label]
        if np.isfinite(place[:, 0]).any():
            continue
        place[:] = markers[run.start : run.end, run.column]
        kept.append(run)
    rest = tuple(run for run in state.tracks[track] if run not in kept)
    if not kept:
        return
    if rest:
        state.tracks.append(rest)
        state.labels.append(-1)
        state.confidence.append(0.0)
    state.tracks[track] = tuple(kept)
    state.labels[track] = label
    state.confidence[track] = sure


def take(state: Labelled, track: int) -> None:
    """Take a track's label away."""
    for run in state.tracks[track]:
        state.points[run.start : run.end, state.labels[track]] = np.nan
    state.labels[track] = -1
    state.confidence[track] = 0.0


def length_of(state: Labelled, k: int) -> int:
    """Return the number of frames in which a track is seen."""
    return sum(run.end - run.start for run in state.tracks[k])


def overlapping(state: Labelled, k: int, label: int) -> list[int]:
    """Return the tracks with this label that are there while track k is."""
    return [
        other
        for other, of in enumerate(state.labels)
        if of == label
        and any(
            a.start < b.end and b.start < a.end
            for a in state.tracks[other]
            for b in state.tracks[k]
        )
    ]


def frames_of(track: Track) -> tuple[NDArray[np.intp], NDArray[np.intp]]:
    """Return frames and columns of a track, sampled where it is long."""
    frames = np.concatenate([np.arange(r.start, r.end) for r in track])
    columns = np.concatenate([np.full(r.end - r.start, r.column) for r in track])
    return frames, columns
