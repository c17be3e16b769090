"""Axes from several recordings of one person: each from where it is known best."""

from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal

from kinesphere.data import Step
from kinesphere.errors import BadSetting
from kinesphere.geometry.rotations import rotation_about
from kinesphere.parameterization import AxesSettings, ParameterizationSettings
from kinesphere.pipeline import Settings, solve
from kinesphere.pipeline.best_axes import Calibrated, with_best_axes
from kinesphere.pipeline.reuse import calibrated, check_reuse
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


def best(skeleton, *sources):
    """Return what serves of skeletons named ``a``, ``b``, …, and what is from where."""
    named = [Calibrated("abc"[i], source) for i, source in enumerate(sources)]
    bearing, said = with_best_axes(skeleton, named)
    turned, again = with_best_axes(skeleton, named[::-1])
    assert said == again
    for joint, same in zip(bearing.joints, turned.joints, strict=True):
        assert joint.axes_reused_from == same.axes_reused_from
        for mine, its in ((joint.axes, same.axes), (joint.rest, same.rest)):
            assert_array_equal(mine, its)
    return bearing, {j.name: "".join(j.axes_reused_from) for j in bearing.joints if j.n_axes}


def with_hip(plain, *degrees, turn=None, **changes):
    """Return a skeleton with nothing but a left hip of such axes, deg, turned about the limb."""
    skeleton = known(plain, left_hip=1.0)
    told = replace(skeleton.joint("left_hip"), axes_uncertainty=np.deg2rad(degrees), **changes)
    if turn is not None:
        told = replace(told, axes=told.axes @ rotation_about(np.eye(3)[1], turn).T)
    return replace(skeleton, joints=tuple(told if j.name == told.name else j for j in plain.joints))


def test_each_joint_takes_the_axes_that_are_known_best(performance):
    plain = performance.skeleton
    first = known(plain, left_knee=3.0, left_hip=2.0)
    second = known(plain, left_knee=1.0, left_hip=5.0, neck=9.0)
    bearing, chosen = best(plain, first, second)
    assert chosen == {"left_knee": "b", "left_hip": "aa", "neck": "bb"}
    assert bearing.joint("left_knee").axes_uncertainty == pytest.approx(np.deg2rad(1.0))
    assert_array_equal(bearing.joint("neck").rest, -plain.joint("neck").rest)
    assert_array_equal(bearing.joint("neck").axes, -plain.joint("neck").axes)
    for joint in bearing.joints:
        assert (joint.axes is None) == (joint.name not in chosen)
        assert (joint.rest is None) == (joint.name not in chosen)


def test_each_axis_is_from_where_it_is_known_best(performance):
    plain = known(performance.skeleton)
    of_a, of_b = with_hip(plain, 3.0, 6.0), with_hip(plain, 9.0, 2.0)
    bearing, chosen = best(plain, of_a, of_b)
    assert chosen == {"left_hip": "ab"}
    hip = bearing.joint("left_hip")
    assert hip.axes_uncertainty == pytest.approx(np.deg2rad([3.0, 2.0]), abs=1e-6)
    # a distal axis stays with the rest orientation about which it was seen
    assert best(plain, with_hip(plain, 9.0, 2.0), of_a)[1] == {"left_hip": "ba"}
    assert best(plain, with_hip(plain, 3.0, 3.0), with_hip(plain, np.nan, 2.0))[1] == {
        "left_hip": "bb"
    }
    assert best(plain, with_hip(plain, np.nan, np.nan), with_hip(plain, 0.5, 4.0))[1] == {
        "left_hip": "bb"
    }
    assert best(plain, with_hip(plain, np.nan, np.nan))[1] == {"left_hip": "aa"}
    assert best(plain, with_hip(plain, 3.0, 3.0), with_hip(plain, 3.0, 3.0))[1] == {
        "left_hip": "aa"
    }


def test_halves_of_a_joint_become_a_whole_one(performance):
    plain = known(performance.skeleton)
    distal = with_hip(plain, 4.0, np.nan, axes_assumed=(False, True))
    proximal = with_hip(plain, np.nan, 3.0, axes_assumed=(True, False), turn=0.3)
    bearing, chosen = best(plain, proximal, distal)
    assert chosen == {"left_hip": "ba"}
    hip, told = bearing.joint("left_hip"), proximal.joint("left_hip")
    assert hip.axes_assumed == ()
    assert hip.axes_sources == ("movement", "movement")
    assert_array_equal(hip.axes[0], distal.joint("left_hip").axes[0])
    assert_allclose(hip.axes[1], told.axes[1], atol=1e-12)
    assert best(plain, distal, distal)[0].joint("left_hip").axes_assumed == (False, True)
    # two axes that are nearly one do not make a joint
    near = replace(told, axes=np.array([told.axes[0], distal.joint("left_hip").axes[0]]))
    joints = tuple(near if j.name == "left_hip" else j for j in proximal.joints)
    assert best(plain, distal, replace(proximal, joints=joints))[1]["left_hip"] in ("a", "b")


def test_axes_are_turned_by_the_markers_not_by_the_default_position(performance):
    """The pelvis of one trial's default position is 20° off; its markers are where they were."""
    plain = known(performance.skeleton)
    distal = with_hip(plain, 4.0, np.nan, axes_assumed=(False, True))
    proximal = with_hip(plain, np.nan, 3.0, axes_assumed=(True, False))
    off = rotation_about(np.array([0.6, 0.0, 0.8]), np.deg2rad(20.0))
    root = plain.limbs[0]
    tilted = replace(root, marker_positions=root.marker_positions @ off.T)
    hip = proximal.joint("left_hip")
    seen = replace(hip, axes=hip.axes @ off.T)
    proximal = replace(
        proximal,
        limbs=(tilted, *plain.limbs[1:]),
        joints=tuple(seen if j.name == hip.name else j for j in proximal.joints),
    )
    bearing, _ = best(plain, distal, proximal)
    assert_allclose(bearing.joint("left_hip").axes[1], hip.axes[1], atol=1e-9)
    # markers that were put on anew say nothing; then frames of one name are the same
    anew = replace(tilted, markers=tuple(f"new{m}" for m in tilted.markers))
    proximal = replace(proximal, limbs=(anew, *plain.limbs[1:]))
    found = best(plain, distal, proximal)[0].joint("left_hip")
    assert_allclose(found.axes[1], seen.axes[1], atol=1e-12)
    assert found.axes_uncertainty[1] == pytest.approx(np.deg2rad(5.0))  # 3 and 4 between frames


def test_what_is_doubted_gives_way(performance):
    plain = known(performance.skeleton)
    step = Step("parameterization", findings={"joints": {"left_hip": {"doubts": ["halves"]}}})
    doubtful = replace(with_hip(plain, 1.0, 1.0), history=(step,))
    sure = with_hip(plain, 4.0, 5.0)
    assert best(plain, doubtful, sure)[1] == {"left_hip": "bb"}
    half = with_hip(plain, 4.0, np.nan, axes_assumed=(False, True))
    bearing, chosen = best(plain, doubtful, half)
    assert chosen == {"left_hip": "ba"}  # but before what nobody told
    found = bearing.history[-1].findings["joints"]["left_hip"]
    assert found["doubts"] == ["axis 2: halves"]
    assert best(plain, doubtful, replace(bearing, history=bearing.history))[1] == {"left_hip": "bb"}


def test_contradictions_are_told_not_averaged(performance):
    plain = known(performance.skeleton)

    def told(degrees, *sure, **changes):
        far = with_hip(plain, *sure, turn=np.deg2rad(degrees), **changes)
        named = [Calibrated("first", with_hip(plain, 3.0, 3.0)), Calibrated("second", far)]
        bearing, said = with_best_axes(plain, named)
        assert_array_equal(bearing.joint("left_hip").axes, named[0].skeleton.joint("left_hip").axes)
        return said

    assert told(5.0, 4.0, 4.0) == ()
    (clause,) = told(25.0, 4.0, 4.0)
    assert clause.startswith("left_hip (axis 1: ")
    assert "° between first, which serves, and second" in clause
    assert told(25.0, 40.0, 40.0) == ()  # the other does not claim to know
    assert "axis 1" not in told(25.0, 4.0, 4.0, axes_assumed=(True, False))[0]


def test_what_is_the_same_in_every_recording_does_not_choose(performance):
    """A knee's own trial shows that its twist goes with the angle; a short arc elsewhere cannot."""
    plain = performance.skeleton
    told = {"joints": {"left_knee": {"other_reading_deg": 4.0}}}
    own = known(plain, left_knee=4.2, right_knee=4.2)
    own = replace(own, history=(*own.history, Step("parameterization", findings=told)))
    elsewhere = known(plain, left_knee=2.5, right_knee=2.5)
    bearing, chosen = best(plain, elsewhere, own)
    assert chosen == {"left_knee": "b", "right_knee": "a"}  # ±1.3° without it
    assert bearing.joint("left_knee").axes_uncertainty == pytest.approx(np.deg2rad(4.2))


def test_what_was_found_of_the_axes_comes_along(performance):
    plain = performance.skeleton

    def told(*doubts):
        joints = {name: {"doubts": list(doubts)} for name in plain.joint_names}
        return Step("parameterization", findings={"joints": joints})

    first = replace(known(plain, left_knee=3.0, left_hip=2.0), history=(told("first"),))
    second = replace(known(plain, left_knee=1.0), history=(told("second"), Step("editing")))
    bearing, _ = best(plain, first, second)
    found = bearing.history[-1].findings["joints"]
    assert {name: row["doubts"] for name, row in found.items()} == {
        "left_knee": ["second"],
        "left_hip": ["first"],
    }


def test_other_bodies_have_other_joints(performance):
    plain = performance.skeleton
    other = known(plain, left_knee=1.0)
    stranger = replace(
        other,
        joints=tuple(replace(j, name=f"its_{j.name}") for j in other.joints),
    )
    assert best(plain, stranger)[1] == {}
    assert best(plain, stranger, other)[1] == {"left_knee": "b"}


def test_one_solution_several_or_none(performance):
    skeleton = performance.skeleton
    assert calibrated(None) == calibrated([]) == ()
    assert calibrated(skeleton) == (("recording 1", skeleton),)
    assert calibrated([skeleton, skeleton])[1] == ("recording 2", skeleton)
    assert calibrated({"knee": skeleton}) == (("knee", skeleton),)


def test_the_bodys_axes_and_those_of_another_recording_exclude_each_other(performance):
    skeleton = performance.skeleton
    of_body = ParameterizationSettings(axes=AxesSettings(method="body"))
    check_reuse(of_body, None)
    check_reuse(of_body, [])
    check_reuse(ParameterizationSettings(), skeleton)
    with pytest.raises(BadSetting, match=r"axes\.method is 'body'"):
        solve(
            performance.recording,
            calibration_from=skeleton,
            settings=Settings(parameterization=of_body),
        )


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
        name: {"axis_1": "recording 1"}
        if name.endswith("knee")
        else {"axis_1": "recording 2", "axis_2": "recording 2"}
        for name in names
        if name.endswith(("knee", "hip"))
    }
