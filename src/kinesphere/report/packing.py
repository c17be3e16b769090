"""Arrays as short text: quantised to 16 bits, differences over time, deflated, base64.

A page that opens offline must carry its data. Sixteen bits resolve a room of six metres to 0.1 mm;
what moves smoothly has small differences, and those deflate to a fraction.
"""

import base64
import math
import zlib
from typing import TypedDict

import numpy as np

from kinesphere.data import Array

UNSEEN = -32768
"""The code of NaN."""
_CODES = 65_000
"""Steps between the smallest and the largest value, below what 16 bits hold beside UNSEEN."""


class Packed(TypedDict):
    """What ``assets/unpack.js`` turns back into numbers: ``value = offset + step * code``."""

    shape: list[int]
    step: float
    offset: float
    data: str


def pack(values: Array, step: float) -> Packed:
    """Pack an array whose first axis is time.

    Parameters
    ----------
    values : (n_frames, ...)
        NaN is kept.
    step
        Finest difference worth keeping, in the unit of the values; coarser only where the range
        of the values asks for it.

    Returns
    -------
    Packed
        Values come back within half of its ``step``.
    """
    series = values.reshape(len(values), math.prod(values.shape[1:])).T
    known = np.isfinite(series)
    low, high = (series[known].min(), series[known].max()) if known.any() else (0.0, 0.0)
    offset = float(low + high) / 2
    step = max(step, float(high - low) / _CODES)
    codes = np.where(known, np.round((np.nan_to_num(series) - offset) / step), UNSEEN)
    # An unseen stretch would cost two large differences a series; two's complement wraps, so the
    # differences of 16-bit codes add up to the codes again whatever their size.
    codes = codes.astype(np.int16).view(np.uint16)
    steps = np.diff(codes, axis=1, prepend=np.uint16(0))
    octets = np.ascontiguousarray(steps.astype("<u2")).view(np.uint8).reshape(-1, 2)
    split = octets.T.tobytes()  # all low bytes, then all high bytes: the high ones are mostly zero
    return Packed(
        shape=list(values.shape),
        step=step,
        offset=offset,
        data=base64.b64encode(zlib.compress(split, 6)).decode("ascii"),
    )


def unpack(packed: Packed) -> Array:
    """Return what the page sees of a packed array: the twin of ``assets/unpack.js``."""
    n_frames, *rest = packed["shape"]
    split = np.frombuffer(zlib.decompress(base64.b64decode(packed["data"])), dtype=np.uint8)
    steps = np.ascontiguousarray(split.reshape(2, -1).T).view("<u2")
    steps = steps.reshape(math.prod(rest), n_frames)
    codes = np.cumsum(steps, axis=1, dtype=np.uint16).view(np.int16)
    values = np.where(codes == UNSEEN, np.nan, packed["offset"] + packed["step"] * codes)
    return np.asarray(values.T.reshape(n_frames, *rest), dtype=np.float64)
