"""A hinge whose second half may say something else: when that counts."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from kinesphere.parameterization.movement_axes import movement_axes
from kinesphere.parameterization.settings import ParameterizationSettings
from kinesphere.parameterization.view import view_joint

RATE = 50.0
AXIS, LIMB = np.array([0.0, 0.0, 1.0]), np.array([0.0, -1.0, 0.0])
OTHER = Rotation.from_rotvec([0.0, np.deg2rad(45.0), 0.0]).apply(AXIS)


def hinge(rng, first_deg, second_deg):
    """Return a limb that swings about one axis, then in its second half about another."""
    n = round(40 * RATE)
    t = np.arange(n) / RATE
    vectors = np.deg2rad(0.05) * rng.normal(size=(n, 3))
    for half, (axis, reach) in enumerate(((AXIS, first_deg), (OTHER, second_deg))):
        for start in 20 * half + np.array([2.0, 8.0, 14.0]):
            during = (t >= start) & (t < start + 3)
            swing = np.deg2rad(reach) * np.sin(2 * np.pi / 3 * (t[during] - start))
            vectors[during] += swing[:, None] * axis
    everywhere = np.ones(n, dtype=bool)
    rotations = Rotation.from_rotvec(vectors).as_matrix()
    settings = ParameterizationSettings()
    return view_joint("joint_01", rotations, LIMB, everywhere, RATE, everywhere, settings, False)


def told(rng, first_deg, second_deg):
    return movement_axes(hinge(rng, first_deg, second_deg), 1, ParameterizationSettings())


def test_a_fidget_contradicts_no_movement(rng):
    found = told(rng, 35.0, 5.0)
    assert found.doubts == ()
    assert found.remark == ""
    assert np.rad2deg(np.arccos(abs(found.axes[0] @ AXIS))) < 1.0


@pytest.mark.parametrize("second_deg", [20.0, 35.0])
def test_as_wide_a_movement_about_another_axis_does(rng, second_deg):
    assert any("two halves" in doubt for doubt in told(rng, 35.0, second_deg).doubts)


def test_a_fidget_contradicts_a_fidget(rng):
    """Both are short: neither is more of a main movement than the other."""
    assert any("two halves" in doubt for doubt in told(rng, 8.0, 5.0).doubts)


def test_skin_makes_short_movements_less_certain(rng):
    quality = told(rng, 35.0, 0.0).quality
    short = told(rng, 10.0, 0.0).quality
    assert quality is not None
    assert short is not None
    assert 2.0 * quality.uncertainty < short.uncertainty


def test_movements_done_twice_go_before_one_done_once():
    """About each axis one pure stroke and one with a wobble, and one that is about neither."""
    strokes = [(40, 0, 0), (40, 10, 0), (0, 40, 0), (10, 40, 0), (30, 30, 1)]
    course = np.sin(np.linspace(0, 2 * np.pi, 100))
    out_of_step = np.sin(np.linspace(0, 4 * np.pi, 100))
    vectors = np.zeros((len(strokes) * 200, 3))
    for i, (first, second, free) in enumerate(strokes):
        during = slice(200 * i + 50, 200 * i + 150)
        main = first >= second
        vectors[during, 2] = np.deg2rad(first) * (course if main else out_of_step)
        vectors[during, 0] = np.deg2rad(second) * (out_of_step if main or free else course)
    everywhere = np.ones(len(vectors), dtype=bool)
    settings = ParameterizationSettings()
    view = view_joint(
        "joint_01",
        Rotation.from_rotvec(vectors).as_matrix(),
        LIMB,
        everywhere,
        RATE,
        everywhere,
        settings,
        False,
    )
    assert len(view.samples.phases) == 5
    quality = movement_axes(view, 2, settings).quality
    assert sorted(np.bincount(quality.labels)) == [2, 2]
