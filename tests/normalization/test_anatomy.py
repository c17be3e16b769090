"""Where limbs begin, end and point; how large a body is."""

from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose

from kinesphere.data import Limb, Skeleton
from kinesphere.errors import DegenerateMotion
from kinesphere.normalization import normalize
from kinesphere.normalization.anatomy import Anatomy
from kinesphere.normalization.limb_lines import far_end, main_direction, middle_of_markers

EXACT = 1e-12
NONE = np.empty((0, 3))


def limb(markers, *, length=np.nan, long_axis=(0.0, 0.0, 1.0), name="right_hand"):
    markers = np.array(markers, float).reshape(-1, 3)
    labels = tuple(f"m{i}" for i in range(len(markers)))
    return Limb(name, "right_forearm", labels, markers, length, np.array(long_axis))


def test_joint_to_joint_counts_before_markers(rng):
    begin, end = rng.normal(size=(2, 3))
    found = main_direction(limb(rng.normal(size=(4, 3))), begin, end[None], foot=False)
    assert_allclose(found, (end - begin) / np.linalg.norm(end - begin), atol=EXACT)


def test_joints_in_one_place_have_no_direction_but_rounding():
    begin = np.array([0.1, 0.2, 0.3])
    for apart, known in ((1e-5, True), (1e-7, False)):
        end = begin + np.array([0.0, -apart, 0.0])
        found = main_direction(limb(NONE), begin, end[None], foot=False)
        assert np.isfinite(found).all() == known


def test_several_joints_give_their_principal_direction(rng):
    along = np.array([0.6, 0.0, 0.8])
    carried = np.outer([1.0, 2.0, 3.0], along) + 0.01 * rng.normal(size=(3, 3))
    found = main_direction(limb(NONE), np.zeros(3), carried, foot=False)
    assert found @ along > 0.999
    assert main_direction(limb(NONE), np.zeros(3), -carried, foot=False) @ along < -0.999


def test_a_chain_ends_amid_its_markers(rng):
    markers = rng.normal(loc=[4.0, 0.0, 0.0], size=(5, 3))
    markers[2] = np.nan
    wanted = np.nanmean(markers, axis=0) - [1.0, 0.0, 0.0]
    found = main_direction(limb(markers), np.array([1.0, 0.0, 0.0]), NONE, foot=False)
    assert_allclose(found, wanted / np.linalg.norm(wanted), atol=EXACT)


def test_markers_around_the_joint_give_where_they_spread():
    markers = [[0.1, 0, 0], [-0.1, 0, 0], [0, 0.02, 0], [0, -0.02, 0]]
    found = main_direction(limb(markers), np.zeros(3), NONE, foot=False)
    assert_allclose(np.abs(found), [1.0, 0.0, 0.0], atol=EXACT)


def test_without_markers_the_long_axis_counts():
    assert_allclose(main_direction(limb(NONE), np.zeros(3), NONE, foot=False), [0, 0, 1])


def test_a_foot_points_from_heel_to_toes():
    """Heel, toe and fifth toe of a real foot; its ankle lies above them."""
    ankle, level = np.array([0.0, 0.06, 0.0]), 15.0
    markers = [[-0.06, 0.02, 0.0], [0.13, 0.03, -0.01], [0.10, 0.01, 0.04]]
    foot = main_direction(limb(markers), ankle, NONE, foot=True)
    hand = main_direction(limb(markers), ankle, NONE, foot=False)
    assert abs(np.rad2deg(np.arcsin(foot[1]))) < level < abs(np.rad2deg(np.arcsin(hand[1])))
    assert foot[0] > 0.9


def test_markers_that_lie_in_no_row_are_taken_together():
    markers = [[0.05, -0.05, 0.05], [0.05, -0.05, -0.05], [0.05, 0.05, 0.05], [0.05, 0.05, -0.05]]
    found = main_direction(limb(markers), np.zeros(3), NONE, foot=True)
    assert_allclose(found, [1.0, 0.0, 0.0], atol=EXACT)


def test_a_far_end_is_as_far_as_the_length_or_the_markers():
    it = limb([[0.0, -0.3, 0.1], [0.0, -0.1, 0.0]])
    begin, along = np.array([0.0, 0.1, 0.0]), np.array([0.0, -1.0, 0.0])
    assert_allclose(far_end(it, begin, along), [0.0, -0.3, 0.0])
    assert_allclose(far_end(replace(it, length=0.7), begin, along), [0.0, -0.6, 0.0])
    assert np.isnan(middle_of_markers(limb(NONE))).all()


def test_joints_are_known_by_their_limbs(doll):
    anatomy = Anatomy(doll().motion.skeleton)
    names = anatomy.skeleton.joint_names
    assert names[anatomy.joints["left_knee"]] == "joint_of_left_shank"
    assert names[anatomy.joints["neck"]] == "joint_of_head"
    assert names[anatomy.joints["lumbar"]] == "joint_of_trunk"
    assert set(anatomy.pairs) == {"shoulder", "hip"}
    assert anatomy.body_limbs == (0, 1)


@pytest.mark.parametrize("scale", [1.0, 2.5])
def test_the_span_is_the_longest_way_through_the_bones(scale, doll, tools):
    """From the tip of the one foot over the hips to the tip of a hand, whatever the pose."""
    bent = {"left_shank": np.full((7, 3), 0.5), "right_forearm": np.full((7, 3), 0.9)}
    leg = 0.42 + 0.41 + 0.20
    arm = 0.30 + 0.26 + 0.15
    lumbar = np.array([0.0, 0.12, 0.0])
    shoulder = np.linalg.norm(np.array([0.0, 0.46, 0.18]) - lumbar)
    hip = np.linalg.norm(np.array([0.0, 0.0, 0.09]) - lumbar)
    span = Anatomy(doll(scale=scale, bends=bent).motion.skeleton).span
    assert span == pytest.approx(scale * (leg + hip + shoulder + arm), rel=1e-9)


def test_one_limb_has_no_span(doll):
    lonely = Skeleton(
        (replace(doll(("pelvis",)).motion.skeleton.limbs[0], markers=(), marker_positions=NONE),),
        (),
    )
    assert np.isnan(Anatomy(lonely).span)


def test_a_leg_may_be_all_there_is(doll, tools):
    plan = tools.plan | {"left_thigh": (None, (0.0, 0.0, -0.09), 0.42, (0, -1, 0))}
    it = doll(("left_thigh", "left_shank", "left_foot"), plan=plan, stance={})
    result = normalize(it.motion, facing="+x")
    assert_allclose(result.rotations, it.truth, atol=1e-9)
    assert_allclose(result.skeleton.limbs[0].long_axis, [0, -1, 0], atol=1e-9)


def test_no_frames_are_refused(doll):
    motion = doll().motion
    empty = replace(
        motion,
        rotations=motion.rotations[:0],
        origins=motion.origins[:0],
        residuals=motion.residuals[:0],
        flags=motion.flags[:0],
    )
    with pytest.raises(DegenerateMotion, match="no frame"):
        normalize(empty)
