"""How well free motion can tell its axes at all, twist being what it is."""

from typing import Any

import numpy as np
from scipy.optimize import least_squares

from benchmarks.axes.estimators import cell
from benchmarks.axes.free_motion import ALL_NOISES, MOTIONS, make
from benchmarks.axes.generator import Array, TrueJoint
from benchmarks.axes.measures import line_angles, wrapped
from kinesphere.geometry.rotations import tangent_basis
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
    bases = [tangent_basis(axis) for axis in joint.axes]

    def axes_at(steps: Array) -> Array:
        moved = [a + s @ b for a, b, s in zip(joint.axes, bases, steps.reshape(2, 2), strict=True)]
        return np.array([axis / np.linalg.norm(axis) for axis in moved])

    def residuals(steps: Array) -> Array:
        solved = two_axis_angles(
            rotations, axes_at(steps), joint.rest, joint.long_axis, known, AngleSettings()
        )
        middle = np.angle(np.exp(1j * solved.twists).mean())
        return np.concatenate([wrapped(solved.twists - middle), REACH * solved.excess])

    found = least_squares(residuals, np.zeros(4), diff_step=np.full(4, STEP), max_nfev=40)
    return axes_at(found.x)


def run(motion: str, noise: str, seed: int) -> list[float]:
    """Return the errors of both axes in deg."""
    joint = make(motion, noise, seed)
    return [float(e) for e in line_angles(least_twist(joint), joint.axes)]


TASKS = [
    (motion, noise, 3000 + seed)
    for motion, free in MOTIONS.items()
    if free.noises == ALL_NOISES
    for noise in free.noises
    for seed in range(SEEDS)
]


def summary(results: list[list[float]]) -> dict[str, Any]:
    """Return motion → noise → statistics."""
    table: dict[str, Any] = {}
    for (motion, noise, _), errors in zip(TASKS, results, strict=True):
        table.setdefault(motion, {}).setdefault(noise, []).append(errors)
    return {
        motion: {noise: cell(errors) for noise, errors in row.items()}
        for motion, row in table.items()
    }
