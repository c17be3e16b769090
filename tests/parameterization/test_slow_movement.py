"""A limb that goes far but never fast, beside one that goes nowhere."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from kinesphere.data import JointFlag, PoseFlag
from kinesphere.parameterization import FilterSettings, ParameterizationSettings, parameterize
from kinesphere.parameterization.movement_axes import movement_axes
from kinesphere.parameterization.movement_filter import find_movement, limb_speeds
from kinesphere.parameterization.slow_movement import noise_speed, widest_swing
from kinesphere.parameterization.view import view_halves, view_joint
from kinesphere.synthetic import make_performance

RATE = 50.0
LIMB = np.array([0.0, -1.0, 0.0])
AXIS = np.array([0.3, 0.1, -1.0]) / np.linalg.norm([0.3, 0.1, -1.0])
SETTINGS = ParameterizationSettings()


def bend(skin, rng, course_deg, noise=0.3):
    """Return a limb that goes a course, (n,) deg, about its axis, under correlated noise."""
    turned = Rotation.from_rotvec(np.deg2rad(course_deg)[:, None] * AXIS)
    loose = Rotation.from_rotvec(skin(rng, len(course_deg), RATE, noise))
    return (loose * turned).as_matrix()


def once(range_deg, seconds):
    """Return one bend there and back."""
    t = np.arange(round(seconds * RATE)) / RATE
    return range_deg / 2 * (1 - np.cos(2 * np.pi * t / seconds))


def view(rotations, name="left_knee", settings=SETTINGS):
    everywhere = np.ones(len(rotations), dtype=bool)
    return view_joint(name, rotations, LIMB, everywhere, RATE, everywhere, settings)


def off(axis):
    return np.rad2deg(np.arctan2(np.linalg.norm(np.cross(axis, AXIS)), abs(axis @ AXIS)))


@pytest.mark.parametrize(
    "course",
    [
        once(90, 60),
        once(90, 30),
        np.linspace(0, 324, 3000),  # a crank that goes once round in a minute, nearly
        60 * np.abs((np.arange(3000) / 1000) % 2 - 1),  # 3 deg/s up and down
    ],
)
@pytest.mark.parametrize("name", ["left_knee", "joint_01"])
def test_a_wide_slow_movement_tells_its_axis(skin, rng, course, name):
    slow = view(bend(skin, rng, course), name)
    found = movement_axes(slow, 1, SETTINGS)
    assert slow.movement.slow
    assert slow.movement.threshold < np.deg2rad(3.0)
    assert found.doubts == ()
    assert off(found.axes[0]) < 0.3
    for half in view_halves(slow, SETTINGS):
        assert half.movement.threshold == slow.movement.threshold


def test_without_noise_too(skin, rng):
    found = movement_axes(view(bend(skin, rng, once(90, 60), noise=0.0)), 1, SETTINGS)
    assert off(found.axes[0]) < 1e-6


def test_a_stand_hardly_moves(skin, rng):
    still = view(bend(skin, rng, 3 * np.sin(np.arange(3000) / 400)))
    assert not still.movement.slow
    assert not still.movement.moving.any()
    assert movement_axes(still, 1, SETTINGS).doubts == ("the limb hardly moves",)


def test_a_limb_that_spins_about_itself_does_not_hardly_move():
    spin = np.deg2rad(180.0) * np.arange(3000) / 50
    about_y = Rotation.from_rotvec(spin[:, None] * [0.0, 1.0, 0.0]).as_matrix()
    spinning = movement_axes(view(about_y), 1, SETTINGS)
    assert spinning.doubts == ("the limb turns about its own length alone",)


def test_a_stand_beside_a_slow_bend_is_no_movement(skin, rng):
    course = np.concatenate([np.zeros(1500), once(90, 60), np.zeros(1500)])
    moving = view(bend(skin, rng, course)).movement.moving
    assert moving[2000:2700].mean() > 0.95
    assert moving[3300:4000].mean() > 0.95  # between them it turns back
    assert np.concatenate([moving[:1500], moving[4500:]]).mean() < 0.1


def test_noise_that_passes_the_usual_threshold_hides_no_slow_movement(skin, rng):
    """A fidget of 5° beside a bend of 90°: its axis is not the joint's."""
    course = np.concatenate([np.zeros(1500), once(90, 60)])
    fidget = np.zeros(len(course))
    fidget[500:525] = np.deg2rad(5.0) * np.sin(np.linspace(0, 2 * np.pi, 25))
    aside = Rotation.from_rotvec(np.outer(fidget, [1.0, 0.0, 0.0])).as_matrix()
    slow = view(aside @ bend(skin, rng, course, noise=0.05))
    speeds = limb_speeds(slow.smoothed.rotations @ LIMB, RATE, SETTINGS.filter)
    assert np.nanmax(speeds) > np.deg2rad(SETTINGS.filter.fallback)
    assert slow.movement.slow
    assert off(movement_axes(slow, 1, SETTINGS).axes[0]) < 0.3


def test_what_noise_hides_is_called_slow_not_still(skin, rng):
    slow = view(bend(skin, rng, once(90, 60)))
    hidden = replace(slow, samples=slow.samples.with_phases(()))
    (said,) = movement_axes(hidden, 1, SETTINGS).doubts
    assert "too slowly" in said


@pytest.mark.parametrize("method", ["bounded-valley", "log-speed", "paper"])
def test_nothing_changes_where_phases_are_found(rng, calibration, method):
    settings = FilterSettings(method=method)
    seen = calibration(rng, independent=1.0).view(filter=settings)
    usual = find_movement(seen.smoothed.rotations @ seen.long_axis, RATE, settings)
    assert not seen.movement.slow
    assert seen.smoothed.slow is None
    np.testing.assert_array_equal(seen.movement.moving, usual.moving)


def test_the_papers_filter_is_the_papers(skin, rng):
    settings = replace(SETTINGS, filter=FilterSettings(method="paper"))
    assert not view(bend(skin, rng, once(90, 60)), settings=settings).movement.slow


def test_noise_is_told_from_a_steady_movement(rng):
    """Steps of white noise are Rayleigh distributed: median 1.177 standard deviations."""
    n, deviation, window = 20000, np.deg2rad(0.2), 1.0
    angle = np.deg2rad(9.0) * np.arange(n) / RATE
    steady = np.column_stack([np.cos(angle), np.sin(angle), np.zeros(n)])
    noisy = steady + deviation * rng.normal(size=(n, 3))
    bends = noise_speed(noisy - (noisy * steady).sum(axis=1)[:, None] * steady, RATE, window)
    assert bends == pytest.approx(1.177 * np.sqrt(2) * deviation / window, rel=0.03)
    assert noise_speed(steady, RATE, window) < np.deg2rad(0.5)
    assert np.isnan(noise_speed(steady[:50], RATE, window))


def test_the_widest_swing():
    angles = np.deg2rad([0.0, 10.0, -25.0, 5.0])
    turned = np.column_stack([np.cos(angles), np.sin(angles), np.zeros(4)])
    assert np.rad2deg(widest_swing(turned)) == pytest.approx(35.0)
    assert widest_swing(np.empty((0, 3))) == 0.0


def test_who_moves_slowly_is_told_so_and_rebuilt(skin, rng):
    performance = make_performance(
        np.random.default_rng(7), rate=RATE, calibration_s=30.0, free_s=2.0
    )
    motion = performance.motion
    n, limbs = 1500, motion.skeleton.limb_names
    knee = motion.skeleton.joint("left_knee")
    thigh, shank = limbs.index(knee.parent), limbs.index(knee.child)
    still = np.zeros(n, dtype=int)
    rotations = motion.rotations[still].copy()
    turned = bend(skin, rng, once(90, 30))
    rotations[:, shank] = rotations[:, thigh] @ turned
    solved = parameterize(
        replace(
            motion,
            rotations=rotations,
            origins=motion.origins[still],
            residuals=motion.residuals[still],
            flags=np.full((n, len(limbs)), PoseFlag.MEASURED, dtype=np.uint8),
        )
    )
    at = solved.skeleton.joint_names.index("left_knee")
    assert solved.skeleton.joints[at].axes_source == "movement"
    assert off(solved.skeleton.joints[at].axes[0]) < 0.3
    assert ((solved.flags[:, at] & JointFlag.UNREACHABLE) > 0).mean() < 0.01
    (said,) = [w for w in solved.history[-1].warnings if "so slow" in w]
    assert "left_knee (1." in said
    assert not any("nothing parts movement" in w for w in solved.history[-1].warnings)
