"""Knees that never straighten, in a model that knows no landmarks."""

from dataclasses import replace

import numpy as np
import pytest

from kinesphere.data import motion_from_parameters
from kinesphere.skeleton import fit_skeleton
from kinesphere.synthetic import make_performance

KNEES = "left_knee", "right_knee"
NOISE = 1e-3


def kneeling(seed, degrees):
    """Return a recording of somebody who kneels, its model, and the true motion."""
    made = make_performance(np.random.default_rng(seed), layout="cmu41", calibration_s=8, free_s=4)
    angles = np.array(made.parameters.angles)
    for i, name in enumerate(made.skeleton.joint_names):
        if name in KNEES:
            angles[:, i, 0] = np.deg2rad(degrees) + 0.3 * angles[:, i, 0]
        elif name.endswith("hip"):
            angles[:, i] *= 0.2
            angles[:, i, 1] += np.deg2rad(20)
    flags = np.zeros_like(made.parameters.flags)
    motion = motion_from_parameters(replace(made.parameters, angles=angles, flags=flags))
    at = {}
    for i, limb in enumerate(motion.skeleton.limbs):
        for label, point in zip(limb.markers, limb.marker_positions, strict=True):
            at[label] = motion.origins[:, i] + motion.rotations[:, i] @ point
    markers = np.stack([at[label] for label in made.recording.labels], axis=1)
    noise = np.random.default_rng(3).normal(scale=NOISE, size=markers.shape)
    return replace(made.recording, markers=markers + noise), made.model, motion


@pytest.mark.parametrize(("seed", "degrees"), [(32, 90.0), (32, 110.0), (31, 100.0)])
def test_knees_without_landmarks_stay_at_the_knees(seed, degrees):
    """Along the axis little is known; across it the motion tells the centre."""
    recording, model, true = kneeling(seed, degrees)
    found = fit_skeleton(recording, model)
    frames = np.arange(0, true.n_frames, 20)
    for knee in KNEES:
        centre = found.joint_centres(frames)[:, found.skeleton.joint_names.index(knee)]
        truth = true.joint_centres(frames)[:, true.skeleton.joint_names.index(knee)]
        off = float(np.linalg.norm(centre - truth, axis=1).mean())
        assert off < 0.12, (knee, off)
    assert not [w for w in found.history[-1].warnings if "no joint can be" in w]
