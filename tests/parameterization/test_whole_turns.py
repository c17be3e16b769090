"""Limbs that turn on and on: hinges, joints of two axes, and what serves where nothing is told."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from kinesphere.geometry.rotations import mean_rotation
from kinesphere.parameterization.axes.fit import goes_round, phase_swing
from kinesphere.parameterization.settings import AxesSettings, ParameterizationSettings
from kinesphere.parameterization.third_axis import fit_axes
from kinesphere.parameterization.view import view_joint
from kinesphere.parameterization.zero import aligned_rest, reach_and_twist

RATE = 50.0
T = np.arange(3000) / RATE
LIMB = np.array([0.0, -1.0, 0.0])
SETTINGS = ParameterizationSettings()


def unit(*vector):
    return np.array(vector) / np.linalg.norm(vector)


STEEP, FLAT, ACROSS = unit(0.3, 0.5, -0.8), unit(0.05, -0.3, 0.95), unit(1.0, 0.1, 0.2)


def about(axis, angle):
    return Rotation.from_rotvec(np.outer(angle, axis))


def view(rotations, name="joint_01", settings=SETTINGS):
    everywhere = np.ones(len(T), dtype=bool)
    return view_joint(name, rotations.as_matrix(), LIMB, everywhere, RATE, everywhere, settings)


def off(axis, true):
    return np.rad2deg(np.arctan2(np.linalg.norm(np.cross(axis, true)), abs(axis @ true)))


def out_of_reach(joint, fit, settings=SETTINGS):
    return reach_and_twist(joint, fit.axes, fit.rest, settings)[0]


@pytest.mark.parametrize("turns", [1.0, 2.5, 14.9, 15.0, 15.01])
@pytest.mark.parametrize("name", ["joint_01", "left_knee"])
@pytest.mark.parametrize("axis", [STEEP, FLAT])
@pytest.mark.parametrize("noise_deg", [0.0, 0.3])
def test_a_hinge_is_found_and_rebuilt_however_often_it_turns(
    skin, rng, turns, name, axis, noise_deg
):
    noise = Rotation.from_rotvec(skin(rng, len(T), RATE, noise_deg))
    joint = view(noise * about(axis, 2 * np.pi * turns * T / 60), name)
    fit = fit_axes(joint, SETTINGS)
    assert (len(fit.axes), fit.source) == (1, "movement")
    assert off(fit.axes[0], axis) < 0.2
    assert out_of_reach(joint, fit) == 0.0


@pytest.mark.parametrize("name", ["joint_01", "left_hip"])
@pytest.mark.parametrize("spun", ["proximal", "distal"])
def test_two_axes_one_of_which_goes_round(skin, rng, name, spun):
    """It turns on for half a minute, then swings about the other axis three times."""
    spin = np.where(T < 30, 2 * np.pi * 8 * T / 30, 0.0)
    swing = np.zeros(len(T))
    for start in (32, 40, 48):
        during = (start <= T) & (start + 6 > T)
        swing[during] = np.deg2rad(40) * np.sin(np.pi * (T[during] - start))
    first, second = (swing, spin) if spun == "proximal" else (spin, swing)
    inner, outer = (ACROSS, FLAT) if spun == "proximal" else (FLAT, ACROSS)
    noise = Rotation.from_rotvec(skin(rng, len(T), RATE, 0.3))
    joint = view(noise * about(outer, second) * about(inner, first), name)
    fit = fit_axes(joint, SETTINGS)
    assert fit.n_told == 2
    for true in (inner, outer):
        assert min(off(axis, true) for axis in fit.axes) < 1.0
    assert out_of_reach(joint, fit) == 0.0


def test_the_bodys_axes_rebuild_a_whole_turn_where_nobody_named_the_joint():
    """The mean orientation of a whole turn is arbitrary: it may be 50° from all of them."""
    settings = ParameterizationSettings(axes=AxesSettings(method="body", counts="joint_01=2"))
    upright = Rotation.align_vectors([[0.954, 0.0, 0.3]], [LIMB])[0]
    tilted = about(np.array([0.0, 0.0, 1.0]), 2 * np.pi * 15 * T / 60) * upright
    joint = view(tilted, settings=settings)
    fit = fit_axes(joint, settings)
    assert fit.source == "body"
    assert reach_and_twist(joint, fit.axes, aligned_rest(joint, fit.axes), settings)[0] > 0.5
    assert out_of_reach(joint, fit, settings) == 0.0


def test_where_the_mean_serves_it_stays():
    settings = ParameterizationSettings(axes=AxesSettings(method="body", counts="joint_01=2"))
    joint = view(about(STEEP, 0.3 * np.sin(T)), settings=settings)
    fit = fit_axes(joint, settings)
    np.testing.assert_array_equal(fit.rest, mean_rotation(joint.samples.rotations))


def test_a_crank_is_no_twist_and_a_twist_no_crank():
    def swing(rotations):
        samples = view(rotations).samples.with_phases(((0, len(T)),))
        return phase_swing(samples, samples.phases[0])

    turning = 2 * np.pi * 5 * T / 60
    crank = swing(about(STEEP, turning))
    values, axes = np.linalg.eigh(crank.vectors.T @ crank.vectors)
    assert off(axes[:, 2], STEEP) < 1e-6
    assert values[1] < 1e-9 * values[2]
    assert np.linalg.norm(crank.direction) == 0.0
    assert np.abs(swing(about(LIMB, turning)).vectors).max() < 1e-9
    to_and_fro = swing(about(STEEP, np.deg2rad(150) * np.sin(turning)))
    assert np.linalg.norm(to_and_fro.direction) == pytest.approx(1.0)


def test_circling_with_hardly_any_rotation_is_no_crank():
    azimuth = np.linspace(0, 6 * np.pi, 300)
    vectors = np.deg2rad(20) * np.column_stack([np.cos(azimuth), 0 * azimuth, np.sin(azimuth)])
    positions = Rotation.from_rotvec(vectors).apply(LIMB)
    assert not goes_round(vectors, positions, LIMB)
