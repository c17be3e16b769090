"""Two axes from free motion that are not to be believed."""

import numpy as np
import pytest
from benchmarks.axes.generator import CONES, NOISES, RATE, make_free_motion, poses
from numpy.testing import assert_allclose
from scipy.spatial.transform import Rotation

from kinesphere.geometry.rotations import rotation_about
from kinesphere.parameterization.free_pair import free_ranges, own_range, too_short
from kinesphere.parameterization.joint import fit_joint
from kinesphere.parameterization.movement_axes import movement_axes
from kinesphere.parameterization.samples import JointSamples
from kinesphere.parameterization.settings import AxesSettings, ParameterizationSettings
from kinesphere.parameterization.view import view_joint

# without refinement, to be quick
SETTINGS = ParameterizationSettings(axes=AxesSettings(method="universal-joint", refine=False))
DOWN = np.array([0.0, 0.0, 1.0])


def view_of(rotations, long_axis=DOWN):
    everywhere = np.ones(len(rotations), dtype=bool)
    return view_joint("joint_01", rotations, long_axis, everywhere, RATE, everywhere, SETTINGS)


def wide(between_deg, seconds=20.0):
    """Return a joint's poses about two axes so far apart, that move by turns of their own."""
    t = np.arange(round(RATE * seconds)) / RATE
    angles = np.deg2rad(40.0) * np.sin(2 * np.pi * np.outer(t, [0.31, 0.47, 0.0]))
    angle = np.deg2rad(between_deg)
    axes = np.array([[1.0, 0.0, 0.0], [np.cos(angle), np.sin(angle), 0.0]])
    return poses(axes, np.eye(3), DOWN, angles), axes


@pytest.mark.parametrize(("seconds", "doubted"), [(6.0, True), (20.0, False)])
def test_free_motion_too_short_tells_no_axes(seconds, doubted):
    view = view_of(wide(80.0, seconds)[0])
    found = movement_axes(view, 2, SETTINGS)
    assert bool(found.doubts) == doubted
    assert fit_joint(view, SETTINGS, 2).source == ("body" if doubted else "movement")
    if doubted:
        (said,) = found.doubts
        assert said.startswith("free motion of 6 s tells no axes: 15 s are needed")


def test_only_movement_counts():
    rotations = np.tile(np.eye(3), (1000, 1, 1))
    told = JointSamples(rotations, rotations @ DOWN, ((0, 200), (600, 900)), RATE, DOWN)
    assert too_short(told).startswith("free motion of 10 s")
    assert not too_short(told.with_phases(((0, 750),)))


@pytest.mark.slow
@pytest.mark.parametrize(("between", "doubted"), [(25.0, True), (40.0, False)])
def test_axes_almost_alike_are_not_two(between, doubted):
    rotations, _ = wide(between)
    found = movement_axes(view_of(rotations), 2, SETTINGS)
    apart = np.rad2deg(np.arccos(abs(found.axes[0] @ found.axes[1])))
    assert apart == pytest.approx(between, abs=1.0)
    assert bool(found.doubts) == doubted
    assert not doubted or "25° apart, too close to be two" in found.doubts[-1]


def test_no_angle_counts_for_more_than_the_joint_moves():
    """About axes that nearly coincide, angles grow and cancel each other."""
    rotations, axes = wide(90.0)
    view = view_of(rotations)
    ranges, beyond = free_ranges(view, axes)
    assert_allclose(np.rad2deg(ranges), 80.0, atol=2.0)
    assert not beyond
    close = np.array([axes[1], Rotation.from_rotvec([0, 0, np.deg2rad(20.0)]).apply(axes[1])])
    ranges, beyond = free_ranges(view, close)
    most = own_range(view.samples)
    assert ranges.max() == pytest.approx(most)
    assert beyond.endswith(f"all the joint's rotation {np.rad2deg(most):.0f}°")


@pytest.mark.parametrize("cones", sorted(CONES))
def test_the_right_axes_are_not_beyond_what_the_joint_moves(rng, cones):
    for rhythm in (True, False):
        joint = make_free_motion(rng, CONES[cones], NOISES["OU 1°"], twist=10.0, rhythm=rhythm)
        assert not free_ranges(view_of(joint.rotations, joint.long_axis), joint.axes)[1]


def test_the_range_of_a_joint_is_its_largest_rotation_whichever_way_time_runs():
    turned = rotation_about(DOWN, np.deg2rad(np.linspace(-30.0, 40.0, 999)))
    told = JointSamples(turned, turned @ DOWN, (), RATE, DOWN)
    back = JointSamples(turned[::-1], turned @ DOWN, (), RATE, DOWN)
    assert np.rad2deg(own_range(told)) == pytest.approx(70.0)
    assert own_range(back) == pytest.approx(own_range(told), rel=1e-12)
