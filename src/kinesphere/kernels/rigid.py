"""Best rotation and shift of a marker body in every frame: Horn's quaternion, Jacobi's rotations.

Jacobi sweeps on Horn's 4 × 4 matrix keep full double precision on planar and nearly collinear
sets, where power iterations and the quartic's Newton steps lose theirs.
"""

import numpy as np
from numpy.typing import NDArray

from kinesphere.kernels.jit import kernel

FITTED = 0
TOO_FEW = 1
COLLINEAR = 2

_SWEEPS = 12  # 4 × 4 Jacobi converges quadratically; 5 or 6 sweeps are the most ever seen


@kernel
def fit_rigid_kernel(
    shape: NDArray[np.float64],
    points: NDArray[np.float64],
    weights: NDArray[np.float64],
    min_spread: float,
    rotations: NDArray[np.float64],
    shifts: NDArray[np.float64],
    status: NDArray[np.uint8],
) -> None:
    """Fit ``points ≈ rotation @ shape + shift`` in every frame, by weighted least squares.

    Parameters
    ----------
    shape : (n_points, 3) m
    points : (n_frames, n_points, 3) m
        Ignored, NaN or not, where the weight is zero.
    weights : (n_frames, n_points)
        Zero where a point is not seen.
    min_spread
        m, least rms extent of the seen shape beside its longest line.
    rotations, shifts : (n_frames, 3, 3), (n_frames, 3) m
        Written; left as they are where there is no fit.
    status : (n_frames,)
        Written: FITTED, TOO_FEW or COLLINEAR.

    References
    ----------
    Horn (1987), J. Opt. Soc. Am. A 4(4), 629-642, doi:10.1364/JOSAA.4.000629.
    """
    n_frames, n_points = weights.shape
    a = np.empty(3)
    b = np.empty(3)
    s = np.empty((3, 3))
    m = np.empty((4, 4))
    v = np.empty((4, 4))
    for f in range(n_frames):
        total = 0.0
        seen = 0
        for i in range(3):
            a[i] = 0.0
            b[i] = 0.0
        for p in range(n_points):
            w = weights[f, p]
            if w > 0.0:
                seen += 1
                total += w
                for i in range(3):
                    a[i] += w * shape[p, i]
                    b[i] += w * points[f, p, i]
        if seen < 3:
            status[f] = TOO_FEW
            continue
        for i in range(3):
            a[i] /= total
            b[i] /= total
        xx = yy = zz = xy = xz = yz = 0.0
        s[:, :] = 0.0
        for p in range(n_points):
            w = weights[f, p]
            if w > 0.0:
                x = shape[p, 0] - a[0]
                y = shape[p, 1] - a[1]
                z = shape[p, 2] - a[2]
                xx += x * x
                yy += y * y
                zz += z * z
                xy += x * y
                xz += x * z
                yz += y * z
                for j in range(3):
                    q = w * (points[f, p, j] - b[j])
                    s[0, j] += x * q
                    s[1, j] += y * q
                    s[2, j] += z * q
        trace = xx + yy + zz
        minors = xx * yy - xy * xy + xx * zz - xz * xz + yy * zz - yz * yz
        if not minors > trace * seen * min_spread * min_spread:
            status[f] = COLLINEAR
            continue
        m[0, 0] = s[0, 0] + s[1, 1] + s[2, 2]
        m[0, 1] = m[1, 0] = s[1, 2] - s[2, 1]
        m[0, 2] = m[2, 0] = s[2, 0] - s[0, 2]
        m[0, 3] = m[3, 0] = s[0, 1] - s[1, 0]
        m[1, 1] = s[0, 0] - s[1, 1] - s[2, 2]
        m[1, 2] = m[2, 1] = s[0, 1] + s[1, 0]
        m[1, 3] = m[3, 1] = s[2, 0] + s[0, 2]
        m[2, 2] = -s[0, 0] + s[1, 1] - s[2, 2]
        m[2, 3] = m[3, 2] = s[1, 2] + s[2, 1]
        m[3, 3] = -s[0, 0] - s[1, 1] + s[2, 2]
        _diagonalize(m, v)
        best = 0
        for i in range(1, 4):
            if m[i, i] > m[best, best]:
                best = i
        qw, qx, qy, qz = v[0, best], v[1, best], v[2, best], v[3, best]
        norm = np.sqrt(qw * qw + qx * qx + qy * qy + qz * qz)
        qw /= norm
        qx /= norm
        qy /= norm
        qz /= norm
        r = rotations[f]
        r[0, 0] = 1 - 2 * (qy * qy + qz * qz)
        r[0, 1] = 2 * (qx * qy - qw * qz)
        r[0, 2] = 2 * (qx * qz + qw * qy)
        r[1, 0] = 2 * (qx * qy + qw * qz)
        r[1, 1] = 1 - 2 * (qx * qx + qz * qz)
        r[1, 2] = 2 * (qy * qz - qw * qx)
        r[2, 0] = 2 * (qx * qz - qw * qy)
        r[2, 1] = 2 * (qy * qz + qw * qx)
        r[2, 2] = 1 - 2 * (qx * qx + qy * qy)
        for i in range(3):
            shifts[f, i] = b[i] - (r[i, 0] * a[0] + r[i, 1] * a[1] + r[i, 2] * a[2])
        status[f] = FITTED


@kernel
def _diagonalize(m: NDArray[np.float64], v: NDArray[np.float64]) -> None:
    """Turn the symmetric 4 × 4 ``m`` diagonal in place; columns of ``v`` are its eigenvectors."""
    for i in range(4):
        for j in range(4):
            v[i, j] = 1.0 if i == j else 0.0
    for _ in range(_SWEEPS):
        rotated = False
        for i in range(3):
            for j in range(i + 1, 4):
                off = m[i, j]
                # below rounding of both diagonal entries nothing is left to turn
                if abs(off) <= 1e-17 * (abs(m[i, i]) + abs(m[j, j])):
                    continue
                rotated = True
                theta = 0.5 * (m[j, j] - m[i, i]) / off
                t = 1.0 / (abs(theta) + np.sqrt(theta * theta + 1.0))
                if theta < 0.0:
                    t = -t
                c = 1.0 / np.sqrt(t * t + 1.0)
                s = t * c
                m[i, i] -= t * off
                m[j, j] += t * off
                m[i, j] = 0.0
                m[j, i] = 0.0
                for k in range(4):
                    if k != i and k != j:
                        p = m[k, i]
                        q = m[k, j]
                        m[k, i] = c * p - s * q
                        m[i, k] = m[k, i]
                        m[k, j] = s * p + c * q
                        m[j, k] = m[k, j]
                    p = v[k, i]
                    q = v[k, j]
                    v[k, i] = c * p - s * q
                    v[k, j] = s * p + c * q
        if not rotated:
            return
