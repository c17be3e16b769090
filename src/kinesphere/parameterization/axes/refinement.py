"""Axes made robust to twist: what a limb does about itself must not tilt what it moves about."""

import numpy as np

from kinesphere.data import Array
from kinesphere.geometry.rotations import mean_rotation, rotation_about
from kinesphere.parameterization.axes.fit import phase_labels
from kinesphere.parameterization.samples import JointSamples, Phase
from kinesphere.parameterization.twist import closed_twist

MOST_FRAMES = 400  # of one axis; more change the axis by less than its uncertainty
FLOOR = np.deg2rad(0.1)  # a spread below this says nothing about weights
STEP = 1e-4  # rad, of the numerical derivative
LARGEST_STEP = 0.15  # rad, of one iteration
ROUNDS = 12


def refine_axes(samples: JointSamples, axes: Array) -> Array:
    """Refine each axis in its own phases, weighing what cone and twist tell.

    About the true axis a limb keeps its colatitude, and without twist its orientation follows. An
    axis ``a`` leaves of every frame an out-of-cone angle ε and a twist τ; under independent
    normal errors of unknown spread the likeliest axis has the least
    ``log Σ ε² + log Σ (τ − τ̄)²``, found by Gauss-Newton steps with the two spreads taken anew
    each time. Where the limb twists while it moves, τ loses its weight by itself; where it does
    not, orientations count in full.

    Parameters
    ----------
    samples
        One joint.
    axes : (n_axes, 3)
        Start; within some 40° of the truth.

    Returns
    -------
    (n_axes, 3)
    """
    labels = phase_labels(samples, axes)
    refined = axes.copy()
    for k in range(len(axes)):
        mine = [phase for phase, at in zip(samples.phases, labels, strict=True) if at == k]
        if mine:
            refined[k] = _refine(samples, mine, axes[k])
    return refined


def _refine(samples: JointSamples, phases: list[Phase], start: Array) -> Array:
    stride = max(1, sum(b - a for a, b in phases) // MOST_FRAMES)
    rotations = [samples.rotations[a:b:stride] for a, b in phases]
    counts = np.array([len(part) for part in rotations])
    means = np.repeat([mean_rotation(part) for part in rotations], counts, axis=0)
    q = np.concatenate(rotations)
    phase = np.repeat(np.arange(len(phases)), counts)
    long_axis = samples.long_axis
    r, p = means @ long_axis, q @ long_axis

    def centred(values: Array) -> Array:
        return np.asarray(values - (np.bincount(phase, values) / counts)[phase])

    def errors(a: Array) -> tuple[Array, Array]:
        across = np.linalg.norm(np.cross(a, p), axis=1)
        colatitude = np.arctan2(across, p @ a)
        theta = np.arctan2(np.cross(r, p) @ a, (p * r).sum(axis=1) - (r @ a) * (p @ a))
        twist = closed_twist(rotation_about(a, theta) @ means, q, long_axis)
        return centred(colatitude), centred(twist)

    axis = start
    for _ in range(ROUNDS):
        first = np.cross(axis, np.eye(3)[np.abs(axis).argmin()])
        first /= np.linalg.norm(first)
        basis = np.stack([first, np.cross(axis, first)])
        now = errors(axis)
        spreads = [float(np.sqrt((e**2).mean() + FLOOR**2)) for e in now]
        columns = []
        for direction in basis:
            near = axis + STEP * direction
            moved = errors(near / np.linalg.norm(near))
            columns.append(
                np.concatenate(
                    [(m - e) / (STEP * s) for m, e, s in zip(moved, now, spreads, strict=True)]
                )
            )
        residual = np.concatenate([e / s for e, s in zip(now, spreads, strict=True)])
        step = -np.linalg.lstsq(np.stack(columns, axis=1), residual, rcond=None)[0]
        size = float(np.linalg.norm(step))
        if size > LARGEST_STEP:
            step *= LARGEST_STEP / size
        axis = axis + step @ basis
        axis = axis / np.linalg.norm(axis)
        if size < STEP:
            break
    return np.asarray(axis)
