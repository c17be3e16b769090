"""What two axes make of every frame: inner loops of the methods for free motion."""

import numpy as np

from kinesphere.data import Array
from kinesphere.kernels.jit import kernel
from kinesphere.parameterization.kernels import two_axis_solutions

_LEAST = 1e-6  # of the sine squared of the angle between two axes


@kernel
def constraint_residuals(
    rotations: Array, x: Array, y: Array, dx: Array, dy: Array, limb: Array, cosine: float, s: float
) -> Array:
    """Return Sampson's residuals of ``xᵀ Q y = cosine`` and their derivatives, (n, 6).

    Parameters
    ----------
    rotations : (n, 3, 3)
        Q.
    x, y : (3,)
        Unit vectors in parent and child.
    dx, dy : (2, 3)
        How they change with two parameters each.
    limb : (3,)
        What the child twists about.
    cosine
        Another parameter.
    s
        Share of a residual's variance that is put down to twist.

    Returns
    -------
    (n, 6)
        The residual, then its derivatives by the parameters of x, of y and by ``cosine``.
    """
    n = len(rotations)
    told = np.empty((n, 6))
    twisting = np.empty(3)
    _cross(limb, y, twisting)
    by_y = np.empty((2, 3))
    for k in range(2):
        _cross(limb, dy[k], by_y[k])
    a, b, back = np.empty(3), np.empty(3), np.empty(3)
    for f in range(n):
        q = rotations[f]
        c = t = 0.0
        for i in range(3):
            a[i] = q[i, 0] * y[0] + q[i, 1] * y[1] + q[i, 2] * y[2]
            b[i] = q[i, 0] * twisting[0] + q[i, 1] * twisting[1] + q[i, 2] * twisting[2]
            back[i] = q[0, i] * x[0] + q[1, i] * x[1] + q[2, i] * x[2]
            c += x[i] * a[i]
            t += x[i] * b[i]
        sine = 1.0 - c * c
        variance = (1.0 - s) * max(sine, _LEAST) + s * t * t
        size = np.sqrt(variance)
        told[f, 0] = (c - cosine) / size
        for k in range(4):
            dc = dt = 0.0
            for i in range(3):
                if k < 2:
                    dc += dx[k, i] * a[i]
                    dt += dx[k, i] * b[i]
                else:
                    dc += dy[k - 2, i] * back[i]
                    dt += by_y[k - 2, i] * back[i]
            bent = s * t * dt
            if sine > _LEAST:
                bent -= (1.0 - s) * c * dc
            told[f, 1 + k] = (dc - told[f, 0] / size * bent) / size
        told[f, 5] = -1.0 / size
    return told


@kernel
def angles_and_loads(
    rotations: Array, distal: Array, proximal: Array, rest: Array, limb: Array, flattest: float
) -> tuple[Array, Array, Array, float]:
    """Return the angles of every pose about two axes and the limb, and what errors do to them.

    Parameters
    ----------
    rotations : (n, 3, 3)
    distal, proximal : (3,)
        In the parent.
    rest : (3, 3)
    limb : (3,)
        In the child.
    flattest
        Least determinant of the angles' Jacobian.

    Returns
    -------
    angles : (n, 3) rad
        About both axes and the limb, without leaps of a full turn.
    loads : (n, 3, 3)
        How each angle, first index, depends on an error about each axis of the parent.
    excess : (n,) rad
        By which the limb is out of reach.
    unit
        Sum of the logarithms of the determinants.
    """
    n = len(rotations)
    solutions, _, excess = two_axis_solutions(rotations, distal, proximal, rest, limb)
    angles, loads = np.empty((n, 3)), np.empty((n, 3, 3))
    p, swung, normal, crossed = np.empty(3), np.empty(3), np.empty(3), np.empty(3)
    along = distal[0] * proximal[0] + distal[1] * proximal[1] + distal[2] * proximal[2]
    _cross(proximal, distal, crossed)
    unit = 0.0
    for f in range(n):
        for k in range(3):
            angle = solutions[f, 0, k]
            if f > 0:
                angle -= 2.0 * np.pi * np.round((angle - angles[f - 1, k]) / (2.0 * np.pi))
            angles[f, k] = angle
        sine, cosine = np.sin(angles[f, 1]), np.cos(angles[f, 1])
        for i in range(3):
            q = rotations[f, i]
            p[i] = q[0] * limb[0] + q[1] * limb[1] + q[2] * limb[2]
            swung[i] = cosine * distal[i] + sine * crossed[i] + (1.0 - cosine) * along * proximal[i]
        _cross(swung, proximal, normal)
        determinant = normal[0] * p[0] + normal[1] * p[1] + normal[2] * p[2]
        size = max(abs(determinant), flattest)
        determinant = -size if determinant < 0.0 else size
        _cross(proximal, p, loads[f, 0])
        _cross(p, swung, loads[f, 1])
        for i in range(3):
            loads[f, 2, i] = normal[i]
            for k in range(3):
                loads[f, k, i] /= determinant
        unit += np.log(size)
    return angles, loads, excess, unit


@kernel
def _cross(a: Array, b: Array, product: Array) -> None:
    """Write ``a × b``."""
    product[0] = a[1] * b[2] - a[2] * b[1]
    product[1] = a[2] * b[0] - a[0] * b[2]
    product[2] = a[0] * b[1] - a[1] * b[0]
