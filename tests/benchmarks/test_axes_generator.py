"""The known joints of the benchmark are what they claim to be."""

import numpy as np
import pytest
from benchmarks.axes.generator import (
    CONES,
    NOISES,
    Cones,
    Noise,
    draw_axes,
    make_calibration,
    make_free_motion,
    spoil,
    swing,
    wander,
)
from benchmarks.axes.measures import rms
from numpy.testing import assert_allclose

from kinesphere.geometry.rotations import rotation_angle, rotation_log
from kinesphere.parameterization import AxesSettings, ParameterizationSettings, parameterize

EXACT = 1e-9
TWO = ParameterizationSettings(axes=AxesSettings(counts="joint_01=2"))


@pytest.mark.parametrize("name", CONES)
def test_limb_and_axes_lie_as_asked(rng, name):
    cones = CONES[name]
    for _ in range(20):
        axes, limb = draw_axes(rng, cones)
        assert_allclose(np.linalg.norm(axes, axis=1), 1, atol=EXACT)
        assert np.linalg.norm(limb) == pytest.approx(1, abs=EXACT)
        between = np.rad2deg(np.arccos(axes[0] @ axes[1]))
        assert cones.between[0] - EXACT <= between <= cones.between[1] + EXACT
        for angle in np.rad2deg(np.arccos(axes @ limb)):
            assert cones.cone[0] - EXACT <= angle <= cones.cone[1] + EXACT
        normal = np.cross(axes[0], axes[1])
        assert abs(limb @ normal) / np.linalg.norm(normal) >= 0.5 - EXACT


@pytest.mark.parametrize("make", [make_calibration, make_free_motion])
def test_true_axes_leave_nothing_over(rng, make):
    joint = make(rng, CONES["75°"], Noise())
    found = parameterize(joint.motion, TWO, reuse=joint.skeleton)
    assert np.abs(found.residuals).max() < EXACT
    assert_allclose(found.angles[:, 0, :2], joint.angles[:, :2], atol=EXACT)
    assert_allclose(found.twists[:, 0], joint.angles[:, 2], atol=EXACT)


def test_clean_is_the_joint_without_noise(rng):
    joint = make_calibration(rng, CONES["60–120°"], NOISES["iid 3°"])
    clean = joint.clean
    assert rotation_angle(np.swapaxes(clean.rotations, 1, 2) @ joint.rotations).max() > 0.1
    found = parameterize(clean.motion, TWO, reuse=clean.skeleton)
    assert np.abs(found.residuals).max() < EXACT


def test_movements_are_where_they_are_said_to_be(rng):
    joint = make_calibration(rng, CONES["90°"], Noise())
    still = ~joint.moving
    assert np.rad2deg(np.abs(joint.angles[still, :2])).max() < 2  # six deviations of the sway
    for k, reach in enumerate((45.0, 40.0)):
        mine, other = joint.angles[joint.about[:, k]].T[[k, 1 - k]]
        assert np.rad2deg(np.abs(mine).max()) == pytest.approx(reach, rel=0.2)
        assert np.rad2deg(np.abs(other).max()) < 2
        starts = np.flatnonzero(np.diff(joint.about[:, k].astype(int)) == 1)
        assert len(starts) == 4
    assert not joint.about.all(axis=1).any()


@pytest.mark.parametrize(
    ("noise", "size", "memory"),
    [
        (Noise(independent=1.5), 1.5, 0.0),
        (Noise(correlated=1.5), 1.5, np.exp(-0.2 / 0.4)),
    ],
)
def test_noise_is_as_large_and_as_slow_as_asked(rng, noise, size, memory):
    n = 20_000
    spoiled = spoil(rng, np.tile(np.eye(3), (n, 1, 1)), np.zeros((n, 3)), noise)
    vectors = np.rad2deg(rotation_log(spoiled))
    assert_allclose([rms(v) for v in vectors.T], size, rtol=0.1)
    lag = 10  # frames, 0.2 s
    assert (vectors[lag:] * vectors[:-lag]).mean() / size**2 == pytest.approx(memory, abs=0.1)


def test_tissue_follows_the_angle_late(rng):
    angles = np.zeros((300, 3))
    angles[100:, 0] = 0.5
    vectors = rotation_log(spoil(rng, np.tile(np.eye(3), (300, 1, 1)), angles, Noise(tissue=0.1)))
    size = np.linalg.norm(vectors, axis=1)
    assert_allclose(size[3:103], 0, atol=EXACT)
    assert_allclose(size[103:], 0.05, atol=EXACT)  # 60 ms at 50 Hz are three frames


def test_glitches_are_rare_and_large(rng):
    n = 5000
    vectors = rotation_log(
        spoil(rng, np.tile(np.eye(3), (n, 1, 1)), np.zeros((n, 3)), Noise(glitches=0.02))
    )
    size = np.linalg.norm(vectors, axis=1)
    assert (size > EXACT).mean() == pytest.approx(0.02, abs=0.008)
    assert np.rad2deg(np.median(size[size > EXACT])) > 30


def test_swings_reach_one(rng):
    play = swing(rng, 700)
    assert np.abs(play).max() == pytest.approx(1)
    assert np.abs(np.diff(play)).max() < 0.1
    assert wander(rng, 50, 4).shape == (50, 4)


def test_the_same_seed_is_the_same_joint():
    first, again = (
        make_calibration(np.random.default_rng(7), Cones((70, 110), (60, 120)), NOISES["tissue"])
        for _ in range(2)
    )
    assert (first.rotations == again.rotations).all()
