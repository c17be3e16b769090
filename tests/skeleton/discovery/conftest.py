"""Bodies that we made, and an actor whose labels say nothing."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from kinesphere.synthetic import make_performance, spoil_with_noise

NOISE = 0.001  # m


@pytest.fixture(scope="session")
def actor():
    """Return a performance of a person: twelve limbs, one minute at 25 Hz."""
    return make_performance(np.random.default_rng(7), rate=25, calibration_s=40, free_s=20)


@pytest.fixture(scope="session")
def recorded(actor):
    """Return what cameras saw of it, with noise; labels are ``*0``, ``*1``."""
    recording = spoil_with_noise(actor.recording, np.random.default_rng(8), deviation=NOISE)
    return replace(recording, labels=tuple(f"*{i}" for i in range(recording.n_markers)))


@pytest.fixture(scope="session")
def owner(actor):
    """Return the true limb of every column."""
    return [limb.name for limb in actor.skeleton.limbs for _ in limb.markers]


@pytest.fixture
def limbs_of():
    """Return found limb → set of the true limbs of its markers, as a function."""

    def told(discovery, owner):
        return {
            segment.name: {owner[int(label[1:])] for label in segment.markers}
            for segment in discovery.model.segments
        }

    return told


@pytest.fixture
def moving_bodies():
    """Return the function that makes bodies which move by themselves."""
    return made


def made(rng, sizes, n_frames=200, apart=0.4, spread=0.06, noise=0.0):
    """Return points of bodies that turn and travel by themselves, and which each is of."""
    clouds, of = [], []
    for k, size in enumerate(sizes):
        shape = rng.normal(scale=spread, size=(size, 3))
        steps = np.cumsum(rng.normal(scale=0.05, size=(n_frames, 3)), axis=0)
        turns = Rotation.from_rotvec(steps).as_matrix()
        way = apart * rng.normal(size=3) + np.cumsum(
            rng.normal(scale=0.01, size=(n_frames, 3)), axis=0
        )
        clouds.append(np.einsum("fij,mj->fmi", turns, shape) + way[:, None])
        of += [k] * size
    points = np.concatenate(clouds, axis=1)
    return points + rng.normal(scale=noise, size=points.shape), np.array(of)
