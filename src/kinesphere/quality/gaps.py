"""Where markers were not seen: every run of missing frames."""

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from kinesphere.data import Mask, Recording


class Gap(NamedTuple):
    """One run of frames in which a marker is missing."""

    column: int
    """Which marker."""
    start: int
    """Index of the first frame without it, from 0."""
    stop: int
    """Index of the first frame that has it again, or the number of frames."""
    inner: bool
    """Whether it is seen both before and after."""

    @property
    def n_frames(self) -> int:
        """How many frames it lasts."""
        return self.stop - self.start


def find_gaps(recording: Recording) -> tuple[Gap, ...]:
    """Return every gap of every marker, by marker, then by time.

    A marker that is never seen is one gap as long as the recording.
    """
    return tuple(_gaps(recording.seen))


def _gaps(seen: Mask) -> Iterator[Gap]:
    n_frames = len(seen)
    columns, starts, stops = runs(~seen)
    for column, start, stop in zip(columns, starts, stops, strict=True):
        yield Gap(int(column), int(start), int(stop), bool(start > 0 and stop < n_frames))


def runs(mask: Mask) -> tuple[NDArray[np.intp], NDArray[np.intp], NDArray[np.intp]]:
    """Return column, first frame and frame after the last of every run of True down the columns.

    Parameters
    ----------
    mask : (n_frames, n_columns)

    Returns
    -------
    columns, starts, stops : (n_runs,) each
        Sorted by column, then by start.
    """
    edge = np.zeros((1, mask.shape[1]), dtype=np.int8)
    steps = np.diff(np.concatenate([edge, mask.astype(np.int8), edge]), axis=0).T
    columns, starts = np.nonzero(steps == 1)
    _, stops = np.nonzero(steps == -1)
    return columns, starts, stops
