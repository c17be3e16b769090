"""Files that cannot say "not seen": what stands in for a gap."""

import numpy as np

from kinesphere.data import Array


def held(values: Array, instead: Array) -> Array:
    """Return ``values`` with every gap filled by the last known value.

    Before the first known value, that one; where nothing is known, ``instead``.

    Parameters
    ----------
    values : (n_frames, ...)
        A frame with any NaN is a gap.
    instead : (...)
    """
    known = np.isfinite(values).reshape(len(values), -1).all(axis=1)
    if known.all():
        return values
    if not known.any():
        return np.broadcast_to(instead, values.shape)
    last = np.maximum.accumulate(np.where(known, np.arange(len(values)), 0))
    last[: int(known.argmax())] = known.argmax()
    return np.asarray(values[last])
