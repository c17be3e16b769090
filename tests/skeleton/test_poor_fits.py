"""Markers that do not move as one body are named, and only those."""

import re
from dataclasses import replace

import numpy as np
import pytest

from kinesphere.skeleton import fit_skeleton
from kinesphere.synthetic import make_performance


@pytest.fixture(scope="module")
def performance():
    return make_performance(np.random.default_rng(5), rate=10.0, calibration_s=20.0, free_s=2.0)


def poor_limbs(motion):
    return {
        limb
        for warning in motion.skeleton.history[-1].warnings
        if "do not move as one body" in warning
        for limb in re.findall(r"(\w+) \(\d+ mm\)", warning)
    }


def test_sound_limbs_are_not_named(performance, rng):
    noisy = performance.recording.markers + rng.normal(
        scale=2e-3, size=performance.recording.markers.shape
    )
    motion = fit_skeleton(replace(performance.recording, markers=noisy), performance.model)
    assert poor_limbs(motion) == set()


def test_limbs_whose_markers_are_scattered_over_the_body_are_named(performance, rng):
    labels = tuple(rng.permutation(performance.recording.labels))
    motion = fit_skeleton(replace(performance.recording, labels=labels), performance.model)
    assert len(poor_limbs(motion)) > 6
