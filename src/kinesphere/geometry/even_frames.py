"""Frames spread evenly over a span of time, the same ones when time runs backwards."""

import numpy as np
from numpy.typing import NDArray


def even_frames(n_frames: int, count: int) -> NDArray[np.intp]:
    """Return ``count`` frames spread evenly, the first and the last among them.

    Frame ``f`` is taken if and only if ``n_frames - 1 - f`` is: every n-th frame from the first
    one shows other poses of the same motion played backwards.

    Parameters
    ----------
    n_frames, count
        Of an even number of frames, an even number is taken: one more where ``count`` is odd.

    Returns
    -------
    (n,) increasing, all of them where there are no more than ``count``.
    """
    if n_frames <= count:
        return np.arange(n_frames)
    count = max(1, count)
    count += (n_frames - count) % 2 if n_frames % 2 == 0 else 0
    half = count // 2
    first = np.floor(np.arange(half) * (n_frames - 1) / max(1, count - 1) + 0.5).astype(np.intp)
    middle = [(n_frames - 1) // 2] * (count % 2)
    return np.concatenate([first, middle, n_frames - 1 - first[::-1]]).astype(np.intp)


def every_nth(n_frames: int, stride: int) -> NDArray[np.intp]:
    """Return about every ``stride``-th frame, (n,), as `even_frames` does."""
    return even_frames(n_frames, -(-n_frames // max(1, stride)))


def parted(n: int) -> tuple[int, int]:
    """Return how many of ``n`` come before the middle, and from which one on they come after it.

    The middle one of an odd number belongs to neither half.
    """
    return n // 2, n - n // 2
