"""Axes from several recordings of one person: each joint's from where they are known best."""

from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_array_equal

from kinesphere.data import Step
from kinesphere.pipeline import solve
from kinesphere.pipeline.reuse import skeletons_of, with_best_axes
from kinesphere.synthetic import make_performance


@pytest.fixture(scope="module")
def performance():
    return make_performance(np.random.default_rng(5), rate=12.0, free_s=0.0)


def known(skeleton, **degrees):
    """Return a skeleton whose joints are measured as well as given, in deg; others are the body's.

    Axes and rests of measured ones are negated, so that one can see from where they come.
    """
    joints = []
    for joint in skeleton.joints:
        told = degrees.get(joint.name)
        joints.append(
            replace(joint, axes_source="body", axes_uncertainty=np.full(joint.n_axes, np.nan))
            if told is None
            else replace(
                joint,
                axes=-joint.axes,
                rest=-joint.rest,  # no rotation, but easily seen
                axes_source="movement",
                axes_uncertainty=np.deg2rad(np.full(joint.n_axes, told)),
            )
        )
    return replace(skeleton, joints=tuple(joints))


def test_each_joint_takes_the_axes_that_are_known_best(performance):
    plain = performance.skeleton
    first = known(plain, left_knee=3.0, left_hip=2.0)
    second = known(plain, left_knee=1.0, left_hip=5.0, neck=9.0)
    bearing, chosen = with_best_axes(plain, [first, second])
    assert chosen == {"left_knee": 1, "left_hip": 0, "neck": 1}
    assert bearing.joint("left_knee").axes_uncertainty == pytest.approx(np.deg2rad(1.0))
    assert_array_equal(bearing.joint("neck").rest, -plain.joint("neck").rest)
    assert_array_equal(bearing.joint("neck").axes, -plain.joint("neck").axes)
    for joint in bearing.joints:
        assert (joint.axes is None) == (joint.name not in chosen)
        assert (joint.rest is None) == (joint.name not in chosen)


def test_the_worst_axis_of_a_joint_counts_and_none_that_is_unknown(performance):
    plain = performance.skeleton
    hip = plain.joint("left_hip")

    def with_hip(*degrees):
        skeleton = known(plain, left_hip=1.0)
        told = replace(skeleton.joint("left_hip"), axes_uncertainty=np.deg2rad(degrees))
        return replace(
            skeleton, joints=tuple(told if j.name == hip.name else j for j in skeleton.joints)
        )

    even, uneven, half = with_hip(3.0, 3.0), with_hip(0.5, 4.0), with_hip(np.nan, 2.0)
    unknown = with_hip(np.nan, np.nan)
    assert with_best_axes(plain, [uneven, even])[1] == {"left_hip": 1}
    assert with_best_axes(plain, [even, half])[1] == {"left_hip": 1}
    assert with_best_axes(plain, [unknown, uneven])[1] == {"left_hip": 1}
    assert with_best_axes(plain, [unknown])[1] == {"left_hip": 0}
    assert with_best_axes(plain, [even, even])[1] == {"left_hip": 0}


def test_what_is_the_same_in_every_recording_does_not_choose(performance):
    """A knee's own trial shows that its twist goes with the angle; a short arc elsewhere cannot."""
    plain = performance.skeleton
    told = {"joints": {"left_knee": {"other_reading_deg": 4.0}}}
    own = known(plain, left_knee=4.2, right_knee=4.2)
    own = replace(own, history=(*own.history, Step("parameterization", findings=told)))
    elsewhere = known(plain, left_knee=2.5, right_knee=2.5)
    bearing, chosen = with_best_axes(plain, [elsewhere, own])
    assert chosen == {"left_knee": 1, "right_knee": 0}  # ±1.3° without it
    assert bearing.joint("left_knee").axes_uncertainty == pytest.approx(np.deg2rad(4.2))


def test_what_was_found_of_the_axes_comes_along(performance):
    plain = performance.skeleton

    def told(doubt):
        joints = {name: {"doubts": [doubt]} for name in plain.joint_names}
        return Step("parameterization", findings={"joints": joints})

    first = replace(known(plain, left_knee=3.0, left_hip=2.0), history=(told("first"),))
    second = replace(known(plain, left_knee=1.0), history=(told("second"), Step("editing")))
    bearing, _ = with_best_axes(plain, [first, second])
    assert bearing.history[-1].findings["joints"] == {
        "left_knee": {"doubts": ["second"]},
        "left_hip": {"doubts": ["first"]},
    }


def test_other_bodies_have_other_joints(performance):
    plain = performance.skeleton
    other = known(plain, left_knee=1.0)
    stranger = replace(
        other,
        joints=tuple(replace(j, name=f"its_{j.name}") for j in other.joints),
    )
    assert with_best_axes(plain, [stranger])[1] == {}
    assert with_best_axes(plain, [stranger, other])[1] == {"left_knee": 1}


def test_one_solution_several_or_none(performance):
    skeleton = performance.skeleton
    assert skeletons_of(None) == ()
    assert skeletons_of(skeleton) == (skeleton,)
    assert skeletons_of([skeleton, skeleton]) == (skeleton, skeleton)
    assert skeletons_of([]) == ()


@pytest.mark.slow
def test_a_trial_for_each_joint(performance):
    whole = solve(performance.recording, performance.model)
    names = whole.skeleton.joint_names

    def only(kind):
        return replace(
            whole.skeleton,
            joints=tuple(
                replace(j, axes_source="movement" if j.name.endswith(kind) else "body")
                for j in whole.skeleton.joints
            ),
        )

    trials = [only("knee"), only("hip")]
    again = solve(performance.recording, performance.model, calibration_from=trials)
    for joint in again.skeleton.joints:
        mine = joint.name.endswith(("knee", "hip"))
        assert (joint.axes_source == "reused") == mine
    step = next(s for s in again.history if s.name == "calibration")
    assert step.findings["axes_from"] == {
        name: 1 if name.endswith("knee") else 2 for name in names if name.endswith(("knee", "hip"))
    }
