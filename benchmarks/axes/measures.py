"""Numbers that tell how good something is, each against hand-made cases in the tests."""

from collections.abc import Iterable, Mapping
from itertools import combinations
from typing import Any

import numpy as np
from numpy.typing import NDArray

from kinesphere.data import Step
from kinesphere.geometry.rotations import mean_rotation, rotation_angle

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]

MIRROR = np.diag([1.0, 1.0, -1.0])
"""Left ↔ right in the body frame."""


def f1(found: Mask, true: Mask) -> float:
    """Return the harmonic mean of precision and recall of a mask; 0 if nothing is right."""
    return 2 * float((found & true).sum()) / max(float(found.sum() + true.sum()), 1.0)


def line_angles(a: Array, b: Array) -> Array:
    """Return the angles between lines in deg, 0…90, (..., 3) and (..., 3) → (...,)."""
    sine = np.linalg.norm(np.cross(a, b), axis=-1)
    return np.asarray(np.rad2deg(np.arctan2(sine, np.abs((a * b).sum(axis=-1)))))


def matched(found: Array, true: Array) -> list[int]:
    """Return which of two found axes belongs to each of two true ones, the best in the sum."""
    apart = line_angles(true[:, None], found[None, :])
    return [0, 1] if apart[0, 0] + apart[1, 1] <= apart[0, 1] + apart[1, 0] else [1, 0]


def axis_errors(found: Array, true: Array) -> Array:
    """Return the error of each of two true axes in deg; 90 for one that nobody found, (2,)."""
    if len(found) == 0:
        return np.array([90.0, 90.0])
    if len(found) == 1:
        apart = line_angles(true, found[0])
        return np.array([apart[0], 90.0] if apart[0] <= apart[1] else [90.0, apart[1]])
    return line_angles(found[matched(found, true)], true)


def position_deviations(measured: Array, rebuilt: Array, lever: Array) -> Array:
    """Return how far apart two poses put the end of a lever, (n, 3, 3) twice, (3,) m → (n,) mm."""
    return np.asarray(1e3 * np.linalg.norm((measured - rebuilt) @ lever, axis=-1))


def axis_deviations(measured: Array, rebuilt: Array) -> Array:
    """Return the angles between the three pairs of axes of two poses, (n, 3, 3) → (n, 3) deg."""
    chord = np.linalg.norm(measured - rebuilt, axis=-2)
    # the chord is precise for small angles, where the cosine is not
    return np.asarray(np.rad2deg(2 * np.arcsin(np.clip(chord / 2, 0, 1))))


def geodesics(measured: Array, rebuilt: Array) -> Array:
    """Return the angles between two poses, (n, 3, 3) → (n,) deg."""
    return np.rad2deg(rotation_angle(np.swapaxes(rebuilt, -1, -2) @ measured))


def deviations_to_mean(frames: Array) -> Array:
    """Return the angle of every axis to that of the mean frame, (k, 3, 3) → (3k,) deg."""
    mean = mean_rotation(frames)
    return axis_deviations(frames, mean).ravel()


def deviations_pairwise(frames: Array) -> Array:
    """Return the angle between each axis of each two frames, (k, 3, 3) → deg."""
    pairs = [axis_deviations(a, b) for a, b in combinations(frames, 2)]
    return np.concatenate(pairs)


def wrapped(angles: Array) -> Array:
    """Return angles in (−π, π], rad."""
    return np.asarray(np.pi - (np.pi - angles) % (2 * np.pi))


def mirrored(axis: Array) -> Array:
    """Return an axis of the right side as its twin on the left has it, (3,); axial: ``−S a``."""
    return np.asarray(-MIRROR @ axis)


def rms(values: Array) -> float:
    """Return the root mean square of what is known; NaN if nothing is."""
    known = values[np.isfinite(values)]
    return float(np.sqrt((known**2).mean())) if known.size else float("nan")


def found_at_joints(history: Iterable[Step]) -> Mapping[str, Any]:
    """Return what the last parameterization in a history found, joint by joint."""
    steps = [step for step in history if step.name == "parameterization"]
    found: Any = steps[-1].findings["joints"]
    return found
