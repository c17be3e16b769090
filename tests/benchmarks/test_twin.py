"""The twin of the paper that speed is compared with does the same work: it rebuilds the poses."""

import importlib.util
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from kinesphere.data import motion_from_parameters
from kinesphere.geometry.rotations import rotation_angle
from kinesphere.synthetic import make_performance

GRAIN_DEG = 0.5  # its twists are sampled every degree
FRAMES = 12


@pytest.fixture(scope="module")
def twin():
    file = Path(__file__).parents[2] / "benchmarks" / "speed" / "twin.py"
    spec = importlib.util.spec_from_file_location("twin", file)
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def test_the_twin_rebuilds_every_pose(twin, rng):
    performance = make_performance(rng, rate=5.0, calibration_s=8.0, free_s=6.0, repetitions=1)
    truth = performance.parameters
    some = slice(-FRAMES, None)
    angles, twists = twin.solve_frames(performance.motion.rotations[some], truth.skeleton)
    assert angles.shape == (FRAMES, *truth.angles.shape[1:])
    assert np.array_equal(np.isnan(angles), np.isnan(truth.angles[some]))
    rebuilt = motion_from_parameters(
        replace(
            truth,
            root_positions=truth.root_positions[some],
            root_rotations=truth.root_rotations[some],
            angles=angles,
            twists=twists,
            residuals=truth.residuals[some],
            flags=truth.flags[some],
            moving=truth.moving[some],
        )
    ).relative_rotations()
    actual = performance.motion.relative_rotations()[some]
    off = np.rad2deg(rotation_angle(np.swapaxes(rebuilt, -1, -2) @ actual))
    assert off.max() < 1.01 * GRAIN_DEG
    assert off.max() > GRAIN_DEG / 10  # sampled, as the paper does it
