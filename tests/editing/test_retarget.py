"""retarget_motion: laws, planted feet, and rigs whose rest pose is another."""

import itertools
from dataclasses import replace

import numpy as np
import pytest
from benchmarks.accuracy.retargeting.measure import measured
from benchmarks.accuracy.retargeting.rigs import changed, character
from numpy.testing import assert_allclose
from scipy.spatial.transform import Rotation

from kinesphere.data import PoseFlag
from kinesphere.data.figure import find_figure
from kinesphere.editing import (
    RetargetSettings,
    retarget_motion,
    scaled_skeleton,
    stature,
)
from kinesphere.editing.foot_contacts import BALL, find_contacts, find_ground, runs, soles
from kinesphere.editing.retarget_rest import rest_pose
from kinesphere.errors import BadModel, BadSetting, DegenerateMotion
from kinesphere.io import read_bvh, read_rig, write_bvh, write_on_rig

EXACT = 1e-9
FREE = RetargetSettings(feet="free")


@pytest.fixture(scope="module")
def walker(walk):
    """Return the walk."""
    return walk


def part(motion, frames):
    """Return some frames of a motion."""
    return replace(
        motion,
        rotations=motion.rotations[frames],
        origins=motion.origins[frames],
        residuals=motion.residuals[frames],
        flags=motion.flags[frames],
    )


def places(motion):
    return np.concatenate([motion.origins[:, :1], motion.joint_centres()], axis=1)


def test_onto_itself_is_exact(walker):
    same = retarget_motion(walker, walker.skeleton)
    assert_allclose(same.rotations, walker.rotations, rtol=0, atol=EXACT)
    assert_allclose(same.origins, walker.origins, rtol=0, atol=EXACT)
    assert same.history[-1].name == "retargeting"


@pytest.mark.parametrize("rest", ["standing", "t-pose"])
def test_onto_its_own_bvh_is_exact_where_joints_are(walker, tmp_path, rest):
    write_bvh(walker, tmp_path / "a.bvh", rest=rest, unit="m")
    rig = read_bvh(tmp_path / "a.bvh", unit="m")
    done = retarget_motion(walker, rig.skeleton, settings=FREE)
    assert_allclose(places(done)[:, 1:], rig.joint_centres(), atol=5e-6)
    again = retarget_motion(rig, rig.skeleton)
    assert_allclose(again.rotations, rig.rotations, rtol=0, atol=EXACT)
    assert_allclose(again.origins, rig.origins, rtol=0, atol=EXACT)


def test_a_larger_figure_walks_farther_and_stands_on_the_same_floor(walker):
    large = retarget_motion(walker, scaled_skeleton(walker.skeleton, 1.5), settings=FREE)
    assert_allclose(large.rotations, walker.rotations, rtol=0, atol=EXACT)
    assert_allclose(places(large), 1.5 * places(walker), atol=EXACT)
    assert stature(large) == pytest.approx(1.5 * stature(walker))


def test_the_result_moves_with_the_world(walker):
    rig = character()
    turn = Rotation.from_euler("y", 0.7).as_matrix()
    shift = np.array([0.3, 0.0, -2.0])
    moved = replace(
        walker, rotations=turn @ walker.rotations, origins=walker.origins @ turn.T + shift
    )
    here, there = retarget_motion(walker, rig), retarget_motion(moved, rig)
    scale = here.history[-1].findings["scale"]
    assert_allclose(places(there), places(here) @ turn.T + scale * shift, atol=1e-7)


@pytest.mark.parametrize("arms", ["t", "a"])
def test_other_rest_poses_are_accounted_for(walker, arms):
    rig = character(arms)
    done = retarget_motion(walker, rig, settings=FREE)
    ours, theirs = places(walker), places(done)
    for side in ("left", "right"):
        for limbs, bones in (
            (("upper_arm", "forearm"), ("Arm", "ForeArm")),
            (("thigh", "shank"), ("UpLeg", "Leg")),
            (("shank", "foot"), ("Leg", "Foot")),
        ):
            a, b = (walker.skeleton.limb_names.index(f"{side}_{limb}") for limb in limbs)
            names = done.skeleton.limb_names
            c, d = (names.index(f"mixamorig:{side.title()}{bone}") for bone in bones)
            source, target = ours[:, b] - ours[:, a], theirs[:, d] - theirs[:, c]
            source /= np.linalg.norm(source, axis=1, keepdims=True)
            target /= np.linalg.norm(target, axis=1, keepdims=True)
            assert_allclose(target, source, atol=EXACT)


def test_t_and_a_pose_of_one_character_move_alike(walker):
    t, a = (retarget_motion(walker, character(arms)) for arms in "ta")
    assert_allclose(places(t), places(a), atol=1e-7)


def test_spines_share_what_one_trunk_turns(walker):
    done = retarget_motion(walker, character(), settings=FREE)
    names = done.skeleton.limb_names
    spine = [names.index(f"mixamorig:{n}") for n in ("Hips", "Spine", "Spine1", "Spine2")]
    steps = [
        np.swapaxes(done.rotations[:, a], 1, 2) @ done.rotations[:, b]
        for a, b in itertools.pairwise(spine)
    ]
    assert_allclose(steps[0], steps[1], atol=1e-7)
    assert_allclose(steps[1], steps[2], atol=1e-7)


@pytest.mark.parametrize("rig", ["20 % shorter", "20 % taller", "other proportions", "t", "a"])
def test_feet_stand_still_and_knees_bend_as_knees_do(walker, rig):
    own = dict(changed(walker.skeleton))
    skeleton = own[rig] if rig in own else character(rig, 1.15, 1.4)
    row = measured("walker", walker, rig, skeleton, rig in own)
    assert row.n_contacts >= 10
    assert row.slide_free_most_mm > 2 or rig in own
    assert row.slide_most_mm < 1e-6
    assert row.wrong_knees == 0
    assert row.arms_deg < 1e-6
    assert row.turn_deg < row.turn_source_deg + 1.5
    assert row.added_deg < 1.5


def test_joints_never_come_apart(walker):
    done = retarget_motion(walker, character("a", 0.8))
    parents = done.skeleton.parents[1:]
    at = np.array([joint.centre_in_parent for joint in done.skeleton.joints])
    there = done.origins[:, parents] + (done.rotations[:, parents] @ at[..., None])[..., 0]
    assert_allclose(there, done.origins[:, 1:], atol=EXACT)


def test_gaps_are_bridged_aloud(walker):
    rotations, origins = walker.rotations.copy(), walker.origins.copy()
    flags = walker.flags.copy()
    arm = walker.skeleton.limb_names.index("left_forearm")
    for frames, limb in ((slice(40, 60), arm), (slice(0, 5), 0), (slice(None), arm + 1)):
        rotations[frames, limb], origins[frames, limb] = np.nan, np.nan
        flags[frames, limb] = PoseFlag.UNSEEN
    gappy = replace(walker, rotations=rotations, origins=origins, flags=flags)
    done = retarget_motion(gappy, character())
    assert np.isfinite(done.rotations).all()
    assert np.isfinite(done.origins).all()
    assert "gaps were bridged" in " ".join(done.history[-1].warnings)
    whole = retarget_motion(walker, character())
    name = "mixamorig:LeftForeArm"
    i = done.skeleton.limb_names.index(name)
    turned = Rotation.from_matrix(done.rotations[39, i].T @ done.rotations[40, i]).magnitude()
    assert turned < 0.2
    assert_allclose(done.rotations[100, i], whole.rotations[100, i], atol=EXACT)


def test_a_root_never_seen_is_refused(walker):
    rotations = walker.rotations.copy()
    rotations[:, 0] = np.nan
    with pytest.raises(DegenerateMotion, match="never seen"):
        retarget_motion(replace(walker, rotations=rotations), character())


@pytest.mark.parametrize("n", [1, 2, 3])
def test_a_few_frames_will_do(walker, n):
    done = retarget_motion(part(walker, slice(n)), character())
    assert done.n_frames == n
    assert np.isfinite(done.origins).all()


def test_limbs_named_by_a_person(walker):
    rig = character()
    limbs = tuple(
        replace(limb, name=limb.name.replace("LeftForeArm", "Unterarm")) for limb in rig.limbs
    )
    limbs = tuple(
        replace(limb, parent=limb.parent and limb.parent.replace("LeftForeArm", "Unterarm"))
        for limb in limbs
    )
    joints = tuple(
        replace(
            joint,
            child=joint.child.replace("LeftForeArm", "Unterarm"),
            parent=joint.parent.replace("LeftForeArm", "Unterarm"),
        )
        for joint in rig.joints
    )
    odd = replace(rig, limbs=limbs, joints=joints)
    expected = retarget_motion(walker, rig)
    told = retarget_motion(walker, odd, parts={"left_forearm": "mixamorig:Unterarm"})
    assert_allclose(told.rotations, expected.rotations, atol=EXACT)
    assert np.abs(retarget_motion(walker, odd).rotations - expected.rotations).max() > 0.1


def test_what_cannot_be_is_named(walker):
    with pytest.raises(BadSetting, match="feet is 'glued'"):
        RetargetSettings(feet="glued")
    with pytest.raises(BadModel, match="no limb 'tail'"):
        scaled_skeleton(walker.skeleton, 1.0, {"tail": 2.0})
    with pytest.raises(BadSetting, match=r"0\.01 to 100"):
        scaled_skeleton(walker.skeleton, 0.0)
    with pytest.raises(BadSetting, match=r"0\.01 to 100"):
        scaled_skeleton(walker.skeleton, np.nan)


def test_contacts_are_when_the_feet_stand(walker, standing):
    row = contacts_of(walker)
    assert (row.any(axis=2) != standing).mean() < 0.08
    assert not (row[..., BALL] & ~standing).sum() > 12  # a frame or two at each end


def contacts_of(motion):
    rest = rest_pose(motion.skeleton, find_figure(motion.skeleton))
    at = places(motion)
    feet = [rest.figure.parts[f"{side}_foot"] for side in ("left", "right")]
    ankle = find_ground(at[:, feet], rest.leg).ankle
    points = soles(rest, motion.skeleton, motion.rotations, at, ankle, 0.2)
    return find_contacts(points, motion.rate, rest.leg, RetargetSettings())


def test_soles_stand_on_the_floor_and_toes_do_not_sink(walker):
    """The ball of the character's foot lies 8 cm below its ankle, its toes end 5 mm lower."""
    contacts = contacts_of(walker)
    done = retarget_motion(walker, character())
    names, at = done.skeleton.limb_names, places(done)
    for f, side in enumerate(("Left", "Right")):
        i = names.index(f"mixamorig:{side}ToeBase")
        limb = done.skeleton.limbs[i]
        tip = at[:, i] + done.rotations[:, i] @ (limb.length * limb.long_axis)
        stances = runs(contacts[:, f, BALL])
        assert len(stances) >= 4
        for first, end in stances:
            stands = slice(first + 8 if first else 0, end - 8)  # when they have settled
            assert (tip[stands, 1] > at[stands, i, 1] - 0.0055).all()
            assert_allclose(tip[stands, 1], 0, atol=0.02)


def test_a_rig_that_stands_along_z_keeps_its_world(walker, tmp_path):
    write_bvh(walker, tmp_path / "a.bvh", unit="m")
    turned = []
    for line in (tmp_path / "a.bvh").read_text(encoding="utf-8").splitlines():
        head, offset, numbers = line.partition("OFFSET ")
        if offset:
            x, y, z = map(float, numbers.split())
            line = f"{head}OFFSET {x} {-z} {y}"
        turned.append(line)
        if line == "MOTION":
            break
    (tmp_path / "z.bvh").write_text("\n".join(turned[:-1]) + "\n", encoding="utf-8")
    done = retarget_motion(walker, read_rig(tmp_path / "z.bvh"), settings=FREE)
    write_on_rig(done, tmp_path / "z.bvh", tmp_path / "out.bvh")
    motion = read_bvh(tmp_path / "out.bvh", unit="m")
    assert motion.history[0].findings["up"] == "+z"
    plain = read_bvh(tmp_path / "a.bvh", unit="m")
    a, b = (one.joint_centres() for one in (motion, plain))
    assert_allclose(a[..., 1], b[..., 1], atol=1e-5)
    between = np.linalg.norm(a[:, :, None] - a[:, None], axis=-1)
    assert_allclose(between, np.linalg.norm(b[:, :, None] - b[:, None], axis=-1), atol=1e-5)


def still(motion):
    """Return the motion at rest: every frame as the body's."""
    return replace(motion, rotations=np.tile(np.eye(3), (*motion.rotations.shape[:2], 1, 1)))


def test_feet_that_point_out_at_rest_point_where_the_sources_do(walker):
    done = retarget_motion(still(walker), character(), settings=FREE)
    names, at = done.skeleton.limb_names, places(done)
    for side in ("Left", "Right"):
        foot, toes = (names.index(f"mixamorig:{side}{part}") for part in ("Foot", "ToeBase"))
        way = at[:, toes] - at[:, foot]
        assert_allclose(np.arctan2(way[:, 2], way[:, 0]), 0, atol=EXACT)  # along the body's x


def test_an_elbow_bent_at_rest_is_straightened_about_its_own_axis(walker):
    rig = character()
    forward = Rotation.from_euler("y", 40, degrees=True).as_matrix()  # the left is at −z, front +x
    joints = tuple(
        replace(joint, centre_in_parent=forward @ joint.centre_in_parent)
        if joint.child == "mixamorig:LeftHand"
        else joint
        for joint in rig.joints
    )
    done = retarget_motion(still(walker), replace(rig, joints=joints), settings=FREE)
    names = done.skeleton.limb_names
    upper, fore = (names.index(f"mixamorig:Left{part}") for part in ("Arm", "ForeArm"))
    bend = done.rotations[0, upper].T @ done.rotations[0, fore]
    turn = Rotation.from_matrix(bend).as_rotvec(degrees=True)
    assert_allclose(np.abs(turn), [0, 40, 0], atol=1e-6)


def test_soles_are_where_they_were_with_feet_left_free(walker):
    done = retarget_motion(walker, character(), settings=FREE)
    names, at = done.skeleton.limb_names, places(done)
    toes = [names.index(f"mixamorig:{side}ToeBase") for side in ("Left", "Right")]
    assert_allclose(np.percentile(at[:, toes, 1], 10, axis=0), 0.005, atol=0.006)


def test_one_limb_for_pelvis_and_trunk_goes_half_way(walker):
    source = retarget_motion(walker, character(), settings=FREE)
    names = source.skeleton.limb_names
    below = [names.index(f"mixamorig:{n}") for n in ("Hips", "LeftUpLeg", "RightUpLeg")]
    below += [i for i, n in enumerate(names) if n.endswith(("Leg", "Foot", "ToeBase"))]
    rotations = source.rotations.copy()
    twist = Rotation.from_euler("y", 0.4).as_matrix()
    above = [i for i in range(len(names)) if i not in below]
    rotations[:, above] = twist @ rotations[:, above]
    plain = retarget_motion(source, walker.skeleton, settings=FREE)
    turned = retarget_motion(replace(source, rotations=rotations), walker.skeleton, settings=FREE)
    half = turned.rotations[:, 0] @ plain.rotations[:, 0].swapaxes(1, 2)
    angle = Rotation.from_matrix(half).as_rotvec()
    assert_allclose(angle, np.tile([0, 0.2, 0], (len(angle), 1)), atol=1e-6)
