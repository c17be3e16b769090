"""What the names of joints say about number, order, sign and side of axes."""

from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose

from kinesphere.errors import BadSetting
from kinesphere.geometry.rotations import rotation_about
from kinesphere.parameterization.anatomy import (
    BODY_AXES,
    MIRROR,
    body_axes,
    declared_n_axes,
    human_plan,
    named_axes,
    nominal_axes,
    substitute_axes,
)
from kinesphere.parameterization.per_joint import parse_counts, parse_windows
from kinesphere.parameterization.settings import (
    AxesSettings,
    FilterSettings,
    ParameterizationSettings,
)
from kinesphere.synthetic.actor import make_actor
from kinesphere.synthetic.bodies import HUMAN
from kinesphere.synthetic.creatures import QUADRUPED

DOWN, UP, FORWARD = -np.eye(3)[1], np.eye(3)[1], np.eye(3)[0]


@pytest.mark.parametrize(
    ("joint", "limb", "goes"),
    [
        ("left_hip", DOWN, FORWARD),
        ("right_shoulder", DOWN, FORWARD),
        ("right_elbow", DOWN, FORWARD),
        ("left_knee", DOWN, -FORWARD),
        ("right_ankle", FORWARD, UP),
        ("neck", UP, FORWARD),
        ("lumbar", UP, FORWARD),
    ],
)
def test_flexion_is_positive(joint, limb, goes):
    flexed = rotation_about(body_axes(joint)[0], np.array(0.5)) @ limb
    assert flexed @ goes > 0.4


@pytest.mark.parametrize(("joint", "outward"), [("left_hip", -1), ("right_hip", 1)])
def test_abduction_is_positive_on_both_sides(joint, outward):
    abducted = rotation_about(body_axes(joint)[1], np.array(0.5)) @ DOWN
    assert abducted[2] * outward > 0.4  # z points right


@pytest.mark.parametrize("kind", sorted(set(BODY_AXES) - {"neck", "lumbar"}))
def test_equal_angles_are_mirrored_poses(kind):
    for left, right in zip(body_axes(f"left_{kind}"), body_axes(f"right_{kind}"), strict=True):
        pose = rotation_about(left, np.array(0.7))
        assert_allclose(rotation_about(right, np.array(0.7)), MIRROR @ pose @ MIRROR, atol=1e-12)


def test_axes_are_named_in_order_and_sign(rng):
    body = body_axes("right_hip")
    tilted = body[:2] + rng.uniform(-0.2, 0.2, (2, 3))
    tilted /= np.linalg.norm(tilted, axis=1, keepdims=True)
    named, order = named_axes(np.array([-tilted[1], tilted[0]]), "right_hip")
    assert_allclose(named, tilted)
    assert order == [1, 0]
    found = np.array([-tilted[1], tilted[0]])
    assert_allclose(nominal_axes("right_hip", found), body[[1, 0]])


def test_nobody_knows_the_axes_of_an_unnamed_joint(rng):
    axes = rng.normal(size=(2, 3))
    assert named_axes(axes, "joint_07")[0] is axes
    assert nominal_axes("joint_07", axes) is None
    assert declared_n_axes("joint_07", {}) is None
    across = substitute_axes("joint_07", 2, np.array([0.1, 0.9, -0.4]))
    assert_allclose(across, np.eye(3)[[0, 2]])


def test_counts_may_be_chosen_by_joint_or_by_kind():
    counts = parse_counts(" left_wrist=1, hip = 3 ")
    assert declared_n_axes("left_wrist", counts) == 1
    assert declared_n_axes("right_wrist", counts) == 2
    assert declared_n_axes("right_hip", counts) == 3
    assert declared_n_axes("left_knee", counts) == 1
    assert declared_n_axes("joint_07", parse_counts("joint_07=2")) == 2


@pytest.mark.parametrize("wrong", ["hip", "hip=4", "=2", "hip=two"])
def test_a_count_that_is_none_is_named(wrong):
    with pytest.raises(BadSetting, match="write JOINT=N"):
        AxesSettings(counts=wrong)


@pytest.mark.parametrize("twice", ["elbow=2,elbow=1", "elbow=2, elbow=2"])
def test_a_count_given_twice_is_told(twice):
    with pytest.raises(BadSetting, match="counts names elbow twice"):
        AxesSettings(counts=twice)
    assert AxesSettings(counts="elbow=2, left_elbow=1")  # one side may differ


def test_a_window_given_twice_is_told():
    with pytest.raises(BadSetting, match="windows names hip twice"):
        AxesSettings(windows="hip=0:3, hip=5:8")


def test_settings_are_addressed_by_group_and_key():
    settings = ParameterizationSettings(axes=AxesSettings(method="direction-joining"))
    listed = settings.as_json()
    assert listed["axes.method"] == "direction-joining"
    assert listed["filter.window"] == 0.2
    assert {key.partition(".")[0] for key in listed} == {
        "filter",
        "axes",
        "rest",
        "angles",
        "twist",
    }


def test_wrong_settings_say_what_would_be_right():
    with pytest.raises(BadSetting, match="known are phase-log-pca"):
        AxesSettings(method="magic")
    with pytest.raises(BadSetting, match="slowest is 70"):
        FilterSettings(slowest=70.0)


def test_windows_are_seconds_of_a_joint():
    found = parse_windows("left_hip=0:12, knee = 12:24.5")
    assert found == {"left_hip": (0.0, 12.0), "knee": (12.0, 24.5)}
    assert parse_windows("") == {}


@pytest.mark.parametrize(
    "wrong", ["left_hip", "=0:3", "hip=3", "hip=5:2", "hip=-1:2", "hip=a:b", "hip=0:inf"]
)
def test_a_window_that_is_none_is_named(wrong):
    with pytest.raises(BadSetting, match="write JOINT=START:END"):
        AxesSettings(windows=wrong)


def test_only_a_body_like_a_person_has_human_anatomy(rng):
    person, dog = (make_actor(rng, plan=plan).skeleton for plan in (HUMAN, QUADRUPED))
    assert human_plan(person)
    assert not human_plan(dog)
    limbs = tuple(
        replace(limb, length=3 * limb.length) if limb.name == "left_forearm" else limb
        for limb in person.limbs
    )
    assert not human_plan(replace(person, limbs=limbs))
    unknown = tuple(replace(limb, length=np.nan) for limb in person.limbs)
    assert human_plan(replace(person, limbs=unknown))
