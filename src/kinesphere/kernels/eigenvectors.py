"""Eigenvectors of many symmetric 4 × 4 matrices: Jacobi's rotations, side by side.

They keep full double precision where power iterations and the quartic's Newton steps lose theirs.
A processor divides and takes roots of many numbers in the time of one, so that matrices lie
beside each other and every step is done on all of them.
"""

import numpy as np
from numpy.typing import NDArray

from kinesphere.kernels.jit import kernel

LANES = 64
"""Matrices side by side: fewer take as long."""

_SWEEPS = 12  # 4 × 4 Jacobi converges quadratically; 5 or 6 sweeps are the most ever seen

_Matrices = NDArray[np.float64]
_Lanes = NDArray[np.float64]


@kernel
def diagonalize(m: _Matrices, v: _Matrices) -> None:
    """Turn symmetric matrices, (4, 4, LANES), diagonal in place; columns of ``v``: eigenvectors."""
    cosines, sines = np.empty(LANES), np.empty(LANES)
    for i in range(4):
        for j in range(4):
            v[i, j] = 1.0 if i == j else 0.0
    for _ in range(_SWEEPS):
        turned = 0
        for i in range(3):
            for j in range(i + 1, 4):
                turned += _clear(m[i, i], m[j, j], m[i, j], cosines, sines)
                m[j, i] = m[i, j]
                for k in range(4):
                    if k != i and k != j:
                        _turn(m[k, i], m[k, j], cosines, sines)
                        m[i, k] = m[k, i]
                        m[j, k] = m[k, j]
                    _turn(v[k, i], v[k, j], cosines, sines)
        if turned == 0:
            return


@kernel
def _clear(first: _Lanes, second: _Lanes, off: _Lanes, cosines: _Lanes, sines: _Lanes) -> int:
    """Make elements ``off`` zero, turn the diagonal with them; return how many were not yet.

    All (LANES,); cosines and sines of the turns are written.
    """
    turned = 0
    for f in range(LANES):
        # below rounding of both diagonal entries nothing is left to turn
        done = abs(off[f]) <= 1e-17 * (abs(first[f]) + abs(second[f]))
        theta = 0.5 * (second[f] - first[f]) / (1.0 if done else off[f])
        t = 1.0 / (abs(theta) + np.sqrt(theta * theta + 1.0))
        t = -t if theta < 0.0 else t
        t = 0.0 if done else t
        cosine = 1.0 / np.sqrt(t * t + 1.0)
        first[f] -= t * off[f]
        second[f] += t * off[f]
        off[f] = off[f] if done else 0.0
        cosines[f] = cosine
        sines[f] = t * cosine
        turned += 0 if done else 1
    return turned


@kernel
def _turn(first: _Lanes, second: _Lanes, cosines: _Lanes, sines: _Lanes) -> None:
    """Turn pairs of numbers, (LANES,) each, in place."""
    for f in range(LANES):
        p = first[f]
        q = second[f]
        first[f] = cosines[f] * p - sines[f] * q
        second[f] = sines[f] * p + cosines[f] * q
