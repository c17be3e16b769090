"""Front and back: who says so, and who is overruled aloud."""

from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose
from scipy.spatial.transform import Rotation

from kinesphere.data import Skeleton
from kinesphere.errors import AmbiguousFacing, DegenerateMotion
from kinesphere.normalization import NormalizationSettings, normalize
from kinesphere.normalization.body_frame import face_the_same_way, lateral_frames, plane_frames

AWAY = np.diag([-1.0, 1.0, -1.0])
FLEX_KNEE = np.array([0.0, 0.0, -1.0])  # shank backward
FLEX_ELBOW = np.array([0.0, 0.0, 1.0])  # forearm forward


def front(motion):
    return motion.rotations[0, 0][:, 0]


def without(tools, *endings):
    return tuple(name for name in tools.plan if not name.endswith(endings))


def upright(tools):
    return {name: (0, -1, 0) for name in tools.stance if "foot" not in name}


def test_feet_tell(doll, tools):
    motion = tools.renamed(doll(n_frames=5).motion)
    result = normalize(motion)
    assert front(result) @ [1, 0, 0] > 0.99
    assert result.history[-1].findings["facing"]["scores"]["feet"] > 0.95


def test_knees_tell_only_when_flexed(doll, tools):
    names = without(tools, "foot", "hand", "forearm")
    turns = np.linspace(0, 1.4, 30)[:, None]
    bends = {"left_shank": turns * FLEX_KNEE, "right_shank": 0.1 * turns * -FLEX_KNEE}
    it = doll(names, n_frames=30, stance=upright(tools), bends=bends)
    result = normalize(it.motion)
    scores = result.history[-1].findings["facing"]["scores"]
    assert scores["knees"] == pytest.approx(1.0, abs=1e-6)
    still = normalize(doll(names, stance=upright(tools)).motion)
    assert "knees" not in still.history[-1].findings["facing"]["scores"]


def test_elbows_tell(doll, tools):
    turns = np.linspace(0, 1.4, 30)[:, None]
    bends = {f"{side}_forearm": turns * FLEX_ELBOW for side in ("left", "right")}
    it = doll(without(tools, "foot", "hand"), n_frames=30, stance=upright(tools), bends=bends)
    result = normalize(it.motion)
    scores = result.history[-1].findings["facing"]["scores"]
    assert scores["elbows"] == pytest.approx(1.0, abs=1e-6)
    believed = normalize(it.motion, facing="elbows")
    assert believed.history[-1].findings["facing"]["decided_by"] == "elbows"


def test_the_walk_tells_people_without_feet(doll, tools):
    walk = np.outer(np.linspace(0, 3, 80), [1.0, 2.0, 0.0])  # up some stairs
    names = without(tools, "foot", "hand")
    it = doll(names, n_frames=80, stance=upright(tools), walk=walk)
    result = normalize(tools.renamed(it.motion))
    found = result.history[-1].findings["facing"]
    assert found["decided_by"] == "walking"
    assert found["scores"]["walking"] > 0.99
    assert front(result) @ [1, 0, 0] > 0.99


def doubts(result):
    return [said for said in result.history[-1].warnings if "front from back" in said]


def test_a_front_that_hangs_on_little_is_doubted(doll, tools):
    """The walk alone, which may be backwards; or witnesses that hardly agree."""
    walk = np.outer(np.linspace(0, 3, 80), [1.0, 0.0, 0.0])
    legs = without(tools, "foot", "hand")
    (said,) = doubts(
        normalize(tools.renamed(doll(legs, n_frames=80, stance=upright(tools), walk=walk).motion))
    )
    assert said.startswith("the walk alone tells")
    assert "--facing" in said
    both = doll(n_frames=80, walk=-walk).motion
    (said,) = doubts(normalize(tools.renamed(both)))
    assert said.startswith("little tells")
    assert not doubts(normalize(tools.renamed(doll(n_frames=80, walk=walk).motion)))
    assert not doubts(normalize(tools.renamed(doll(n_frames=80).motion)))
    assert not doubts(normalize(tools.renamed(both), facing="+x"))
    assert not doubts(normalize(both))  # named


def test_feet_outvote_somebody_who_walks_backwards(doll, tools):
    walk = np.outer(np.linspace(0, -3, 80), [1.0, 0.0, 0.0])
    result = normalize(tools.renamed(doll(n_frames=80, walk=walk).motion))
    found = result.history[-1].findings["facing"]
    assert found["scores"]["walking"] < -0.9
    assert front(result) @ [1, 0, 0] > 0.99


def swapped(motion):
    """Exchange the names of left and right, and nothing else."""

    def other(name):
        if name is None or "_" not in name:
            return name
        side, rest = name.split("_", 1)
        return {"left": "right", "right": "left"}[side] + "_" + rest

    limbs = tuple(
        replace(x, name=other(x.name), parent=other(x.parent)) for x in motion.skeleton.limbs
    )
    joints = tuple(
        replace(j, parent=other(j.parent), child=other(j.child)) for j in motion.skeleton.joints
    )
    return replace(motion, skeleton=Skeleton(limbs, joints))


def test_swapped_labels_are_followed_aloud(doll):
    result = normalize(swapped(doll().motion))
    step = result.history[-1]
    assert step.findings["facing"]["decided_by"] == "names"
    assert_allclose(front(result), [-1, 0, 0], atol=1e-9)
    assert any("swapped, or the data mirrored" in warning for warning in step.warnings)


@pytest.mark.parametrize(("facing", "sign"), [("-x", -1), ("+x", 1)])
def test_the_user_has_the_last_word(facing, sign, doll):
    result = normalize(doll().motion, facing=facing)
    assert_allclose(front(result), [sign, 0, 0], atol=1e-9)
    warned = any("contradicts the names" in w for w in result.history[-1].warnings)
    assert warned == (sign < 0)


@pytest.mark.parametrize(("facing", "contradicts"), [("-x", True), ("+x", False)])
def test_who_is_overruled_is_said(facing, contradicts, doll, tools):
    result = normalize(tools.renamed(doll().motion), facing=facing)
    warnings = result.history[-1].warnings
    assert any("contradicts the body (feet" in w for w in warnings) == contradicts


@pytest.mark.parametrize(("turned_out_deg", "contradicts"), [(60.0, True), (80.0, False)])
def test_feet_turned_far_out_say_little(turned_out_deg, contradicts, doll, tools):
    ahead, aside = np.cos(np.deg2rad(turned_out_deg)), np.sin(np.deg2rad(turned_out_deg))
    feet = {"left_foot": (ahead, 0.0, -aside), "right_foot": (ahead, 0.0, aside)}
    result = normalize(tools.renamed(doll(stance=tools.stance | feet).motion), facing="-x")
    assert any("contradicts" in w for w in result.history[-1].warnings) == contradicts


def test_level_hands_are_no_feet(doll, tools):
    back = {f"{side}_hand": (-1.0, -0.1, 0.0) for side in ("left", "right")}
    result = normalize(tools.renamed(doll(stance=tools.stance | back).motion))
    assert result.history[-1].findings["facing"]["scores"]["feet"] > 0.95


def test_hips_alone_serve_where_shoulders_are_never_seen(doll, tools):
    it = doll()
    motion = it.motion
    for name in ("trunk", "left_upper_arm", "right_upper_arm"):
        motion = tools.hidden(motion, name, slice(None))
    result = normalize(motion)
    assert_allclose(result.rotations[:, 0], it.truth[:, 0], atol=1e-9)


def test_too_few_joints_at_a_time_are_no_plane(doll, tools):
    motion = doll().motion
    for name in motion.skeleton.limb_names:
        if name != "pelvis":  # which carries three
            motion = tools.hidden(motion, name, slice(None))
    with pytest.raises(DegenerateMotion, match="four joints in one frame"):
        normalize(tools.renamed(motion))


def test_a_direction_across_the_front_is_refused(doll):
    with pytest.raises(AmbiguousFacing, match=r"\+z lies across"):
        normalize(doll().motion, facing="+z")


def test_witnesses_that_are_not_there_are_named(doll, tools):
    with pytest.raises(AmbiguousFacing, match="no front from the knees; what tells: feet"):
        normalize(doll().motion, facing="knees")
    with pytest.raises(AmbiguousFacing, match="no name tells left from right"):
        normalize(tools.renamed(doll().motion), facing="names")


@pytest.mark.parametrize("missing", ["left", "right"])
def test_half_a_body_is_told_by_its_side(missing, doll, tools):
    names = tuple(n for n in tools.plan if missing not in n and "foot" not in n)
    it = doll(names)
    result = normalize(it.motion)
    found = result.history[-1].findings
    assert found["body_frame"] == "plane"
    assert found["facing"]["decided_by"] == "names"
    assert front(result) @ [1, 0, 0] > 0.9


def test_lateral_frames_hold_the_lateral_axis_and_lean_on_the_vertical(rng):
    across, upward = rng.normal(size=(2, 9, 3))
    across[4], upward[6] = np.nan, 2 * across[6]
    frames = lateral_frames(across, upward)
    good = np.delete(np.arange(9), [4, 6])
    assert np.isnan(frames[[4, 6]]).all()
    assert_allclose(
        frames[good, :, 2], across[good] / np.linalg.norm(across[good], axis=1)[:, None]
    )
    assert ((frames[good, :, 1] * upward[good]).sum(axis=1) > 0).all()
    assert_allclose((frames[good, :, 0] * upward[good]).sum(axis=1), 0.0, atol=1e-12)
    assert_allclose(np.linalg.det(frames[good]), 1.0)


SHOULDERS_HIPS = np.array([[0, 0.25, -0.18], [0, 0.25, 0.18], [0, -0.25, -0.09], [0, -0.25, 0.09]])
"""m, left and right shoulder, left and right hip of a body with equal sides."""


def lines(joints):
    """Return what runs across and along trunks of four joints each, (n, 4, 3) → (n, 3) twice."""
    left, right = joints[:, [0, 2]], joints[:, [1, 3]]
    middles = (left + right) / 2
    return (right - left).sum(axis=1), middles[:, 0] - middles[:, 1]


def test_leaning_frames_are_the_least_squares_fit_of_a_body_with_equal_sides(rng):
    turns = Rotation.random(40, rng=rng)
    off = rng.normal(scale=0.004, size=(40, 4, 3))
    joints = np.einsum("nij,kj->nki", turns.as_matrix(), SHOULDERS_HIPS) + off
    frames = lateral_frames(*lines(joints), lean=True)
    fitted = []
    for seen in joints:
        fit, _ = Rotation.align_vectors(seen - seen.mean(axis=0), SHOULDERS_HIPS)
        fitted.append(fit.as_matrix())
    apart = Rotation.from_matrix(np.swapaxes(np.array(fitted), 1, 2) @ frames).as_rotvec()
    roll = np.abs(np.rad2deg(apart[:, 0]))
    stiff = lateral_frames(*lines(joints))
    kept = Rotation.from_matrix(np.swapaxes(np.array(fitted), 1, 2) @ stiff).as_rotvec()
    # weighs pairs as the sum of their lengths, not of their squares: that is all of the difference
    assert roll.max() < 0.15 * np.abs(np.rad2deg(kept[:, 0])).max()
    true = turns.as_matrix()
    errors = [
        np.rad2deg(Rotation.from_matrix(np.swapaxes(true, 1, 2) @ it).magnitude()).mean()
        for it in (frames, stiff)
    ]
    assert errors[0] < 0.95 * errors[1]


def test_leaning_frames_are_frames_exact_without_errors_and_mirrored_with_the_body(rng):
    turns = Rotation.random(9, rng=rng).as_matrix()
    joints = np.einsum("nij,kj->nki", turns, SHOULDERS_HIPS)
    assert_allclose(lateral_frames(*lines(joints), lean=True), turns, atol=1e-12)
    joints = joints + rng.normal(scale=0.02, size=joints.shape)
    joints[3, 1] = np.nan
    frames = lateral_frames(*lines(joints), lean=True)
    assert np.isnan(frames[3]).all()
    mirror = np.diag([1.0, 1.0, -1.0])
    mirrored = lateral_frames(*lines(joints[:, [1, 0, 3, 2]] @ mirror), lean=True)
    assert_allclose(mirrored, mirror @ frames @ mirror, atol=1e-12)
    known = np.delete(np.arange(9), 3)
    assert_allclose(np.linalg.det(frames[known]), 1.0)
    assert_allclose(
        np.swapaxes(frames, 1, 2)[known] @ frames[known], np.tile(np.eye(3), (8, 1, 1)), atol=1e-12
    )
    across, _ = lines(joints)
    assert np.isnan(lateral_frames(across, 2 * across, lean=True)).all()


@pytest.mark.parametrize("lean_deg", [0.0, 45.0])
def test_the_plane_gives_the_papers_axes(lean_deg, rng):
    """Normal of the best plane, up projected into it, and the third across both."""
    lean = Rotation.from_euler("z", lean_deg, degrees=True).as_matrix()
    joints = rng.normal(size=(1, 9, 3)) * [0.05, 0.6, 0.2] @ lean.T
    up = np.array([[0.0, 1.0, 0.0]])
    frame = plane_frames(joints, up, np.full((1, 3), np.nan))[0]
    normal = np.linalg.svd(joints[0] - joints[0].mean(axis=0))[2][2]
    assert abs(normal @ frame[:, 0]) == pytest.approx(1.0)
    assert frame[:, 1] @ up[0] == pytest.approx(np.sqrt(1 - (normal @ up[0]) ** 2))
    assert np.linalg.det(frame) == pytest.approx(1.0)


def test_a_level_plane_takes_its_longer_side(rng):
    joints = rng.uniform(-1, 1, size=(1, 30, 3)) * [0.9, 0.02, 0.25]
    for head in (-1.0, 1.0):
        trunk = np.array([[head, 0.0, 0.0]])
        frame = plane_frames(joints, np.array([[0.0, 1.0, 0.0]]), trunk)[0]
        assert frame[:, 1] @ trunk[0] > 0.98


def test_fronts_are_brought_to_one_side(rng):
    frames = np.tile(np.eye(3), (12, 1, 1))
    frames[rng.random(12) < 0.5] = AWAY
    frames[0], frames[1] = np.eye(3), AWAY
    unknown = np.full((12, 3), np.nan)
    same = face_the_same_way(frames, unknown)
    assert (same == same[0]).all()
    told = unknown.copy()
    told[3] = [0.0, 0.1, -1.0]
    assert (face_the_same_way(frames, told) == AWAY).all()


def test_the_plane_follows_names_frame_by_frame(tools, rng):
    """Somebody who turns round is not averaged with himself."""
    yaw = np.array([[np.cos(a), 0, -np.sin(a), 0, 1, 0, np.sin(a), 0, np.cos(a)]
                    for a in np.linspace(0, 6, 200)]).reshape(-1, 3, 3)  # fmt: skip
    it = tools.make_doll(rng, n_frames=200, world=yaw)
    result = normalize(it.motion, NormalizationSettings(body="plane"))
    assert result.history[-1].findings["spread_max_deg"] < 1e-6
    assert (np.einsum("fi,fi->f", result.rotations[:, 0, :, 0], yaw[:, :, 0]) > 0.99).all()
