"""Where fitting the puppet begins: every way to stand, arms out, half down, down."""

from typing import NamedTuple

import numpy as np

from kinesphere.data import Array
from kinesphere.editing.mesh.rigging.fit import Target, apart, fit_puppet
from kinesphere.editing.mesh.rigging.puppet import Puppet

ARMS = {"T": 0.0, "A": 40.0, "standing": 75.0}
"""Degrees that the upper arms hang below the horizontal."""
_COARSE = (0.3, 0.3, 0.2, 0.2, 0.15, 0.15, 0.1, 0.1)  # m
_FINER = (0.1, 0.1, 0.08, 0.08, 0.06, 0.06, 0.05, 0.05, *(0.04,) * 4)
_FINEST = (*(0.04,) * 2, *(0.03,) * 5)
_EVERY, _EVERY_FINER = 4, 2
_HOPELESS = 0.06
"""m, beyond which a coarse fit is no person and not worth a finer one; people: 0.02, a capsule:
0.08."""


class Fit(NamedTuple):
    """The puppet on a surface."""

    body_from_mesh: Array
    """(3, 3) rotation: front, up, right of the mesh as rows."""
    scale: float
    """m of the fit for one unit of the mesh."""
    pose: str
    """Which of ``ARMS`` it began from."""
    vector: Array
    """What poses the puppet."""
    error: float
    """m, root mean square from one to the other and back."""


def fit_from(
    puppet: Puppet, points: Array, normals: Array, ways: list[Array], poses: tuple[str, ...]
) -> tuple[Fit, float]:
    """Return the best fit of all starts, and how many times worse the best of another way is.

    Parameters
    ----------
    points, normals : (n, 3)
        Samples of the mesh, in its unit and axes.
    ways
        Rotations ``body_from_mesh`` to try.
    poses
        Which of ``ARMS`` to try.
    """
    tall = float(np.ptp(puppet.body.vertices[:, 1]))
    tried: list[tuple[int, Fit]] = []
    for number, way in enumerate(ways):
        turned = points @ way.T
        scale = tall / float(np.ptp(turned[:, 1]))
        target = Target(turned * scale, normals @ way.T)
        for pose in poses:
            start = _start(puppet, target.points, pose)
            free = np.zeros(len(start), dtype=bool)
            for part in ("shift", "turn", "size", "bends"):
                free[puppet.parts[part]] = True
            vector = fit_puppet(puppet, target, start, free, _COARSE, _EVERY)
            tried.append((number, Fit(way, scale, pose, vector, _error(puppet, target, vector))))
    chosen, best = min(tried, key=lambda one: one[1].error)
    others = [fit.error for number, fit in tried if number != chosen]
    if best.error > _HOPELESS:
        return best, np.inf
    target = Target(points @ best.body_from_mesh.T * best.scale, normals @ best.body_from_mesh.T)
    free = np.ones(len(best.vector), dtype=bool)
    vector = fit_puppet(puppet, target, best.vector, free, _FINER, _EVERY_FINER)
    vector = fit_puppet(puppet, target, vector, free, _FINEST)
    finished = best._replace(vector=vector, error=_error(puppet, target, vector))
    return finished, min(others, default=np.inf) / best.error


def pose_of(limbs: tuple[str, ...], along: Array, up: Array) -> str:
    """Return which of ``ARMS`` the upper arms are nearest to.

    Parameters
    ----------
    along : (n_limbs, 3)
        From the beginning of each limb to its end.
    up : (3,)
    """
    at = [limbs.index(f"{side}_upper_arm") for side in ("left", "right")]
    sine = -(along[at] @ up) / np.maximum(np.linalg.norm(along[at], axis=1), 1e-15)
    below = float(np.degrees(np.arcsin(np.clip(sine, -1, 1))).mean())
    return min(ARMS, key=lambda name: abs(ARMS[name] - below))


def _error(puppet: Puppet, target: Target, vector: Array) -> float:
    return float(np.sqrt(np.mean([np.mean(d**2) for d in apart(puppet, target, vector)])))


def _start(puppet: Puppet, points: Array, pose: str) -> Array:
    """Return the puppet in a pose, its box about the middle of the points' box."""
    body = puppet.body
    vector = np.zeros(puppet.parts["shapes"].stop)
    bends = vector[puppet.parts["bends"]].reshape(-1, 3)
    for side, sign in (("left", 1.0), ("right", -1.0)):
        limb = body.limbs.index(f"{side}_upper_arm")
        y, z = (body.ends[limb] - body.joint_centres[limb])[1:]
        hangs = np.arctan2(-y, abs(z))
        bends[limb - 1, 0] = sign * (hangs - np.radians(ARMS[pose]))
    placed = puppet.vertices(vector)
    middles = [(array.min(axis=0) + array.max(axis=0)) / 2 for array in (points, placed)]
    vector[puppet.parts["shift"]] = middles[0] - middles[1]
    return vector
