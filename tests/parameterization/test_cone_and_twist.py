"""What an axis leaves unexplained, against the plain way to compute it, and what weighs it."""

import numpy as np
from numpy.testing import assert_allclose
from scipy.spatial.transform import Rotation

from kinesphere.geometry.rotations import mean_rotation, rotation_about
from kinesphere.parameterization.axes.cone_and_twist import ConeAndTwist
from kinesphere.parameterization.axes.likeliest import Cone, likeliest_axis
from kinesphere.parameterization.axes.stratify import turning_weights
from kinesphere.parameterization.samples import JointSamples
from kinesphere.parameterization.twist import closed_twist

PHASES = ((0, 40), (50, 110))
ROUNDING = 1e-12
SETTLED = 1e-6  # rad, what the last step may still be


def samples(rng, spread=0.7, n=120):
    rotations = Rotation.from_rotvec(spread * rng.normal(size=(n, 3))).as_matrix()
    long_axis = np.array([0.6, 0.0, -0.8])
    return JointSamples(rotations, rotations @ long_axis, PHASES, 50.0, long_axis)


def test_errors_are_those_of_the_plain_way(rng):
    joint = samples(rng)
    axes = rng.normal(size=(4, 3))
    axes /= np.linalg.norm(axes, axis=1)[:, None]
    colatitudes, twists = ConeAndTwist.of(joint, PHASES, 1000).errors(axes)
    for axis, colatitude, twist in zip(axes, colatitudes, twists, strict=True):
        start = 0
        for a, b in PHASES:
            q, mean = joint.rotations[a:b], mean_rotation(joint.rotations[a:b])
            p, r = q @ joint.long_axis, mean @ joint.long_axis
            theta = np.arctan2(np.cross(r, p) @ axis, p @ r - (p @ axis) * (r @ axis))
            swung = rotation_about(axis, theta) @ mean
            mine = slice(start, start + b - a)
            assert_allclose(colatitude[mine], np.arccos(p @ axis), atol=ROUNDING)
            plain = closed_twist(swung, q, joint.long_axis)
            assert_allclose(np.exp(1j * twist[mine]), np.exp(1j * plain), atol=ROUNDING)
            start += b - a


def test_a_cone_of_every_phase_or_one_for_all(rng):
    # the limb draws two parallel circles about one axis, at 50° and 80°
    axis = np.array([0.0, 0.0, 1.0])
    parts = []
    for colatitude in (50.0, 80.0):
        angles = rng.uniform(-1, 1, size=60)
        start = Rotation.from_euler("y", colatitude, degrees=True).as_matrix()
        parts.append(rotation_about(axis, angles) @ start)
    rotations = np.concatenate(parts)
    phases = ((0, 60), (60, 120))
    joint = JointSamples(rotations, rotations @ axis, phases, 50.0, axis)
    errors = ConeAndTwist.of(joint, phases, 1000)
    tilted = Rotation.from_euler("x", 8, degrees=True).apply(axis)
    alone = likeliest_axis(errors, tilted, 30)
    assert_allclose(alone.axis, axis, atol=SETTLED)
    assert alone.cost < likeliest_axis(errors, tilted, 30, Cone(np.pi / 2, 0.3)).cost


def test_thinning_keeps_about_as_many_as_asked_for(rng):
    joint = samples(rng)
    # every fourth frame of 40 and of 60; an even number, as many in either half
    assert len(ConeAndTwist.of(joint, PHASES, 25).scalars) == 10 + 16
    whole = ConeAndTwist.of(joint, PHASES, 1000)
    assert len(whole.scalars) == 100
    assert whole.effective == 100 / 50.0 / 0.4  # s of movement over s of memory


def test_frames_of_one_cell_count_as_one(rng):
    turns = Rotation.from_rotvec(np.deg2rad([[0, 0, a] for a in (0, 3, 5, 8, 9.5, 4, 2, -1)]))
    found = turning_weights(turns.as_matrix(), np.deg2rad(4.0))
    assert_allclose(found, [0.5, 0.5, 0.5, 0.5, 1.0, 0.5, 0.5, 1.0], rtol=0)
    assert turning_weights(turns.as_matrix(), np.pi).tolist() == [1 / 8] * 8
