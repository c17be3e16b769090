"""Best rotation and shift of a marker body in every frame: Horn's quaternion.

Jacobi sweeps on Horn's 4 × 4 matrix keep full double precision on planar and nearly collinear
sets.
"""

import numpy as np
from numpy.typing import NDArray

from kinesphere.kernels.eigenvectors import LANES, diagonalize
from kinesphere.kernels.jit import kernel

FITTED = 0
TOO_FEW = 1
COLLINEAR = 2


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
    m, v = np.zeros((4, 4, LANES)), np.empty((4, 4, LANES))
    here, there = np.empty((LANES, 3)), np.empty((LANES, 3))
    for start in range(0, len(weights), LANES):
        n = min(LANES, len(weights) - start)
        for f in range(n):
            i = start + f
            status[i] = _horn(shape, points[i], weights[i], min_spread, m, f, here[f], there[f])
        m[:, :, n:] = 0.0
        diagonalize(m, v)
        for f in range(n):
            if status[start + f] == FITTED:
                _pose(m, v, f, here[f], there[f], rotations[start + f], shifts[start + f])


@kernel
def _horn(
    shape: NDArray[np.float64],
    points: NDArray[np.float64],
    weights: NDArray[np.float64],
    min_spread: float,
    m: NDArray[np.float64],
    f: int,
    a: NDArray[np.float64],
    b: NDArray[np.float64],
) -> int:
    """Write Horn's matrix of one frame to the lane ``f`` of ``m``, and the means; return a status.

    Where there is no fit, the matrix is zero.
    """
    m[:, :, f] = 0.0
    total = ax = ay = az = bx = by = bz = 0.0
    seen = 0
    for p in range(len(weights)):
        w = weights[p]
        if w > 0.0:
            seen += 1
            total += w
            ax += w * shape[p, 0]
            ay += w * shape[p, 1]
            az += w * shape[p, 2]
            bx += w * points[p, 0]
            by += w * points[p, 1]
            bz += w * points[p, 2]
    if seen < 3:
        return TOO_FEW
    ax, ay, az = ax / total, ay / total, az / total
    bx, by, bz = bx / total, by / total, bz / total
    a[0], a[1], a[2] = ax, ay, az
    b[0], b[1], b[2] = bx, by, bz
    xx = yy = zz = xy = xz = yz = 0.0
    sxx = sxy = sxz = syx = syy = syz = szx = szy = szz = 0.0
    for p in range(len(weights)):
        w = weights[p]
        if w > 0.0:
            x, y, z = shape[p, 0] - ax, shape[p, 1] - ay, shape[p, 2] - az
            xx += x * x
            yy += y * y
            zz += z * z
            xy += x * y
            xz += x * z
            yz += y * z
            u, v, q = w * (points[p, 0] - bx), w * (points[p, 1] - by), w * (points[p, 2] - bz)
            sxx += x * u
            sxy += x * v
            sxz += x * q
            syx += y * u
            syy += y * v
            syz += y * q
            szx += z * u
            szy += z * v
            szz += z * q
    trace = xx + yy + zz
    minors = xx * yy - xy * xy + xx * zz - xz * xz + yy * zz - yz * yz
    if not minors > trace * seen * min_spread * min_spread:
        return COLLINEAR
    m[0, 0, f] = sxx + syy + szz
    m[0, 1, f] = m[1, 0, f] = syz - szy
    m[0, 2, f] = m[2, 0, f] = szx - sxz
    m[0, 3, f] = m[3, 0, f] = sxy - syx
    m[1, 1, f] = sxx - syy - szz
    m[1, 2, f] = m[2, 1, f] = sxy + syx
    m[1, 3, f] = m[3, 1, f] = szx + sxz
    m[2, 2, f] = -sxx + syy - szz
    m[2, 3, f] = m[3, 2, f] = syz + szy
    m[3, 3, f] = -sxx - syy + szz
    return FITTED


@kernel
def _pose(
    m: NDArray[np.float64],
    v: NDArray[np.float64],
    f: int,
    a: NDArray[np.float64],
    b: NDArray[np.float64],
    r: NDArray[np.float64],
    shift: NDArray[np.float64],
) -> None:
    """Write the pose that the largest eigenvalue of lane ``f`` tells."""
    best = 0
    for i in range(1, 4):
        if m[i, i, f] > m[best, best, f]:
            best = i
    qw, qx, qy, qz = v[0, best, f], v[1, best, f], v[2, best, f], v[3, best, f]
    norm = np.sqrt(qw * qw + qx * qx + qy * qy + qz * qz)
    qw /= norm
    qx /= norm
    qy /= norm
    qz /= norm
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
        shift[i] = b[i] - (r[i, 0] * a[0] + r[i, 1] * a[1] + r[i, 2] * a[2])
