"""Frames as people name them: "frames 11–14 and 20"."""

from collections.abc import Iterable
from itertools import pairwise

_NAMED = 3
"""Runs that are named; of the rest only how many frames they hold."""


def frame_spans(frames: Iterable[int], first: int = 0) -> str:
    """Return words for some frames, runs of them joined.

    Parameters
    ----------
    frames
        Numbers from 0, at least one.
    first
        Number of frame 0 as people count.
    """
    numbers = sorted({frame + first for frame in frames})
    breaks = [i + 1 for i, (a, b) in enumerate(pairwise(numbers)) if b > a + 1]
    runs = [numbers[a:b] for a, b in pairwise([0, *breaks, len(numbers)])]
    said = [f"{run[0]}–{run[-1]}" if len(run) > 1 else str(run[0]) for run in runs[:_NAMED]]
    rest = sum(len(run) for run in runs[_NAMED:])
    if rest:
        said.append(f"{rest} more")
    words = ", ".join(said[:-1]) + (" and " if len(said) > 1 else "") + said[-1]
    return f"frame{'s' if len(numbers) > 1 else ''} {words}"
