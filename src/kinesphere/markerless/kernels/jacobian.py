"""How points of a skinned surface move with every degree of freedom."""

import numpy as np
from numpy.typing import NDArray

from kinesphere.kernels.jit import kernel

Array = NDArray[np.float64]
Ints = NDArray[np.int32]


@kernel
def jacobian_kernel(
    vertices: Array,
    influences: Ints,
    weights: Array,
    pairs: Ints,
    shares: Array,
    bind: Array,
    rotations: Array,
    centres: Array,
    axes: Array,
    dof_limbs: NDArray[np.intp],
    dof_kinds: NDArray[np.intp],
    moves: NDArray[np.bool_],
    directions: Array,
    points: Array,
    rows: Array,
) -> None:
    """Write surface points and their derivatives along given directions.

    A joint turns what it carries about its present axis ω through its present centre q, so that a
    point blended from limbs moves by ω × Σ wₗ(xₗ − q), over the limbs it carries (the derivative
    of Rosenhahn et al. 2006, equation 12, with every twist where it is now, for a blended point).

    Parameters
    ----------
    vertices, influences, weights, bind, rotations, centres
        As in `skin_kernel`.
    pairs, shares : (n, 2), (n,)
        A point lies between two vertices, ``shares`` of the way from the first to the second.
    axes, dof_limbs, dof_kinds, moves
        Degrees of freedom: in the world, as in `pose_kernel`; ``moves`` is (n_dofs, n_limbs).
    directions : (n, n_rows, 3)
    points : (n, 3) m
        Written.
    rows : (n, n_rows, n_dofs)
        ``directions`` · ∂point/∂dof. Written.
    """
    n_dofs, n_limbs = moves.shape
    moment = np.zeros((n_limbs, 3))
    share = np.zeros(n_limbs)
    touched = np.empty(2 * influences.shape[1], dtype=np.intp)
    for i in range(len(pairs)):
        n_touched = 0
        points[i] = 0.0
        for end in range(2):
            v = pairs[i, end]
            of_end = shares[i] if end == 1 else 1.0 - shares[i]
            for k in range(influences.shape[1]):
                w = weights[v, k] * of_end
                if w == 0.0:
                    continue
                limb = influences[v, k]
                r = rotations[limb]
                dx = vertices[v, 0] - bind[limb, 0]
                dy = vertices[v, 1] - bind[limb, 1]
                dz = vertices[v, 2] - bind[limb, 2]
                if share[limb] == 0.0:
                    touched[n_touched] = limb
                    n_touched += 1
                share[limb] += w
                for j in range(3):
                    at = w * (centres[limb, j] + r[j, 0] * dx + r[j, 1] * dy + r[j, 2] * dz)
                    moment[limb, j] += at
                    points[i, j] += at
        for k in range(n_dofs):
            mx = my = mz = carried = 0.0
            for j in range(n_touched):
                limb = touched[j]
                if moves[k, limb]:
                    carried += share[limb]
                    mx += moment[limb, 0]
                    my += moment[limb, 1]
                    mz += moment[limb, 2]
            if carried == 0.0:
                for row in range(directions.shape[1]):
                    rows[i, row, k] = 0.0
                continue
            ax, ay, az = axes[k, 0], axes[k, 1], axes[k, 2]
            if dof_kinds[k] == 0:
                vx, vy, vz = carried * ax, carried * ay, carried * az
            else:
                q = centres[dof_limbs[k]]
                mx -= carried * q[0]
                my -= carried * q[1]
                mz -= carried * q[2]
                vx, vy, vz = ay * mz - az * my, az * mx - ax * mz, ax * my - ay * mx
            for row in range(directions.shape[1]):
                d = directions[i, row]
                rows[i, row, k] = d[0] * vx + d[1] * vy + d[2] * vz
        for j in range(n_touched):
            share[touched[j]] = 0.0
            for m in range(3):
                moment[touched[j], m] = 0.0


@kernel
def image_directions_kernel(
    points: Array,
    pairs: Ints,
    shares: Array,
    normals: Array,
    rotation: Array,
    shift: Array,
    lens: Array,
    directions: Array,
) -> None:
    """Write the world direction whose component moves a pixel along a normal, in px/m.

    Parameters
    ----------
    points : (n_vertices, 3) m
    pairs, shares : (n, 2), (n,)
        As in `jacobian_kernel`.
    normals : (n, 2)
        Unit vectors in the image.
    rotation, shift, lens
        ``camera_from_world``, and fx, fy, cx, cy in px.
    directions : (n, 3)
        Written.
    """
    seen = np.empty(3)
    for i in range(len(pairs)):
        a, b, t = pairs[i, 0], pairs[i, 1], shares[i]
        for k in range(3):
            seen[k] = shift[k]
            for j in range(3):
                seen[k] += rotation[k, j] * ((1.0 - t) * points[a, j] + t * points[b, j])
        depth = seen[2]
        x, y = normals[i, 0] * lens[0] / depth, normals[i, 1] * lens[1] / depth
        z = -(x * seen[0] + y * seen[1]) / depth
        for j in range(3):
            directions[i, j] = x * rotation[0, j] + y * rotation[1, j] + z * rotation[2, j]
