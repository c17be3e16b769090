"""From joint angles to limbs, from limbs to the surface."""

import numpy as np
from numpy.typing import NDArray

from kinesphere.kernels.jit import kernel

Array = NDArray[np.float64]
Indices = NDArray[np.intp]


@kernel
def about(axis: Array, angle: float) -> Array:
    """Return the rotation about a unit axis (Rosenhahn et al. 2006, equation 9)."""
    s, c = np.sin(angle), 1.0 - np.cos(angle)
    x, y, z = axis[0], axis[1], axis[2]
    turn = np.empty((3, 3))
    turn[0, 0] = 1.0 - c * (y * y + z * z)
    turn[1, 1] = 1.0 - c * (x * x + z * z)
    turn[2, 2] = 1.0 - c * (x * x + y * y)
    turn[0, 1], turn[1, 0] = c * x * y - s * z, c * x * y + s * z
    turn[0, 2], turn[2, 0] = c * x * z + s * y, c * x * z - s * y
    turn[1, 2], turn[2, 1] = c * y * z - s * x, c * y * z + s * x
    return turn


@kernel
def times(a: Array, b: Array) -> Array:
    """Return the product of two matrices, (3, 3)."""
    product = np.empty((3, 3))
    for i in range(3):
        for j in range(3):
            product[i, j] = a[i, 0] * b[0, j] + a[i, 1] * b[1, j] + a[i, 2] * b[2, j]
    return product


@kernel
def pose_kernel(
    parents: Indices,
    bind: Array,
    dof_limbs: Indices,
    dof_kinds: Indices,
    dof_axes: Array,
    position: Array,
    balls: Array,
    angles: Array,
    rotations: Array,
    centres: Array,
    axes: Array,
) -> None:
    """Write the world poses of limbs and the world axes of all degrees of freedom.

    Parameters
    ----------
    parents : (n_limbs,)
    bind : (n_limbs, 3) m
        Joint centres in the bind pose.
    dof_limbs, dof_kinds, dof_axes : (n_dofs,), (n_dofs,), (n_dofs, 3)
        In the order of the limbs; kinds 0 slide, 1 ball, 2 hinge.
    position, balls, angles
        The pose.
    rotations, centres, axes : (n_limbs, 3, 3), (n_limbs, 3), (n_dofs, 3)
        Written.
    """
    k = 0
    above = np.eye(3)
    for limb in range(len(parents)):
        parent = parents[limb]
        if parent < 0:
            for i in range(3):
                centres[limb, i] = position[i]
            above = np.eye(3)
        else:
            above = rotations[parent].copy()
            for i in range(3):
                centres[limb, i] = centres[parent, i]
                for j in range(3):
                    centres[limb, i] += above[i, j] * (bind[limb, j] - bind[parent, j])
        turn = above
        while k < len(dof_limbs) and dof_limbs[k] == limb:
            for i in range(3):
                axes[k, i] = 0.0
                for j in range(3):
                    axes[k, i] += turn[i, j] * dof_axes[k, j]
            if dof_kinds[k] == 2:
                turn = times(turn, about(dof_axes[k], angles[k]))
            k += 1
        rotations[limb] = times(turn, balls[limb])


@kernel
def skin_kernel(
    vertices: Array,
    influences: NDArray[np.int32],
    weights: Array,
    bind: Array,
    rotations: Array,
    centres: Array,
    points: Array,
) -> None:
    """Write where linear blend skinning puts the vertices.

    Parameters
    ----------
    vertices : (n, 3) m
        In the bind pose.
    influences, weights : (n, k)
        Limbs and their shares, which sum to one.
    bind, rotations, centres
        Joint centres in the bind pose; limbs in the world.
    points : (n, 3) m
        Written.
    """
    for v in range(len(vertices)):
        x = y = z = 0.0
        for k in range(influences.shape[1]):
            w = weights[v, k]
            if w == 0.0:
                continue
            b = influences[v, k]
            dx = vertices[v, 0] - bind[b, 0]
            dy = vertices[v, 1] - bind[b, 1]
            dz = vertices[v, 2] - bind[b, 2]
            r = rotations[b]
            x += w * (centres[b, 0] + r[0, 0] * dx + r[0, 1] * dy + r[0, 2] * dz)
            y += w * (centres[b, 1] + r[1, 0] * dx + r[1, 1] * dy + r[1, 2] * dz)
            z += w * (centres[b, 2] + r[2, 0] * dx + r[2, 1] * dy + r[2, 2] * dz)
        points[v, 0] = x
        points[v, 1] = y
        points[v, 2] = z


@kernel
def vertex_normals_kernel(points: Array, faces: NDArray[np.int32], normals: Array) -> None:
    """Write outward normals of vertices, not of unit length: the sum over faces by area."""
    normals[:] = 0.0
    for f in range(len(faces)):
        a, b, c = faces[f, 0], faces[f, 1], faces[f, 2]
        ux, uy, uz = (
            points[b, 0] - points[a, 0],
            points[b, 1] - points[a, 1],
            points[b, 2] - points[a, 2],
        )
        vx, vy, vz = (
            points[c, 0] - points[a, 0],
            points[c, 1] - points[a, 1],
            points[c, 2] - points[a, 2],
        )
        nx, ny, nz = uy * vz - uz * vy, uz * vx - ux * vz, ux * vy - uy * vx
        for v in (a, b, c):
            normals[v, 0] += nx
            normals[v, 1] += ny
            normals[v, 2] += nz
