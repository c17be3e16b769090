"""The data section: points with their fourth words, and analog samples."""

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from kinesphere.data import Array, Mask
from kinesphere.io.c3d.layout import Layout

INVISIBLE = -1
"""Fourth word of a point that was not seen."""


@dataclass(frozen=True, eq=False)
class Frames:
    """The numbers of a file as they are in it."""

    points: NDArray[Any]
    """(n_frames, n_points, 3) float32 or int16; times the scale if int16."""
    fourth: NDArray[Any]
    """(n_frames, n_points) float32 or int16: camera mask and residual in one word, −1 unseen."""
    analog: NDArray[Any]
    """(n_frames · samples_per_frame, n_channels) float32 or int16."""


def frames_from_bytes(content: bytes, layout: Layout) -> Frames:
    """Return the data section's numbers; ``layout`` has seen to it that they are all there."""
    stored = content[layout.start : layout.end]
    processor = layout.processor
    numbers: NDArray[Any] = (processor.floats if layout.is_float else processor.words)(stored)
    numbers = numbers.reshape(layout.n_frames, layout.words_per_frame)
    points, analog = np.split(numbers, [4 * layout.n_points], axis=1)
    points = points.reshape(layout.n_frames, layout.n_points, 4)
    return Frames(
        np.ascontiguousarray(points[..., :3]),
        np.ascontiguousarray(points[..., 3]),
        analog.reshape(-1, layout.n_channels) if layout.n_channels else np.empty((0, 0)),
    )


def bytes_from_frames(frames: Frames) -> bytes:
    """Return the numbers as an INTEL processor writes them."""
    n_frames, n_points = frames.fourth.shape
    numbers = np.concatenate(
        [
            np.concatenate([frames.points, frames.fourth[..., None]], axis=2).reshape(
                n_frames, 4 * n_points
            ),
            frames.analog.reshape(n_frames, -1),
        ],
        axis=1,
    )
    return numbers.astype(numbers.dtype.newbyteorder("<"), copy=False).tobytes()


def as_doubles(numbers: NDArray[Any]) -> Array:
    """Return numbers of a file as float64; bit patterns that are no number become NaN."""
    with np.errstate(invalid="ignore"):  # a signalling NaN would complain of being looked at
        return numbers.astype(np.float64)


def unseen(fourth: NDArray[Any]) -> Mask:
    """Return where a fourth word says that the point was not seen: any negative one does."""
    return np.asarray(fourth < 0)


def residuals_from_fourth(fourth: NDArray[Any], scale: float) -> Array:
    """Return residuals in the file's unit, (n_frames, n_points); NaN where unseen.

    The word's low byte is the residual divided by the scale, the high byte the cameras' mask;
    in a float file the number must be turned into that word first.
    """
    with np.errstate(invalid="ignore"):
        sensible = (fourth >= 0) & (fourth <= np.iinfo(np.int16).max)
        word = np.where(sensible, fourth, 0).astype(np.int16)
    return np.where(sensible, (word & 0xFF) * scale, np.nan)


def fourth_from_residuals(residuals: Array, seen: Mask, scale: float) -> NDArray[np.int16]:
    """Return the words that say so, (n_frames, n_points), with empty camera masks."""
    byte = np.clip(np.round(np.nan_to_num(residuals) / scale), 0, 255)
    return np.where(seen, byte, INVISIBLE).astype(np.int16)
