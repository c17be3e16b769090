"""Limbs without names: one recording's number says nothing in another, its markers do."""

from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose

from kinesphere.data import Skeleton, Step
from kinesphere.pipeline import solve
from kinesphere.pipeline.best_axes import Calibrated, with_best_axes
from kinesphere.pipeline.numbered import as_numbered_in
from kinesphere.synthetic import make_performance

LEGS = ("trunk", "left_thigh", "left_shank", "right_thigh", "right_shank")


@pytest.fixture(scope="module")
def performance():
    return make_performance(np.random.default_rng(5), rate=12.0, free_s=0.0)


def numbered(skeleton, *names):
    """Return some limbs, root first, called and their joints counted in this order."""
    limbs = {name: f"limb_{k:02d}" for k, name in enumerate(names, start=1)}
    joints = {j.child: j for j in skeleton.joints}
    counted, doubts = [], {}
    for k, name in enumerate(names[1:], start=1):
        joint = joints[name]
        doubts[f"joint_{k:02d}"] = {"doubts": [f"of {joint.name}"]}
        counted.append(
            replace(
                joint,
                name=f"joint_{k:02d}",
                parent=limbs[joint.parent],
                child=limbs[name],
                axes_source="movement",
                axes_uncertainty=np.full(joint.n_axes, 0.01),
            )
        )
    bodies = tuple(
        replace(skeleton.limb(name), name=limbs[name], parent=limbs.get(skeleton.limb(name).parent))
        for name in names
    )
    return Skeleton(
        bodies, tuple(counted), (Step("parameterization", findings={"joints": doubts}),)
    )


def test_joints_are_matched_by_the_markers_of_both_limbs(performance):
    plain = performance.skeleton
    here = numbered(plain, *LEGS)
    there = numbered(plain, "trunk", "right_thigh", "right_shank", "left_thigh", "left_shank")
    source, matched, unmatched = as_numbered_in(here, Calibrated("t", there))
    assert matched == {
        "joint_01": "joint_03",
        "joint_02": "joint_04",
        "joint_03": "joint_01",
        "joint_04": "joint_02",
    }
    assert unmatched == {}
    bearing, _ = with_best_axes(here, [source])
    found = bearing.history[-1].findings["joints"]
    for joint, name in zip(
        bearing.joints, ("left_hip", "left_knee", "right_hip", "right_knee"), strict=True
    ):
        assert_allclose(joint.axes, plain.joint(name).axes, atol=1e-9)
        assert_allclose(joint.rest, plain.joint(name).rest, atol=1e-9)
        assert found[joint.name]["doubts"] == [f"of {name}"]
    # by number alone the left leg would have the right one's axes
    wrong, _ = with_best_axes(here, [Calibrated("t", there)])
    assert not np.allclose(wrong.joints[1].axes, bearing.joints[1].axes, atol=0.01)


def less(skeleton, limb, keep):
    """Return a skeleton of whose limb's markers the first few are the same, the others new."""
    limbs = tuple(
        replace(one, markers=tuple(m if i < keep else f"new{i}" for i, m in enumerate(one.markers)))
        if one.name == limb
        else one
        for one in skeleton.limbs
    )
    return replace(skeleton, limbs=limbs)


def test_what_is_nowhere_here_is_not_reused_and_said(performance):
    here = numbered(performance.skeleton, *LEGS)
    n = len(here.limb("limb_03").markers)
    half = less(here, "limb_03", n // 2)
    source, matched, unmatched = as_numbered_in(here, Calibrated("t", half))
    assert unmatched == {
        "joint_02": "no limb here shares most of its markers with limb_03",
    }
    assert set(matched) == {"joint_01", "joint_03", "joint_04"}
    bearing, _ = with_best_axes(here, [source])
    assert bearing.joint("joint_02").axes is None
    assert bearing.joint("joint_01").axes is not None
    # both limbs are here, but another joint is between them
    moved = performance.skeleton.joint("right_hip")
    trunk = tuple(
        replace(one, parent="limb_02") if one.name == "limb_04" else one for one in here.limbs
    )
    joints = tuple(
        replace(one, parent="limb_02") if one.child == "limb_04" else one for one in here.joints
    )
    other = replace(here, limbs=trunk, joints=joints)
    _, _, unmatched = as_numbered_in(here, Calibrated("t", other))
    assert unmatched == {"joint_03": "nothing joins limb_02 to limb_04 here"}
    assert moved.parent == "trunk"


def test_points_that_nobody_named_and_pairs_of_markers_match_nothing(performance):
    here = numbered(performance.skeleton, *LEGS)

    def called(prefix):
        return replace(
            here,
            limbs=tuple(
                replace(
                    one, markers=tuple(f"{prefix}{one.name}{i}" for i in range(len(one.markers)))
                )
                for one in here.limbs
            ),
        )

    assert as_numbered_in(called("m"), Calibrated("t", called("m")))[2] == {}
    stars = called("*")
    assert len(as_numbered_in(stars, Calibrated("t", stars))[2]) == 4
    pair = replace(
        here,
        limbs=tuple(
            replace(one, markers=one.markers[:2], marker_positions=one.marker_positions[:2])
            if one.name == "limb_03"
            else one
            for one in here.limbs
        ),
    )
    shaken = replace(
        pair,
        limbs=tuple(
            replace(one, marker_positions=one.marker_positions + 1e-3 * (i == 2))
            for i, one in enumerate(pair.limbs)
        ),
    )
    _, _, unmatched = as_numbered_in(pair, Calibrated("t", shaken))
    assert unmatched == {
        "joint_02": "nothing tells how the frame of limb_03 lies here: "
        "fewer than three markers in both"
    }


def test_names_stay_as_they_are(performance):
    plain = performance.skeleton
    source = Calibrated("t", plain)
    assert as_numbered_in(plain, source) == (source, {}, {})
    here = numbered(plain, *LEGS)
    _, matched, unmatched = as_numbered_in(plain, Calibrated("t", here))
    assert matched == {}
    assert len(unmatched) == 4


@pytest.mark.slow
def test_through_the_line_it_is_said(performance):
    whole = solve(performance.recording, performance.model)
    stranger = numbered(performance.skeleton, *LEGS)
    again = solve(performance.recording, performance.model, calibration_from=stranger)
    (said,) = (w for w in again.warnings if "joints without a name" in w)
    assert "joint_02 of recording 1 (no limb here" in said
    for joint, own in zip(again.skeleton.joints, whole.skeleton.joints, strict=True):
        assert_allclose(joint.axes, own.axes)
