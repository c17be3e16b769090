"""Points in space, many at once: which are seen, and how long vectors are. Arrays only.

NumPy's reductions and products over an axis of three cost several times what its sums do.
"""

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


def is_seen(points: Array) -> NDArray[np.bool_]:
    """Return where points are seen, (..., 3) → (...): NaN in any coordinate is not seen."""
    return np.asarray(np.isfinite(points[..., 0] + points[..., 1] + points[..., 2]))


def lengths(vectors: Array) -> Array:
    """Return the lengths of vectors, (..., 3) → (...), in their unit; NaN stays NaN."""
    return np.asarray(np.sqrt(np.einsum("...i,...i->...", vectors, vectors)))
