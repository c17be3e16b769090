"""Some seconds of a joint whose angles are sums of waves: what poses tell about the waves."""

from dataclasses import dataclass

import numpy as np
from scipy.linalg import cho_factor, cho_solve
from scipy.linalg.lapack import dtrtri
from scipy.spatial.transform import Rotation

from kinesphere.data import Array
from kinesphere.geometry.rotations import rotation_about
from kinesphere.parameterization.axes.free_motion import FreeMotion


@dataclass(eq=False)
class Stretch:
    """Some seconds of motion and what is thought of them."""

    rotations: Array
    """(n, 3, 3)"""
    waves: Array
    """(n, 2 n_waves): cosines, then sines, of every frequency."""
    angles: Array
    """(n, 3) rad, about the distal axis, the proximal one and the limb."""
    sizes: Array
    """(3, n_waves) rad², variance of a wave's coefficients."""


def linearized(
    motion: FreeMotion, stretch: Stretch, axes: Array, bases: list[Array]
) -> tuple[Array, Array, Array]:
    """Return how poses turn with angles, (n, 3, 3), with means and axes, (n, 3, 7), and the rest.

    The rest, (n, 3), is what waves, means and a change of axes have to make up for.
    """
    angles = stretch.angles
    proximal = rotation_about(axes[1], angles[:, 1])
    both = proximal @ rotation_about(axes[0], angles[:, 0])
    limb = motion.reference @ motion.long_axis
    posed = both @ rotation_about(limb, angles[:, 2]) @ motion.reference
    by_angle = np.stack(
        [proximal @ axes[0], np.broadcast_to(axes[1], angles.shape), both @ limb], axis=2
    )
    columns = [by_angle]
    for axis, basis, angle, before in (
        (axes[0], bases[0], angles[:, 0], proximal),
        (axes[1], bases[1], angles[:, 1], np.eye(3)),
    ):
        sine, cosine = np.sin(angle)[:, None, None], np.cos(angle)[:, None, None]
        columns.append(before @ (sine * basis.T + (1 - cosine) * np.cross(axis, basis).T))
    apart = Rotation.from_matrix(stretch.rotations @ np.swapaxes(posed, 1, 2)).as_rotvec()
    out = apart + np.einsum("nik,nk->ni", by_angle, angles)
    return by_angle, np.concatenate(columns, axis=2), out


def products_of(linear: tuple[Array, Array, Array], waves: Array) -> Array:
    """Return the products of all columns: waves of each angle, means and axes, and the rest."""
    by_angle, others, out = linear
    few = np.concatenate([others, out[:, :, None]], axis=2)  # (n, 3, 8)
    m = waves.shape[1]
    products = np.empty((3 * m + 8, 3 * m + 8))
    products[3 * m :, 3 * m :] = np.tensordot(few, few, axes=([0, 1], [0, 1]))
    for k in range(3):
        rows = slice(k * m, (k + 1) * m)
        for i in range(k, 3):
            columns = slice(i * m, (i + 1) * m)
            load = (by_angle[:, :, k] * by_angle[:, :, i]).sum(axis=1)
            products[rows, columns] = waves.T @ (load[:, None] * waves)
            products[columns, rows] = products[rows, columns].T
        beside = np.einsum("ni,nij->nj", by_angle[:, :, k], few)
        products[rows, 3 * m :] = waves.T @ beside
        products[3 * m :, rows] = products[rows, 3 * m :].T
    return products


def posterior(products: Array, sizes: Array) -> tuple[Array, Array, float]:
    """Return the variances of the waves' coefficients, (m,), and their shares, (m, 8).

    Third comes minus half the logarithm of the covariance's determinant.
    """
    m = 2 * sizes.size
    scale = np.sqrt(both_of(sizes)).ravel()  # keeps waves that are hardly there from overflowing
    whole = scale[:, None] * products[:m, :m] * scale + np.eye(m)
    factor = cho_factor(whole, lower=True)
    share = scale[:, None] * cho_solve(factor, scale[:, None] * products[:m, m:])
    inverse, _ = dtrtri(factor[0], lower=1)  # whose columns' squares are the inverse's diagonal
    variances = scale**2 * (np.tril(inverse) ** 2).sum(axis=0)
    narrowed = float(np.log(np.diag(factor[0])).sum() - np.log(scale).sum())
    return variances, share, narrowed


def both_of(sizes: Array) -> Array:
    """Return the variances of cosines and sines, (3, 2 n_waves)."""
    return np.concatenate([sizes, sizes], axis=1)
