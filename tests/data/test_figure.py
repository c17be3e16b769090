"""Which limbs are which parts: by the names of many programs, by shape, by a person's word."""

from dataclasses import replace

import numpy as np
import pytest

from kinesphere.data.figure import PARTS, find_figure
from kinesphere.data.figure_names import Part, part_from_name
from kinesphere.errors import BadModel
from kinesphere.io.bones import Bone, skeleton_of_bones
from kinesphere.io.bvh import BVH_FROM_BODY

NAMES = {
    "thigh, left": "left_thigh mixamorig:LeftUpLeg LeftUpperLeg thigh_l DEF-thigh.L "
    "J_Bip_L_UpperLeg lfemur femur_l L_Thigh CC_Base_L_Thigh Character1_LeftUpLeg",
    "shank, right": "right_shank mixamorig:RightLeg RightLowerLeg calf_r DEF-shin.R rtibia "
    "RightKnee",
    "foot, left": "LeftFoot foot_l DEF-foot.L lfoot LeftAnkle calcn_l",
    "toes, left": "LeftToeBase ball_l DEF-toe.L ltoes LeftToes",
    "upper_arm, right": "RightArm RightUpperArm upperarm_r DEF-upper_arm.R rhumerus",
    "forearm, left": "LeftForeArm LeftLowerArm lowerarm_l DEF-forearm.L lradius LeftElbow",
    "hand, right": "RightHand hand_r DEF-hand.R rwrist RightWrist",
    "clavicle, left": "clavicle_l lclavicle LeftCollar",
    "shoulder, left": "LeftShoulder DEF-shoulder.L",
    "hip, left": "LeftHip",
    "head, ": "Head mixamorig:Head head",
    "trunk, ": "Spine Spine2 spine_03 DEF-spine.001 upperback Chest UpperChest torso",
}
NONE = (
    "LeftHandThumb1 lowerarm_twist_01_l LHipJoint lhipjoint head_end root Armature HandRight2x "
    "ik_foot_root LeftEye jaw"
)


@pytest.mark.parametrize("part", NAMES)
def test_names_mean_parts(part):
    name, side = part.split(", ")
    for limb in NAMES[part].split():
        assert part_from_name(limb) == Part(name, side), limb


def test_names_with_blanks_mean_parts_too():
    assert part_from_name("Bip01 L Thigh") == Part("thigh", "left")
    assert part_from_name("Left Arm") == Part("upper_arm", "left")


@pytest.mark.parametrize("name", NONE.split())
def test_other_names_mean_none(name):
    assert part_from_name(name) is None


def rig(arms=0.0, names=None):
    """Return a figure of two legs, two arms with collar bones, a spine of three and fingers."""
    bones = []

    def add(name, parent, offset, end=None):
        at = [bone.name for bone in bones].index(parent) if parent else -1
        tip = None if end is None else np.array(end, dtype=float)
        bones.append(Bone(name, at, np.array(offset, dtype=float), tip))

    add("Root", None, (0, 0, 0))
    add("Hips", "Root", (0, 100, 0))
    for i, (a, b) in enumerate([("Hips", "Spine"), ("Spine", "Spine1"), ("Spine1", "Spine2")]):
        add(b, a, (0, 12 + i, 0))
    add("Neck", "Spine2", (0, 14, 0))
    add("Head", "Neck", (0, 8, 1), (0, 20, 0))
    for side, s in (("Left", 1), ("Right", -1)):
        way = np.array([s * np.cos(arms), -np.sin(arms), 0.0])
        add(f"{side}Shoulder", "Spine2", (3 * s, 10, 0))
        add(f"{side}Arm", f"{side}Shoulder", (14 * s, 0, 0))
        add(f"{side}ForeArm", f"{side}Arm", 28 * way)
        add(f"{side}Hand", f"{side}ForeArm", 25 * way)
        add(f"{side}HandThumb1", f"{side}Hand", 3 * way + [0, 0, 3], 3 * way)
        add(f"{side}HandIndex1", f"{side}Hand", 9 * way, 8 * way)
        add(f"{side}UpLeg", "Hips", (9 * s, -5, 0))
        add(f"{side}Leg", f"{side}UpLeg", (0, -42, 0))
        add(f"{side}Foot", f"{side}Leg", (0, -41, -1))
        add(f"{side}ToeBase", f"{side}Foot", (0, -9, 13), (0, 0, 6))
    if names is not None:
        bones = [bone._replace(name=names(bone.name)) for bone in bones]
    return skeleton_of_bones(bones, 0.01, BVH_FROM_BODY)


def parts_of(skeleton, figure):
    return {part: skeleton.limb_names[i] for part, i in figure.parts.items()}


def test_the_whole_figure_is_told_by_names():
    skeleton = rig()
    figure = find_figure(skeleton)
    assert figure.source == "names"
    assert set(figure.parts) == set(PARTS)
    assert skeleton.limb_names[figure.pelvis] == "Hips"
    assert [skeleton.limb_names[i] for i in figure.spine] == ["Spine", "Spine1", "Spine2"]
    assert [skeleton.limb_names[i] for i in figure.neck] == ["Neck"]
    assert [skeleton.limb_names[i] for i in figure.clavicles["right"]] == ["RightShoulder"]


@pytest.mark.parametrize("arms", [0.0, 0.8, 1.4])
def test_shape_tells_what_names_do_not(arms):
    expected = parts_of(rig(arms), find_figure(rig(arms)))
    skeleton = rig(arms, names=lambda name: f"x{hash_of(name)}")
    figure = find_figure(skeleton)
    assert figure.source == "shape"
    found = parts_of(skeleton, figure)
    assert found == {part: f"x{hash_of(name)}" for part, name in expected.items()}


def hash_of(name):
    return sum(ord(c) * 31**k for k, c in enumerate(name)) % 100003


def test_files_that_name_joints_are_understood():
    names = {"UpLeg": "Hip", "Leg": "Knee", "Foot": "Ankle", "Arm": "Shoulder", "ForeArm": "Elbow",
             "Hand": "Wrist", "Shoulder": "Collar"}  # fmt: skip

    def joint(name):
        for side in ("Left", "Right"):
            if name.removeprefix(side) in names:
                return side + names[name.removeprefix(side)]
        return name

    plain, named = rig(), rig(names=joint)
    assert dict(find_figure(named).parts) == dict(find_figure(plain).parts)
    assert find_figure(named).source == "names"


def test_rigify_calls_its_head_a_spine():
    def rigify(name):
        spine = ["Hips", "Spine", "Spine1", "Spine2", "Neck", "", "Head"]
        return f"DEF-spine.{spine.index(name):03d}" if name in spine else name

    assert dict(find_figure(rig(names=rigify)).parts) == dict(find_figure(rig()).parts)


def test_a_persons_word_counts():
    skeleton = rig(names=lambda name: name.replace("LeftForeArm", "Unterarm_L"))
    assert "left_forearm" not in find_figure(skeleton).parts
    figure = find_figure(skeleton, {"left_forearm": "Unterarm_L", "head": ""})
    assert figure.source == "given"
    assert parts_of(skeleton, figure)["left_forearm"] == "Unterarm_L"
    assert "head" not in figure.parts
    with pytest.raises(BadModel, match="no part"):
        find_figure(skeleton, {"tail": "Hips"})
    with pytest.raises(BadModel, match="no limb of the rig"):
        find_figure(skeleton, {"head": "Kopf"})


def test_an_arm_alone_is_no_figure():
    bones = [Bone("a", -1, np.zeros(3), None), Bone("b", 0, np.array([0, 1.0, 0]), None)]
    with pytest.raises(BadModel, match="name them in a mapping"):
        find_figure(skeleton_of_bones(bones, 1.0, BVH_FROM_BODY))


def test_another_name_of_the_head_moves_nothing_else(performance_skeleton):
    """Renaming one limb must not shift the others."""
    expected = find_figure(performance_skeleton)
    limbs = tuple(
        replace(limb, name="skull") if limb.name == "head" else limb
        for limb in performance_skeleton.limbs
    )
    joints = tuple(
        replace(joint, child="skull") if joint.child == "head" else joint
        for joint in performance_skeleton.joints
    )
    other = replace(performance_skeleton, limbs=limbs, joints=joints)
    assert dict(find_figure(other).parts) == dict(expected.parts)


@pytest.fixture
def performance_skeleton(rng):
    from kinesphere.synthetic import make_performance

    return make_performance(rng, rate=25.0, calibration_s=1.0, free_s=0.2).skeleton
