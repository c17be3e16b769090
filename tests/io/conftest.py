"""Small truths for what is written: an actor's few seconds, and a skeleton with every oddity."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from kinesphere.data import JointFlag, motion_from_parameters
from kinesphere.synthetic import make_performance


@pytest.fixture
def performance(rng):
    """Three seconds of an actor at 25 Hz: 75 frames, 12 limbs."""
    return make_performance(rng, rate=25.0, calibration_s=2.0, free_s=1.0)


@pytest.fixture
def odd_parameters(performance, rng):
    """Parameters of a skeleton no body has: anything a file format could get wrong.

    One, two and three axes at any angle to each other, one along the twist's, two along each
    other; long axes and rest orientations at random; whole turns; a limb without markers and one
    of unknown length.
    """
    truth = performance.parameters
    n = truth.n_frames
    limbs = [replace(limb, long_axis=directions(rng, 1)[0]) for limb in truth.skeleton.limbs]
    limbs[3] = replace(limbs[3], markers=(), marker_positions=np.empty((0, 3)), length=np.nan)
    limbs[5] = replace(limbs[5], length=np.nan)
    joints, angles = [], np.full((n, len(truth.skeleton.joints), 3), np.nan)
    for i, joint in enumerate(truth.skeleton.joints):
        n_axes = i % 3 + 1
        axes, rest = directions(rng, n_axes), Rotation.random(rng=rng).as_matrix()
        if i == 4:
            axes[0] = rest @ limbs[i + 1].long_axis
        if i == 7:
            axes[1] = -axes[0]
        joints.append(replace(joint, axes=axes, rest=rest, axes_uncertainty=None))
        angles[:, i, :n_axes] = rng.uniform(-np.pi, np.pi, (n, n_axes))
    return replace(
        truth,
        skeleton=replace(truth.skeleton, limbs=tuple(limbs), joints=tuple(joints)),
        root_rotations=Rotation.random(n, rng=rng).as_matrix(),
        angles=angles,
        twists=rng.uniform(-np.pi, np.pi, angles.shape[:2]),
        residuals=rng.random(angles.shape[:2]) * 0.02,
    )


@pytest.fixture
def gappy_parameters(odd_parameters):
    """Return the same with gaps: the root at the start, one joint for good, one in the middle."""
    angles, twists = odd_parameters.angles.copy(), odd_parameters.twists.copy()
    places, turns = odd_parameters.root_positions.copy(), odd_parameters.root_rotations.copy()
    flags = odd_parameters.flags.copy()
    places[:4], turns[:4] = np.nan, np.nan
    angles[:, 2], twists[:, 2] = np.nan, np.nan
    angles[30:37, 5], twists[30:37, 5] = np.nan, np.nan
    twists[50:60, 6] = np.nan
    flags[:, 2] = flags[30:37, 5] = JointFlag.UNSEEN
    flags[50:60, 6] = JointFlag.TWIST_UNKNOWN | JointFlag.SINGULAR
    return replace(
        odd_parameters,
        root_positions=places,
        root_rotations=turns,
        angles=angles,
        twists=twists,
        flags=flags,
    )


@pytest.fixture
def odd_motion(odd_parameters):
    """Return the motion of the odd parameters."""
    return motion_from_parameters(odd_parameters)


def directions(rng, n):
    """Return n unit vectors, (n, 3)."""
    vectors = rng.normal(size=(n, 3))
    return vectors / np.linalg.norm(vectors, axis=1, keepdims=True)
