"""Lengths made for people follow what is much smaller than a person."""

import numpy as np
import pytest

from kinesphere.skeleton import SkeletonSettings, fit_skeleton
from kinesphere.skeleton.scale import PERSON, scaled, size_share
from kinesphere.synthetic import HAND, make_performance

EXACT = 1e-4  # m: 0.1 mm on noise-free recordings
SPIN = 1e-9  # relative, rounding


@pytest.mark.parametrize("seed", [0, 1])
def test_a_hand_is_measured_like_a_body(seed):
    performance = make_performance(
        np.random.default_rng(seed), plan=HAND, rate=10.0, calibration_s=20, free_s=5
    )
    motion = fit_skeleton(performance.recording, performance.model)
    truth = performance.skeleton.joint_names
    order = [truth.index(name) for name in motion.skeleton.joint_names]
    off = np.linalg.norm(motion.joint_centres() - performance.joint_centres[:, order], axis=2)
    assert off.max() < EXACT
    share = motion.history[-1].findings["length_share"]
    assert 0.1 < share < 0.5
    assert motion.history[-1].settings["outlier_mm"] == SkeletonSettings().outlier_mm


def test_people_keep_their_lengths(bodies):
    assert size_share(bodies.recording.markers) == 1.0
    assert scaled(SkeletonSettings(), 1.0) == SkeletonSettings()


def test_the_share_is_the_extent_of_what_is_seen():
    square = np.array([[1.0, 1.0, 5.0], [-1.0, 1.0, 5.0], [-1.0, -1.0, 5.0], [1.0, -1.0, 5.0]])
    frames = np.repeat(0.01 * square[None], 7, axis=0)
    expected = 0.01 * np.sqrt(2) / PERSON
    assert size_share(frames) == pytest.approx(expected, rel=SPIN)
    frames[:2] = np.nan
    frames[2] *= 1000  # a frame of ghosts
    assert size_share(frames) == pytest.approx(expected, rel=SPIN)
    assert size_share(np.full((3, 4, 3), np.nan)) == 1.0
