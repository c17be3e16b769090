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
def found():
    rng = np.random.default_rng(11)
    performance = make_performance(rng, rate=50.0, calibration_s=20.0, free_s=10.0)
    one = performance.recording
    first = replace(one, markers=one.markers + rng.normal(0, NOISE, one.markers.shape))
    turn = Rotation.from_euler("y", 63, degrees=True).as_matrix()
    markers = one.markers[LATE:] @ turn.T + [1.0, 0.0, -2.0]
    second = replace(one, markers=markers + rng.normal(0, NOISE, markers.shape))
    model = performance.model
    return compare(solve(first, model), solve(second, model))


def test_the_clock_and_the_world_are_found(found):
    assert found.offset.seconds == pytest.approx(-LATE / 50.0, abs=0.1 / 50)
    assert np.rad2deg(found.world.turn) == pytest.approx(63, abs=0.2)
    assert np.rad2deg(found.world.tilt) < 0.2
    assert found.world.residual < 0.01


def test_what_is_left_is_what_noise_makes(found):
    """1 mm on markers some centimetres apart: about a degree a limb."""
    after = [np.rad2deg(joint.orientation_after) for joint in found.joints]
    assert np.median(after) < 2.5
    bends = [p.after.rmsd for p in found.parameters if p.kind == "bend"]
    assert np.rad2deg(max(bends)) < 2.0
    assert min(p.after.correlation for p in found.parameters if p.kind == "bend") > 0.99
    assert not [w for w in found.warnings if "one motion" in w]
