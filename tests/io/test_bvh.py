"""write_bvh, against a tiny evaluator that knows BVH and nothing of Kinesphere."""

from dataclasses import replace
from typing import NamedTuple

import numpy as np
import pytest
from numpy.testing import assert_allclose
from scipy.spatial.transform import Rotation

from kinesphere.data import Limb, Motion, PoseFlag, Skeleton, motion_from_parameters
from kinesphere.errors import BadSetting
from kinesphere.io import write_bvh

PRINTED = 2e-6  # m; angles printed to 1e-6°, lengths to 1e-6 units, a chain of a few limbs
METRES = {"cm": 0.01, "m": 1.0, "mm": 0.001}


class Evaluated(NamedTuple):
    """A BVH file played back; positions in the file's unit, end sites called ``NODE_end``."""

    parents: dict
    offsets: dict
    channels: dict
    positions: dict
    rotations: dict
    frame_time: float
    values: np.ndarray


def evaluate(path):
    """Read a BVH file and run its forward kinematics, from the format's description alone."""
    words = path.read_text(encoding="utf-8").split()
    assert words[0] == "HIERARCHY"
    parents, offsets, channels, inside, last, i = {}, {}, {}, [], None, 1
    while words[i] != "MOTION":
        if words[i] in ("ROOT", "JOINT"):
            last, i = words[i + 1], i + 2
        elif words[i] == "End":
            last, i = f"{inside[-1]}_end", i + 2
        elif words[i] == "{":
            assert last not in parents, "two nodes of one name"
            parents[last] = inside[-1] if inside else None
            channels[last] = []
            inside.append(last)
            i += 1
        elif words[i] == "}":
            inside.pop()
            i += 1
        elif words[i] == "OFFSET":
            offsets[inside[-1]] = np.array(words[i + 1 : i + 4], dtype=float)
            i += 4
        else:
            assert words[i] == "CHANNELS"
            n = int(words[i + 1])
            channels[inside[-1]] = words[i + 2 : i + 2 + n]
            i += 2 + n
    assert not inside
    assert words[i + 1] == "Frames:"
    assert words[i + 3 : i + 5] == ["Frame", "Time:"]
    n_frames = int(words[i + 2])
    values = np.array(words[i + 6 :], dtype=float).reshape(n_frames, -1)
    positions, rotations, column = {}, {}, 0
    for name, parent in parents.items():
        place = np.tile(offsets[name], (n_frames, 1))
        turn = Rotation.identity(n_frames)
        for channel in channels[name]:
            if channel.endswith("position"):
                place[:, "XYZ".index(channel[0])] = values[:, column]
            else:
                assert channel.endswith("rotation")
                letter, angles = channel[0].lower(), values[:, column, None]
                turn = turn * Rotation.from_euler(letter, angles, degrees=True)
            column += 1
        if parent is not None:
            place = positions[parent] + rotations[parent].apply(place)
            turn = rotations[parent] * turn
        positions[name], rotations[name] = place, turn
    assert column == values.shape[1]
    return Evaluated(parents, offsets, channels, positions, rotations, float(words[i + 5]), values)


def rest_pose(bvh):
    """Return node → (3,) where each stands when every rotation is zero."""
    places = {}
    for name, parent in bvh.parents.items():
        places[name] = bvh.offsets[name] + (places[parent] if parent else 0.0)
    return places


@pytest.mark.parametrize("rest", ["standing", "t-pose"])
@pytest.mark.parametrize("unit", METRES)
def test_joints_are_where_the_motion_has_them(performance, tmp_path, unit, rest):
    motion, path = performance.motion, tmp_path / "motion.bvh"
    write_bvh(motion, path, unit=unit, rest=rest)
    bvh = evaluate(path)
    centres = motion.joint_centres()
    for j, joint in enumerate(motion.skeleton.joints):
        assert_allclose(bvh.positions[joint.child] * METRES[unit], centres[:, j], atol=PRINTED)
    assert bvh.frame_time == pytest.approx(1 / motion.rate)


def test_limbs_end_where_the_motion_has_them(performance, tmp_path):
    motion, path = performance.motion, tmp_path / "motion.bvh"
    write_bvh(motion, path, unit="m", rest="t-pose")
    bvh = evaluate(path)
    for name in ("head", "left_forearm", "right_foot"):
        i = motion.skeleton.limb_names.index(name)
        limb, joint = motion.skeleton.limbs[i], motion.skeleton.joints[i - 1]
        end = joint.centre_in_child + limb.length * limb.long_axis
        there = motion.origins[:, i] + motion.rotations[:, i] @ end
        assert_allclose(bvh.positions[f"{name}_end"], there, atol=PRINTED)


def test_any_skeleton_at_any_angle(odd_motion, tmp_path):
    write_bvh(odd_motion, tmp_path / "odd.bvh", unit="m")
    bvh = evaluate(tmp_path / "odd.bvh")
    centres = odd_motion.joint_centres()
    for j, joint in enumerate(odd_motion.skeleton.joints):
        assert_allclose(bvh.positions[joint.child], centres[:, j], atol=PRINTED)


def test_the_rest_pose_stands_and_faces_z(performance, tmp_path):
    write_bvh(performance.motion, tmp_path / "a.bvh", unit="m")
    at = rest_pose(evaluate(tmp_path / "a.bvh"))
    lengths = {limb.name: limb.length for limb in performance.skeleton.limbs}
    for side, x in (("left", 1), ("right", -1)):
        assert x * at[f"{side}_upper_arm"][0] > 0.05, "its left is +x"
        arm = at[f"{side}_forearm_end"] - at[f"{side}_forearm"]
        assert_allclose(arm, [0, -lengths[f"{side}_forearm"], 0], atol=PRINTED)
        shank = at[f"{side}_foot"] - at[f"{side}_shank"]
        assert_allclose(shank / np.linalg.norm(shank), [0, -1, 0], atol=1e-3)
        foot = at[f"{side}_foot_end"] - at[f"{side}_foot"]
        assert_allclose(foot, [0, 0, lengths[f"{side}_foot"]], atol=PRINTED)
    head = at["head_end"] - at["head"]
    assert_allclose(head, [0, lengths["head"], 0], atol=PRINTED)


def test_the_t_pose_raises_the_arms_and_nothing_else(performance, tmp_path):
    for rest in ("standing", "t-pose"):
        write_bvh(performance.motion, tmp_path / f"{rest}.bvh", unit="m", rest=rest)
    hanging, raised = (
        rest_pose(evaluate(tmp_path / f"{rest}.bvh")) for rest in ("standing", "t-pose")
    )
    for side, x in (("left", 1), ("right", -1)):
        arm = raised[f"{side}_forearm_end"] - raised[f"{side}_upper_arm"]
        assert_allclose(arm / np.linalg.norm(arm), [x, 0, 0], atol=1e-3)
    for name in ("left_foot_end", "head_end", "right_shank", "left_upper_arm"):
        assert_allclose(raised[name], hanging[name], atol=1e-9)


def test_the_root_turns_between_the_hips(performance, tmp_path):
    write_bvh(performance.motion, tmp_path / "a.bvh", unit="m")
    bvh = evaluate(tmp_path / "a.bvh")
    joints, centres = performance.skeleton.joint_names, performance.motion.joint_centres()
    hips = [joints.index(f"{side}_hip") for side in ("left", "right")]
    assert_allclose(bvh.positions["trunk"], centres[:, hips].mean(axis=1), atol=PRINTED)


def test_the_names_of_joints_mean_nothing(performance, tmp_path):
    motion, skeleton = performance.motion, performance.skeleton
    joints = tuple(replace(joint, name=f"j{i}") for i, joint in enumerate(skeleton.joints))
    write_bvh(motion, tmp_path / "a.bvh")
    write_bvh(replace(motion, skeleton=replace(skeleton, joints=joints)), tmp_path / "b.bvh")
    assert (tmp_path / "b.bvh").read_bytes() == (tmp_path / "a.bvh").read_bytes()


def test_channels_are_those_the_documents_name(performance, tmp_path):
    write_bvh(performance.motion, tmp_path / "a.bvh")
    channels = evaluate(tmp_path / "a.bvh").channels
    assert channels.pop("trunk") == [
        *("Xposition", "Yposition", "Zposition"),
        *("Yrotation", "Xrotation", "Zrotation"),
    ]
    assert {tuple(c) for c in channels.values() if c} == {("Zrotation", "Yrotation", "Xrotation")}


def test_an_unseen_limb_keeps_its_last_known_turn(odd_motion, tmp_path):
    rotations, origins = odd_motion.rotations.copy(), odd_motion.origins.copy()
    flags = odd_motion.flags.copy()
    for limb, frames in (
        (5, slice(20, 33)),
        (2, slice(0, 9)),
        (6, slice(None)),
        (0, slice(70, 75)),
    ):
        rotations[frames, limb], origins[frames, limb] = np.nan, np.nan
        flags[frames, limb] = PoseFlag.UNSEEN
    gappy = replace(odd_motion, rotations=rotations, origins=origins, flags=flags)
    write_bvh(odd_motion, tmp_path / "whole.bvh")
    write_bvh(gappy, tmp_path / "gappy.bvh")
    assert "nan" not in (tmp_path / "gappy.bvh").read_text(encoding="utf-8").lower()
    whole, held = (evaluate(tmp_path / f"{name}.bvh") for name in ("whole", "gappy"))

    def local(bvh, limb):
        name = odd_motion.skeleton.limb_names[limb]
        parent = bvh.parents[name]
        above = bvh.rotations[parent].inv() if parent else Rotation.identity(75)
        return (above * bvh.rotations[name]).as_matrix()

    last = np.arange(75)
    last[20:33] = 19
    assert_allclose(local(held, 5), local(whole, 5)[last], atol=1e-7)
    first = np.clip(np.arange(75), 9, 69)  # it hangs from the root, unseen from 70 on
    assert_allclose(local(held, 2), local(whole, 2)[first], atol=1e-7)
    assert_allclose(local(held, 6), np.tile(np.eye(3), (75, 1, 1)), atol=1e-7)
    root = np.minimum(np.arange(75), 69)
    assert_allclose(held.positions["trunk"], whole.positions["trunk"][root], atol=1e-5)
    assert_allclose(local(held, 0), local(whole, 0)[root], atol=1e-7)


def test_a_limb_of_unknown_length_reaches_to_its_farthest_marker(performance, tmp_path):
    limbs = list(performance.skeleton.limbs)
    limbs[1] = replace(limbs[1], length=np.nan)
    skeleton = replace(performance.skeleton, limbs=tuple(limbs))
    write_bvh(replace(performance.motion, skeleton=skeleton), tmp_path / "a.bvh", unit="m")
    centre = skeleton.joints[0].centre_in_child
    reach = ((limbs[1].marker_positions - centre) @ limbs[1].long_axis).max()
    assert_allclose(evaluate(tmp_path / "a.bvh").offsets["head_end"], [0, reach, 0], atol=PRINTED)


def test_one_limb_alone(tmp_path):
    limb = Limb("box 1", None, (), np.empty((0, 3)), 0.3, np.array([0.0, 1.0, 0.0]))
    turns = Rotation.from_rotvec([[0, 0, 0], [0, 0.2, 0]]).as_matrix()[:, None]
    motion = Motion(
        skeleton=Skeleton((limb,), ()),
        rotations=turns,
        origins=np.array([[[0.0, 1, 2]], [[3, 4, 5]]]),
        residuals=np.zeros((2, 1)),
        flags=np.ones((2, 1)),
        rate=300.0,
    )
    write_bvh(motion, tmp_path / "a.bvh", unit="m")
    bvh = evaluate(tmp_path / "a.bvh")
    assert list(bvh.parents) == ["box_1", "box_1_end"]
    assert_allclose(bvh.positions["box_1"], motion.origins[:, 0])
    assert bvh.frame_time == pytest.approx(1 / 300, abs=1e-9)


def test_angles_do_not_jump_where_the_motion_does_not(performance, tmp_path):
    truth = performance.parameters
    angles = np.linspace(0, 3, truth.n_frames)[:, None, None] * np.isfinite(truth.angles)
    angles = np.where(np.isfinite(truth.angles), angles, np.nan)
    motion = motion_from_parameters(replace(truth, angles=angles))
    write_bvh(motion, tmp_path / "a.bvh")
    steps = np.abs(np.diff(evaluate(tmp_path / "a.bvh").values[:, 6:], axis=0))
    assert steps.max() < 90  # a jump is 180 or 360


@pytest.mark.parametrize("wrong", [{"unit": "parsec"}, {"rest": "sitting"}])
def test_unknown_choices_are_named(performance, tmp_path, wrong):
    with pytest.raises(BadSetting, match=next(iter(wrong.values()))):
        write_bvh(performance.motion, tmp_path / "a.bvh", **wrong)
    assert not list(tmp_path.iterdir())
