"""The paper's per-frame method, written down as it stands: frame by frame, joint by joint.

Sar Dessai, Hornung & Kobbelt 2006, sections 4.4 and 4.5. NumPy does what is within a step, all 360
samples of a twist at once included; nothing is kept from one frame to the next but the angles
before, which choose the candidate.
"""

import numpy as np
from numpy.typing import NDArray

from kinesphere.data import Joint, Skeleton

Array = NDArray[np.float64]

_SAMPLES = np.deg2rad(np.arange(360.0))


def solve_frames(rotations: Array, skeleton: Skeleton) -> tuple[Array, Array]:
    """Return the angles and twists of joints of one or two axes.

    Parameters
    ----------
    rotations : (n_frames, n_limbs, 3, 3)
        ``world_from_limb``.
    skeleton
        With axes and rest orientations.

    Returns
    -------
    angles : (n_frames, n_joints, 3) rad
    twists : (n_frames, n_joints) rad
    """
    n_frames, n_joints = len(rotations), len(skeleton.joints)
    angles = np.full((n_frames, n_joints, 3), np.nan)
    twists = np.empty((n_frames, n_joints))
    for frame in range(n_frames):
        for j, joint in enumerate(skeleton.joints):
            parent = rotations[frame, skeleton.parents[j + 1]]
            actual = parent.T @ rotations[frame, j + 1]
            long_axis = skeleton.limbs[j + 1].long_axis
            before = angles[frame - 1, j] if frame else np.zeros(3)
            angles[frame, j], twists[frame, j] = _solve(joint, actual, long_axis, before)
    return angles, twists


def _solve(joint: Joint, actual: Array, long_axis: Array, before: Array) -> tuple[Array, float]:
    axes, rest = joint.axes, joint.rest
    assert axes is not None
    assert rest is not None
    r, p = rest @ long_axis, actual @ long_axis
    found = np.full(3, np.nan)
    if len(axes) == 1:
        found[0] = _angle_about(axes[0], r, p)
    else:
        candidates = [
            (_angle_about(axes[0], r, x), _angle_about(axes[1], x, p))
            for x in _where_circles_meet(axes[0], r, axes[1], p)
        ]
        found[:2] = min(candidates, key=lambda c: float(_apart(np.array(c), before[:2])))
    model = rest
    for axis, angle in zip(axes, found, strict=False):
        model = _rotation(axis, np.asarray(angle)) @ model
    return found, _sampled_twist(model @ long_axis, model, actual)


def _where_circles_meet(a1: Array, r: Array, a2: Array, p: Array) -> list[Array]:
    """Return both points on the circle of ``r`` about ``a1`` and that of ``p`` about ``a2``."""
    across = np.cross(a1, a2)
    normals = np.array([a1, a2, across])
    on_line = np.linalg.solve(normals, np.array([a1 @ r, a2 @ p, 0.0]))
    half = np.sqrt(max(0.0, 1 - float(on_line @ on_line)) / (across @ across))
    return [on_line + half * across, on_line - half * across]


def _angle_about(axis: Array, source: Array, target: Array) -> float:
    u, v = source - (source @ axis) * axis, target - (target @ axis) * axis
    return float(np.arctan2(axis @ np.cross(u, v), u @ v))


def _rotation(axis: Array, angles: Array) -> Array:
    """Return rotations about an axis (Rodrigues), (3, 3) or (n, 3, 3)."""
    x, y, z = axis
    k = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    s, c = np.sin(angles)[..., None, None], np.cos(angles)[..., None, None]
    return np.asarray(np.eye(3) + s * k + (1 - c) * (k @ k))


def _sampled_twist(limb: Array, model: Array, actual: Array) -> float:
    """Return of 360 angles the one with the least sum of angles between the three axis pairs."""
    turned = _rotation(limb, _SAMPLES) @ model
    cosines = np.clip((turned * actual).sum(axis=1), -1, 1)
    best = int(np.arccos(cosines).sum(axis=1).argmin())
    return float(np.angle(np.exp(1j * _SAMPLES[best])))


def _apart(angles: Array, before: Array) -> Array:
    return np.asarray(np.abs(np.angle(np.exp(1j * (angles - before)))).sum())
