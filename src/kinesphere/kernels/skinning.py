"""Vertices carried by several limbs at once: linear blending and dual quaternions."""

import numpy as np
from numpy.typing import NDArray

from kinesphere.kernels.jit import kernel

Array = NDArray[np.float64]


@kernel
def linear_blend_kernel(
    vertices: Array,
    limbs: NDArray[np.intp],
    shares: Array,
    matrices: Array,
    shifts: Array,
    out: Array,
) -> None:
    """Write ``sum(share * (matrix @ vertex + shift))`` of every vertex in every frame.

    Parameters
    ----------
    vertices : (n_vertices, 3) m
        As bound.
    limbs, shares : (n_vertices, n_shares)
        Which limbs carry each vertex, and how much; a share of zero is skipped.
    matrices, shifts : (n_frames, n_limbs, 3, 3), (n_frames, n_limbs, 3) m
        From where a limb was bound to where it is.
    out : (n_frames, n_vertices, 3) m
        Written; NaN where a limb is.
    """
    for f in range(len(matrices)):
        for v in range(len(vertices)):
            x, y, z = vertices[v, 0], vertices[v, 1], vertices[v, 2]
            a = b = c = 0.0
            for k in range(shares.shape[1]):
                s = shares[v, k]
                if s == 0.0:
                    continue
                m, t = matrices[f, limbs[v, k]], shifts[f, limbs[v, k]]
                a += s * (m[0, 0] * x + m[0, 1] * y + m[0, 2] * z + t[0])
                b += s * (m[1, 0] * x + m[1, 1] * y + m[1, 2] * z + t[1])
                c += s * (m[2, 0] * x + m[2, 1] * y + m[2, 2] * z + t[2])
            out[f, v, 0], out[f, v, 1], out[f, v, 2] = a, b, c


@kernel
def dual_quaternion_kernel(
    vertices: Array,
    limbs: NDArray[np.intp],
    shares: Array,
    quaternions: Array,
    shifts: Array,
    out: Array,
) -> None:
    """Write every vertex moved by the blended screw motion of its limbs.

    Unit dual quaternions are added by their shares, each with the sign nearest to that of the
    first, and made unit again (Kavan et al. 2008, doi:10.1145/1409625.1409627, section 4).

    Parameters
    ----------
    vertices : (n_vertices, 3) m
    limbs, shares : (n_vertices, n_shares)
        The heaviest first.
    quaternions, shifts : (n_frames, n_limbs, 4) xyzw, (n_frames, n_limbs, 3) m
    out : (n_frames, n_vertices, 3) m
        Written; NaN where a limb is.
    """
    n_limbs = quaternions.shape[1]
    dual = np.empty((n_limbs, 4))
    for f in range(len(quaternions)):
        for i in range(n_limbs):  # half of shift times quaternion
            q, t = quaternions[f, i], shifts[f, i]
            dual[i, 0] = 0.5 * (t[0] * q[3] + t[1] * q[2] - t[2] * q[1])
            dual[i, 1] = 0.5 * (t[1] * q[3] + t[2] * q[0] - t[0] * q[2])
            dual[i, 2] = 0.5 * (t[2] * q[3] + t[0] * q[1] - t[1] * q[0])
            dual[i, 3] = -0.5 * (t[0] * q[0] + t[1] * q[1] + t[2] * q[2])
        for v in range(len(vertices)):
            first = quaternions[f, limbs[v, 0]]
            a = b = c = w = ea = eb = ec = ew = 0.0
            for k in range(shares.shape[1]):
                s = shares[v, k]
                if s == 0.0:
                    continue
                q, e = quaternions[f, limbs[v, k]], dual[limbs[v, k]]
                if first[0] * q[0] + first[1] * q[1] + first[2] * q[2] + first[3] * q[3] < 0.0:
                    s = -s
                a += s * q[0]
                b += s * q[1]
                c += s * q[2]
                w += s * q[3]
                ea += s * e[0]
                eb += s * e[1]
                ec += s * e[2]
                ew += s * e[3]
            n = a * a + b * b + c * c + w * w
            x, y, z = vertices[v, 0], vertices[v, 1], vertices[v, 2]
            # vertex + 2 q × (q × vertex + w vertex) + 2 (w e − ew q + q × e), over the norm
            px = b * z - c * y + w * x
            py = c * x - a * z + w * y
            pz = a * y - b * x + w * z
            out[f, v, 0] = x + 2.0 * (b * pz - c * py + w * ea - ew * a + b * ec - c * eb) / n
            out[f, v, 1] = y + 2.0 * (c * px - a * pz + w * eb - ew * b + c * ea - a * ec) / n
            out[f, v, 2] = z + 2.0 * (a * py - b * px + w * ec - ew * c + a * eb - b * ea) / n
