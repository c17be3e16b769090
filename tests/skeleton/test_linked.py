"""A limb of two markers between two others: all three are measured together."""

from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose
from scipy.ndimage import gaussian_filter1d

from kinesphere.data import JointModel, Landmark, Recording, Segment, TopologicalModel
from kinesphere.geometry.rigid import into_frame
from kinesphere.geometry.rotations import rotation_exp
from kinesphere.skeleton import fit_skeleton
from kinesphere.skeleton.settings import SkeletonSettings

COUNTS = (4, 2, 4)
FRAMES = 700
JOINTS = np.array([[0.03, -0.09, 0.01], [0.0, -0.27, 0.0]])


def smooth(rng, scale):
    walk = gaussian_filter1d(rng.normal(size=(FRAMES, 3)), 12, axis=0)
    return scale * walk / walk.std(axis=0)


def arm(rng, beside, noise=0.001, hinge=False):
    """Markers (FRAMES, 10, 3) of an arm, and both joints in the world, (2, FRAMES, 3), in m."""
    upper = rng.normal(scale=0.05, size=(4, 3))
    middle = np.array([[beside, -0.05, 0.0], [-beside, -0.22, 0.0]])
    hand = np.array(
        [[0.03, -0.08, 0.0], [-0.03, -0.09, 0.01], [0.0, -0.12, 0.03], [0.0, -0.1, -0.03]]
    )
    first = rotation_exp(smooth(rng, 0.3))
    second = first @ rotation_exp(smooth(rng, 0.5))
    third = second @ rotation_exp(smooth(rng, 0.6) * ([0.0, 0.0, 1.0] if hinge else 1.0))
    elbow = smooth(rng, 0.1) + first @ JOINTS[0]
    wrist = elbow + second @ JOINTS[1]
    parts = [
        (elbow - first @ JOINTS[0])[:, None] + upper @ np.swapaxes(first, 1, 2),
        elbow[:, None] + middle @ np.swapaxes(second, 1, 2),
        wrist[:, None] + hand @ np.swapaxes(third, 1, 2),
    ]
    markers = np.concatenate(parts, axis=1)
    return markers + noise * rng.normal(size=markers.shape), np.array([elbow, wrist])


def model(landmarks=()):
    labels = [f"*{i}" for i in range(sum(COUNTS))]
    at = np.split(labels, np.cumsum(COUNTS)[:-1])
    segments = tuple(Segment(f"limb_{i}", tuple(map(str, own))) for i, own in enumerate(at))
    joints = (
        JointModel("joint_1", "limb_0", "limb_1", landmarks=landmarks),
        JointModel("joint_2", "limb_1", "limb_2"),
    )
    return TopologicalModel("arm", segments, joints, "limb_0")


def solved(markers, tree=None, **settings):
    labels = tuple(f"*{i}" for i in range(sum(COUNTS)))
    recording = Recording(markers=markers, labels=labels, rate=120.0)
    return fit_skeleton(recording, tree or model(), SkeletonSettings(**settings))


def wrist_off(motion, truth):
    """How far the wrist is from the truth where the hand carries it, median in m."""
    wrist = motion.skeleton.joint("joint_2").centre_in_child
    found = motion.origins[:, 2] + motion.rotations[:, 2] @ wrist
    return float(np.nanmedian(np.linalg.norm(found - truth[1], axis=1)))


@pytest.mark.parametrize("beside", [0.003, 0.02])
def test_the_joint_beyond_is_found(rng, beside):
    markers, truth = arm(rng, beside)
    assert wrist_off(solved(markers), truth) < 0.0035  # a hand's pose alone is off by that


def wrist_told(motion, truth):
    """How far the wrist is from the truth in the middle limb, and how far it is told to be, m."""
    joint = motion.skeleton.joint("joint_2")
    turns, origins = motion.rotations[:, 1], motion.origins[:, 1]
    true = np.nanmean(into_frame(turns, origins, truth[1][:, None])[:, 0], axis=0)
    off = np.linalg.norm(joint.centre_in_parent - true)
    return float(off), float(np.sqrt(np.trace(joint.covariance)))


def test_along_a_hinge_beyond_little_is_told(rng):
    """Noise in the poses feigns a turn about the other axes, and with it a centre."""
    for draw in rng.spawn(3):
        markers, truth = arm(draw, 0.02, hinge=True)
        off, told = wrist_told(solved(markers), truth)
        assert off < 2 * told
        markers, truth = arm(draw, 0.02)
        assert told > 5 * wrist_told(solved(markers), truth)[1]


def test_limb_by_limb_a_line_leads_astray(rng):
    markers, truth = arm(rng, 0.003)
    alone = solved(markers, link_limbs=False)
    assert wrist_off(solved(markers), truth) <= wrist_off(alone, truth)


def test_both_limbs_have_the_joint_in_the_same_place(rng):
    motion = solved(arm(rng, 0.02, noise=1e-6)[0])
    for number, joint in enumerate(motion.skeleton.joints):
        by_parent = motion.origins[:, number] + motion.rotations[:, number] @ joint.centre_in_parent
        above = number + 1
        by_child = motion.origins[:, above] + motion.rotations[:, above] @ joint.centre_in_child
        assert_allclose(by_parent, by_child, atol=2e-4)


def test_a_landmark_keeps_limbs_to_themselves(rng):
    markers, _ = arm(rng, 0.02)
    told = model((Landmark(weights={"*3": 1.0}, spread=0.02, source="somebody's measures"),))
    linked, alone = solved(markers, told), solved(markers, told, link_limbs=False)
    assert_allclose(linked.origins, alone.origins, rtol=0, atol=0)


def test_hidden_markers_are_posed_the_old_way(rng):
    markers, _ = arm(rng, 0.02)
    markers[300:320, 6:] = np.nan
    motion = solved(markers)
    assert np.isfinite(motion.rotations[:, 1]).all()


def with_a_stranger(rng):
    """Return an arm's markers and, hung from its middle by a doubtful joint, three more."""
    markers, truth = arm(rng, 0.02)
    plate = np.array([[0.05, 0.0, 0.0], [-0.05, 0.0, 0.03], [0.0, 0.08, 0.0]])
    turns = np.swapaxes(rotation_exp(smooth(rng, 0.5)), 1, 2)
    away = truth[0] + [0.1, -0.15, 0.0] + smooth(rng, 0.03)
    return np.concatenate([markers, away[:, None] + plate @ turns], axis=1), truth


def hung(doubtful, limb="limb_1"):
    arms = model()
    own = tuple(f"*{sum(COUNTS) + i}" for i in range(3))
    joint = JointModel("joint_3", limb, "stranger", doubtful=doubtful)
    segments = (*arms.segments, Segment("stranger", own))
    return TopologicalModel("arm", segments, (*arms.joints, joint), arms.root)


def of_all(markers, tree):
    labels = tuple(f"*{i}" for i in range(markers.shape[1]))
    return fit_skeleton(Recording(markers=markers, labels=labels, rate=120.0), tree)


def test_a_limb_that_may_hang_elsewhere_bends_none_beside_it(rng):
    markers, truth = with_a_stranger(rng)
    alone = solved(markers[:, : sum(COUNTS)])
    beside = of_all(markers, hung(doubtful=True))
    for name in ("joint_1", "joint_2"):
        one, other = alone.skeleton.joint(name), beside.skeleton.joint(name)
        for end in ("centre_in_parent", "centre_in_child"):
            off, there = (np.linalg.norm(getattr(joint, end)) for joint in (one, other))
            assert_allclose(off, there, atol=5e-4)
    assert wrist_off(beside, truth) < 0.0035


def doubting(*numbers):
    joints = [replace(j, doubtful=i in numbers) for i, j in enumerate(model().joints)]
    return replace(model(), joints=tuple(joints))


def test_where_all_joints_are_doubtful_none_is_kept_apart_for_it(rng):
    markers, truth = arm(rng, 0.003)
    sure, doubted = solved(markers), solved(markers, doubting(0, 1))
    assert_allclose(doubted.origins, sure.origins, rtol=0, atol=0)
    assert wrist_off(doubted, truth) < wrist_off(solved(markers, link_limbs=False), truth)


@pytest.mark.parametrize("doubtful", [0, 1])
def test_a_sure_joint_is_in_no_group_with_a_doubtful_one(rng, doubtful):
    markers, _ = arm(rng, 0.02)
    linked = solved(markers, doubting(doubtful))
    alone = solved(markers, link_limbs=False)
    assert_allclose(linked.origins, alone.origins, rtol=0, atol=0)
