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
from kinesphere.editing import (
    RetargetSettings,
    retarget_motion,
    scaled_skeleton,
    stature,
)
from kinesphere.errors import BadModel, BadSetting, DegenerateMotion
from kinesphere.io import read_bvh, write_bvh
from kinesphere.synthetic import make_performance

EXACT = 1e-9
FREE = RetargetSettings(feet="free")


@pytest.fixture(scope="module")
def walker():
    """Return a motion that walks, its joints held together."""
    performance = make_performance(
        np.random.default_rng(5), rate=50.0, calibration_s=4.0, free_s=6.0
    )
    motion = retarget_motion(performance.motion, performance.skeleton, settings=FREE)
    return part(motion, slice(200, None))  # without the calibration, which leaps


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
    assert row.n_contacts >= 3
    assert row.slide_free_most_mm > 2
    assert row.slide_most_mm < 1e-6
    assert row.wrong_knees == 0
    assert row.arms_deg < 1e-6
    assert row.turn_deg < row.turn_source_deg + 1
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
