"""Turns of ball joints: put before the turn there is, told apart, kept within limits."""

import numpy as np
from numpy.typing import NDArray

from kinesphere.kernels.jit import kernel
from kinesphere.kernels.rotations import quaternions_kernel, rotation_vectors_kernel
from kinesphere.markerless.kernels.posing import about, times

Array = NDArray[np.float64]
Indices = NDArray[np.intp]


@kernel
def _cross(a: Array, b: Array) -> Array:
    return np.array(
        [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
    )


@kernel
def _dot(a: Array, b: Array) -> float:
    return float(a[0] * b[0] + a[1] * b[1] + a[2] * b[2])


@kernel
def _turned(turn: Array, v: Array) -> Array:
    return np.array([_dot(turn[0], v), _dot(turn[1], v), _dot(turn[2], v)])


@kernel
def turn_kernel(balls: Array, limbs: Indices, turns: Array) -> None:
    """Put turns, (n, 3) rotation vectors in rad, before those of some limbs' balls.

    Parameters
    ----------
    balls : (n_limbs, 3, 3)
        Changed.
    limbs : (n,)
    """
    for i in range(len(limbs)):
        angle = np.sqrt(_dot(turns[i], turns[i]))
        if angle > 0.0:
            balls[limbs[i]] = times(about(turns[i] / angle, angle), balls[limbs[i]])


@kernel
def turns_between_kernel(starts: Array, ends: Array, limbs: Indices, turns: Array) -> None:
    """Write the turns, (n, 3) rotation vectors, that put before ``starts`` give ``ends``."""
    relative, quaternions = np.empty((len(limbs), 3, 3)), np.empty((len(limbs), 4))
    for i in range(len(limbs)):
        relative[i] = times(ends[limbs[i]], starts[limbs[i]].T)
    quaternions_kernel(relative, quaternions)
    rotation_vectors_kernel(quaternions, turns)


@kernel
def _least(source: Array, target: Array) -> Array:
    """Return the least rotation from one unit vector to another, as `rotation_between` does."""
    cosine = _dot(source, target)
    if cosine < -1.0 + 1e-12:
        axis = np.zeros(3)
        axis[np.abs(source).argmin()] = 1.0
        axis = _cross(source, axis)
        return about(axis / np.sqrt(_dot(axis, axis)), np.pi)
    v = _cross(source, target)
    turned = np.empty((3, 3))
    for i in range(3):
        for j in range(3):
            turned[i, j] = v[i] * v[j] / (1.0 + cosine)
        turned[i, i] += cosine
    turned[0, 1] -= v[2]
    turned[1, 0] += v[2]
    turned[0, 2] += v[1]
    turned[2, 0] -= v[1]
    turned[1, 2] -= v[0]
    turned[2, 1] += v[0]
    return turned


@kernel
def limit_kernel(
    balls: Array,
    limbs: Indices,
    long_axes: Array,
    towards: Array,
    swings: Array,
    twists: Array,
) -> None:
    """Bring the balls of some limbs to the nearest turns within their limits.

    Parameters
    ----------
    balls : (n_limbs, 3, 3)
        Changed where a limit is passed.
    limbs : (n,)
    long_axes, towards : (n_limbs, 3)
        Unit vectors: along the limb; the middle of where it may point.
    swings, twists : (n_limbs,) rad
        How far the long axis may be from there, and a limb turned about it.
    """
    for limb in limbs:
        long_axis, middle = long_axes[limb], towards[limb]
        turn = balls[limb].copy()
        pointing = _turned(turn, long_axis)
        angle = np.arccos(min(max(_dot(pointing, middle), -1.0), 1.0))
        if angle > swings[limb]:
            axis = _cross(middle, pointing)
            size = np.sqrt(_dot(axis, axis))
            if size > 0.0:
                turn = times(about(axis / size, swings[limb] - angle), turn)
                pointing = _turned(turn, long_axis)
        least = _least(long_axis, pointing)
        twisted = times(least.T, turn)
        sine = 0.5 * (
            (twisted[2, 1] - twisted[1, 2]) * long_axis[0]
            + (twisted[0, 2] - twisted[2, 0]) * long_axis[1]
            + (twisted[1, 0] - twisted[0, 1]) * long_axis[2]
        )
        cosine = 0.5 * (twisted[0, 0] + twisted[1, 1] + twisted[2, 2] - 1.0)
        twist = np.arctan2(sine, cosine)
        if abs(twist) > twists[limb]:
            kept = min(max(twist, -twists[limb]), twists[limb])
            turn = times(least, about(long_axis, kept))
        balls[limb] = turn
