"""How much free motion holds for somebody who knows what it is made of."""

from collections.abc import Sequence
from typing import Any

import numpy as np
from scipy.optimize import least_squares
from scipy.spatial.transform import Rotation

from benchmarks.axes.estimators import SEEDS, cell
from benchmarks.axes.free_motion import MOTIONS, make
from benchmarks.axes.generator import (
    AMPLITUDES,
    MEMORY,
    NOISES,
    RATE,
    Array,
    TrueJoint,
    draw_rhythm,
    poses,
)
from benchmarks.axes.measures import line_angles
from kinesphere.geometry.rotations import rotation_about, tangent_basis

NOISE = "OU 1°"
THINNED = 2  # every second frame says as much: errors keep 0.4 s
PER_ANGLE = 10  # three sines, three cosines, three frequencies, a mean
ROUNDS = 3000  # evaluations at most; some hundred are needed
TASKS = [
    (motion, 3000 + seed)
    for motion, free in MOTIONS.items()
    if free.rhythm
    for seed in range(SEEDS)
]


def run(motion: str, seed: int) -> tuple[list[float], list[float]]:
    """Return the errors of both axes in deg, and the Cramér–Rao bounds of those."""
    joint = make(motion, NOISE, seed)
    rng = np.random.default_rng(seed)
    rhythms = [draw_rhythm(rng)[0] for reach in (*AMPLITUDES, MOTIONS[motion].twist)]
    return _likeliest(joint, rhythms if MOTIONS[motion].twist else rhythms[:2])


def _likeliest(joint: TrueJoint, rhythms: list[Array]) -> tuple[list[float], list[float]]:
    """Fit axes and rhythms to poses whose errors are known for what they are, from the truth.

    Every angle is a sum of three waves of unknown frequency, size and phase, and a mean; a twist
    that has no rhythm is a mean. Errors are the generator's correlated noise: differences of
    neighbours are weighed as that makes them.
    """
    rotations, angles = joint.rotations[::THINNED], joint.angles[::THINNED]
    times = np.arange(len(rotations)) * THINNED / RATE
    times = times - times.mean()
    keep = np.exp(-THINNED / (RATE * MEMORY))
    error = np.deg2rad(NOISES[NOISE].correlated)
    bases = [tangent_basis(axis) for axis in joint.axes]
    start = [np.zeros(4)]
    for k, rhythm in enumerate(rhythms):
        size = np.linalg.lstsq(_waves(times, rhythm), angles[:, k])[0]
        start.append(np.concatenate([size, rhythm, [0.0]]))
    if len(rhythms) < 3:
        start.append(np.zeros(1))

    def model(v: Array) -> tuple[Array, Array]:
        moved = joint.axes + np.stack([v[:2] @ bases[0], v[2:4] @ bases[1]])
        turned = np.full((len(times), 3), v[-1])
        for k in range(len(rhythms)):
            of = v[4 + PER_ANGLE * k : 4 + PER_ANGLE * (k + 1)]
            turned[:, k] = _waves(times, of[6:9]) @ of[:6] + of[9]
        return moved / np.linalg.norm(moved, axis=1)[:, None], turned

    def residuals(v: Array) -> Array:
        axes, turned = model(v)
        posed = poses(axes, joint.rest, joint.long_axis, turned)
        out = Rotation.from_matrix(rotations @ np.swapaxes(posed, 1, 2)).as_rotvec() / error
        fresh = (out[1:] - keep * out[:-1]) / np.sqrt(1 - keep**2)
        return np.concatenate([out[:1], fresh]).ravel()

    found = least_squares(residuals, np.concatenate(start), method="lm", max_nfev=ROUNDS)
    axes, _ = model(found.x)
    # the limb at its usual twist
    distal = rotation_about(joint.long_axis, -found.x[-1:])[0] @ axes[0]
    errors = [float(line_angles(distal, joint.axes[0])), float(line_angles(axes[1], joint.axes[1]))]
    spread = np.diag(np.linalg.inv(found.jac.T @ found.jac))[:4].reshape(2, 2).sum(axis=1)
    return errors, [float(bound) for bound in np.rad2deg(np.sqrt(spread))]


def _waves(times: Array, frequencies: Array) -> Array:
    turns = 2 * np.pi * np.outer(times, frequencies)
    return np.concatenate([np.sin(turns), np.cos(turns)], axis=1)


def summary(
    results: list[tuple[list[float], list[float]]], tasks: Sequence[tuple[str, int]] = TASKS
) -> dict[str, Any]:
    """Return motion → noise → statistics; with them the median of the bounds, deg."""
    table: dict[str, Any] = {}
    for motion in dict.fromkeys(name for name, _ in tasks):
        mine = [r for (name, _), r in zip(tasks, results, strict=True) if name == motion]
        bounds = np.array([bound for _, bound in mine])
        told = cell([errors for errors, _ in mine])
        table[motion] = {NOISE: told | {"bound_deg": float(np.median(bounds.mean(axis=1)))}}
    return table
