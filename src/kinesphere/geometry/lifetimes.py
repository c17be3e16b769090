"""How long trajectories are around: what tells a body's marker from a reflection."""

import numpy as np
from numpy.typing import NDArray

Mask = NDArray[np.bool_]

GHOST = 0.5
"""s; what is never around for so long counts as a reflection."""
LEAST_SHARE = 0.05
"""Share of the frames in which a marker must be seen to be grouped."""
MOSTLY = 0.5
"""Share of the frames from which on no reflection is seen, however short its runs."""
BLINK = 0.1
"""Share of a reflection's longest life that a marker may be missing without being gone."""


def worth_grouping(seen: Mask, rate: float, ghost_s: float) -> Mask:
    """Return which markers are seen often and long enough, (n_frames, n) → (n,).

    Reflections live for tenths of a second; a body's marker is around at least once for longer,
    though single frames of it may be missing, or in most of the frames.
    """
    n_frames = len(seen)
    share = seen.sum(axis=0) / max(1, seen.any(axis=1).sum())
    stretch = min(ghost_s * rate, n_frames / 2)
    blink = max(1, int(BLINK * ghost_s * rate))
    around = longest_runs(seen, blink) >= stretch
    return np.asarray((share >= LEAST_SHARE) & (around | (share >= MOSTLY)))


def longest_runs(seen: Mask, bridged: int = 0) -> NDArray[np.intp]:
    """Return the longest run of frames that show each marker, (n_frames, n) → (n,).

    Parameters
    ----------
    seen
    bridged
        Up to so many missing frames do not end a run, and count.
    """
    longest = np.zeros(seen.shape[1], dtype=np.intp)
    for m, column in enumerate(seen.T):
        frames = np.flatnonzero(column)
        if len(frames):
            breaks = np.flatnonzero(np.diff(frames) > bridged + 1)
            first, last = np.r_[0, breaks + 1], np.r_[breaks, len(frames) - 1]
            longest[m] = (frames[last] - frames[first]).max() + 1
    return longest
