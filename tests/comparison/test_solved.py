"""One actor recorded by two systems: another clock, another world, noise of their own."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from kinesphere.comparison import compare
from kinesphere.pipeline import solve
from kinesphere.synthetic import make_performance

NOISE = 0.001  # m
LATE = 130  # frames at 50 Hz


@pytest.fixture(scope="module")
def both():
    rng = np.random.default_rng(11)
    performance = make_performance(rng, rate=50.0, calibration_s=20.0, free_s=10.0)
    one = performance.recording
    first = replace(one, markers=one.markers + rng.normal(0, NOISE, one.markers.shape))
    turn = Rotation.from_euler("y", 63, degrees=True).as_matrix()
    markers = one.markers[LATE:] @ turn.T + [1.0, 0.0, -2.0]
    second = replace(one, markers=markers + rng.normal(0, NOISE, markers.shape))
    one, other = (solve(recording, performance.model) for recording in (first, second))
    return compare(one, other), compare(performance.motion, one)


def test_the_clock_and_the_world_are_found(both):
    found, _ = both
    assert found.offset.seconds == pytest.approx(-LATE / 50.0, abs=0.1 / 50)
    assert np.rad2deg(found.world.turn) == pytest.approx(63, abs=0.2)
    assert np.rad2deg(found.world.tilt) < 0.2
    assert found.world.residual < 0.01
    assert not [w for w in found.warnings if "one motion" in w]


def test_what_is_left_is_the_noise_of_both(both):
    """Each differs from the truth by its own noise; the two from each other by √2 of that."""
    found, from_truth = both
    alone = {joint.name: joint.orientation_after for joint in from_truth.joints}
    for joint in found.joints:
        ratio = joint.orientation_after / alone[joint.name]
        assert ratio == pytest.approx(np.sqrt(2), rel=0.1), joint.name
    bends = [p.after for p in found.parameters if p.kind == "bend"]
    assert np.median([a.correlation for a in bends]) > 0.99
