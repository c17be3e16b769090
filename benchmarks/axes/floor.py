"""How well free motion can tell its axes at all, twist being what it is."""

from typing import Any

import numpy as np
from scipy.optimize import least_squares

from benchmarks.axes.estimators import FREE_NOISES, FREE_TWISTS, cell
from benchmarks.axes.generator import CONES, NOISES, Array, TrueJoint, make_free_motion
from benchmarks.axes.measures import line_angles, wrapped
from kinesphere.parameterization import AngleSettings
from kinesphere.parameterization.angles import two_axis_angles

SEEDS = 10
THINNED = 3  # every third frame says as much
REACH = 5.0  # weight of a limb out of reach against twist
STEP = 1e-4  # of the numerical derivative


def least_twist(joint: TrueJoint) -> Array:
    """Return the axes, (2, 3), that need least twist, searched from the true ones.

    Two axes and a twist rebuild every pose, so in free motion nothing but the size of the twist
    speaks for one pair of axes against another. A search that starts at the truth and knows the
    rest shows about how much the data tell.
    """
    rotations = joint.rotations[::THINNED]
    known = np.ones(len(rotations), dtype=bool)
    bases = [_tangent(axis) for axis in joint.axes]

    def axes_at(steps: Array) -> Array:
        moved = [a + b @ s for a, b, s in zip(joint.axes, bases, steps.reshape(2, 2), strict=True)]
        return np.array([axis / np.linalg.norm(axis) for axis in moved])

    def residuals(steps: Array) -> Array:
        solved = two_axis_angles(
            rotations, axes_at(steps), joint.rest, joint.long_axis, known, AngleSettings()
        )
        middle = np.angle(np.exp(1j * solved.twists).mean())
        return np.concatenate([wrapped(solved.twists - middle), REACH * solved.excess])

    found = least_squares(residuals, np.zeros(4), diff_step=np.full(4, STEP), max_nfev=40)
    return axes_at(found.x)


def run(noise: str, twist: str, seed: int) -> list[float]:
    """Return the errors of both axes in deg."""
    joint = make_free_motion(
        np.random.default_rng(seed), CONES["60–120°"], NOISES[noise], twist=FREE_TWISTS[twist]
    )
    return [float(e) for e in line_angles(least_twist(joint), joint.axes)]


TASKS = [
    (noise, twist, 3000 + seed)
    for twist in FREE_TWISTS
    for noise in FREE_NOISES
    for seed in range(SEEDS)
]


def summary(results: list[list[float]]) -> dict[str, Any]:
    """Return twist → noise → statistics."""
    table: dict[str, Any] = {}
    for (noise, twist, _), errors in zip(TASKS, results, strict=True):
        table.setdefault(twist, {}).setdefault(noise, []).append(errors)
    return {
        twist: {noise: cell(errors) for noise, errors in row.items()}
        for twist, row in table.items()
    }


def _tangent(axis: Array) -> Array:
    """Return two unit vectors perpendicular to an axis and each other, (3, 2)."""
    first = np.cross(axis, np.eye(3)[np.abs(axis).argmin()])
    first /= np.linalg.norm(first)
    return np.stack([first, np.cross(axis, first)], axis=1)
