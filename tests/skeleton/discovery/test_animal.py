"""A body on four legs is nobody, a person on all fours is somebody."""

from dataclasses import replace

import numpy as np
import pytest

from kinesphere.data import motion_from_parameters
from kinesphere.skeleton import discover
from kinesphere.synthetic import QUADRUPED, make_performance, spoil_with_noise

NOISE = 0.001  # m


def recorded(seed, **kind):
    made = make_performance(np.random.default_rng(seed), calibration_s=50, free_s=30, **kind)
    rng = np.random.default_rng(seed + 1000)
    return made, spoil_with_noise(made.recording, rng, deviation=NOISE)


def on_all_fours(made, knees):
    """Return a recording of the actor on hands and feet, ``knees`` bent by so many degrees."""
    angles = np.array(made.parameters.angles)
    for i, joint in enumerate(made.skeleton.joint_names):
        if joint.endswith(("hip", "shoulder")):
            angles[:, i] *= 0.4
            angles[:, i, 1] += np.deg2rad(80 if joint.endswith("hip") else 75)
        elif joint.endswith("knee"):
            angles[:, i, 0] = np.deg2rad(knees) + 0.4 * angles[:, i, 0]
    flags = np.zeros_like(made.parameters.flags)
    motion = motion_from_parameters(replace(made.parameters, angles=angles, flags=flags))
    at = {}
    for i, limb in enumerate(motion.skeleton.limbs):
        for label, point in zip(limb.markers, limb.marker_positions, strict=True):
            at[label] = motion.origins[:, i] + motion.rotations[:, i] @ point
    markers = np.stack([at[label] for label in made.recording.labels], axis=1)
    noise = np.random.default_rng(3).normal(scale=NOISE, size=markers.shape)
    return replace(made.recording, markers=markers + noise)


@pytest.mark.slow
@pytest.mark.parametrize("seed", [15, 26, 110])
def test_an_animal_of_a_person_s_proportions_is_numbered_and_it_is_said_why(seed):
    _, recording = recorded(seed, plan=QUADRUPED)
    found = discover(recording)
    assert all(segment.name.startswith("limb_") for segment in found.model.segments)
    assert any("rather an animal's" in warning for warning in found.step.warnings)


@pytest.mark.slow
@pytest.mark.parametrize("knees", [0, 80])
def test_a_person_on_all_fours_throughout_keeps_the_names(knees):
    made, _ = recorded(100)
    found = discover(on_all_fours(made, knees))
    owner = {label: limb.name for limb in made.skeleton.limbs for label in limb.markers}
    for segment in found.model.segments:
        assert {owner[label] for label in segment.markers} == {segment.name}
    assert found.step.findings["names_confidence"] > 0.8
