"""Trials in which every joint of a known actor moves about one of its axes, and their errors."""

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray
from scipy.signal import lfilter

from kinesphere.data import Recording, Skeleton, motion_from_parameters
from kinesphere.pipeline.frames_apart import turn_between
from kinesphere.synthetic import Performance

Array = NDArray[np.float64]

DISTAL, PROXIMAL, NONE = 0, 1, 2
"""Which axis joints move about; none of those that move a limb."""
NOISE_M, MEMORY_S = 1e-3, 0.4
_TWICE = ("root_positions", "root_rotations", "twists", "residuals", "flags", "moving")


def one_movement(performance: Performance, about: int, scatter_deg: float, seed: int) -> Recording:
    """Return a recording in which every joint moves about one axis, twice, under correlated noise.

    Parameters
    ----------
    performance
        A calibration of all joints.
    about
        ``DISTAL``, ``PROXIMAL`` or ``NONE``.
    scatter_deg
        Standard deviation of every joint's angles in the posture all of it starts from: people
        stand differently from trial to trial.
    seed
        Of posture and noise.
    """
    rng = np.random.default_rng(seed)
    told = performance.parameters
    angles = np.array(told.angles)
    for k in {0, 1, 2} - {about}:
        angles[..., k] *= 0.0  # NaN, an axis that is not there, stays
    angles += np.deg2rad(scatter_deg) * rng.normal(size=angles.shape[1:])
    twice = {name: np.concatenate([getattr(told, name)] * 2) for name in _TWICE}
    motion = motion_from_parameters(replace(told, angles=np.concatenate([angles] * 2), **twice))
    places = motion.marker_positions()
    markers = np.stack([places[label] for label in performance.recording.labels], axis=1)
    keep = np.exp(-1 / (told.rate * MEMORY_S))
    kicks = rng.normal(size=markers.shape) * np.sqrt(1 - keep**2)
    noise = NOISE_M * lfilter([1.0], [1.0, -keep], kicks, axis=0)
    return replace(performance.recording, markers=markers + noise)


def axis_errors(skeleton: Skeleton, performance: Performance, name: str) -> Array:
    """Return how far each axis of a joint is from the true one beside the parent's markers, deg."""
    joint, true = skeleton.joint(name), performance.skeleton.joint(name)
    assert joint.axes is not None
    assert true.axes is not None
    limb = performance.skeleton.limb(true.parent)
    found = joint.axes @ turn_between(limb, skeleton.limb(joint.parent)).rotation.T
    cosines = np.abs((found * true.axes).sum(axis=1))
    return np.asarray(np.rad2deg(np.arccos(np.minimum(1.0, cosines))))
