"""Performances whose truth is known, small enough to be solved many times."""

from dataclasses import replace

import numpy as np
import pytest

from kinesphere.labelling import built_in_model
from kinesphere.skeleton import fit_skeleton
from kinesphere.synthetic import make_performance, spoil_with_noise

SIZE = {"rate": 25.0, "calibration_s": 40.0, "free_s": 4.0, "repetitions": 1}


@pytest.fixture(scope="session")
def bodies():
    """Return a performance with three to five markers on each of twelve limbs."""
    return make_performance(np.random.default_rng(11), layout="bodies", **SIZE)


@pytest.fixture(scope="session")
def cmu41():
    """Return a performance with the 41 markers of the CMU recordings."""
    return make_performance(np.random.default_rng(12), layout="cmu41", **SIZE)


@pytest.fixture(scope="session")
def bodies_motion(bodies):
    """Return the motion found from `bodies` with its own model."""
    return fit_skeleton(bodies.recording, bodies.model)


@pytest.fixture(scope="session")
def cmu41_motion(cmu41):
    """Return the motion found from `cmu41` with the built-in model."""
    return fit_skeleton(cmu41.recording, built_in_model("cmu41"))


@pytest.fixture(scope="session")
def recorded_alone(bodies):
    """Return what cameras saw of `bodies`, with noise; labels are ``*0``, ``*1``."""
    recording = spoil_with_noise(bodies.recording, np.random.default_rng(8), deviation=0.001)
    return replace(recording, labels=tuple(f"*{i}" for i in range(recording.n_markers)))
