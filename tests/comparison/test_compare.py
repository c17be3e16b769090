"""compare, against differences that we made ourselves."""

from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose
from scipy.spatial.transform import Rotation

from kinesphere.comparison import compare
from kinesphere.comparison.sides import sampled, side_from
from kinesphere.comparison.timing import pooled_correlation
from kinesphere.data import Motion, PoseFlag
from kinesphere.errors import BadRecording, BadSetting, DegenerateMotion
from kinesphere.geometry.rotations import rotation_about
from kinesphere.synthetic import make_performance

RATE = 100.0
EXACT = 1e-9  # rad or m: rounding of some products and a mean over thousands of frames
WORLD = Rotation.from_rotvec([0.02, 1.1, -0.01])
SHIFT = np.array([0.4, -0.1, 2.0])


@pytest.fixture(scope="session")
def performance():
    """Return an actor with pelvis-less human limbs at 100 Hz: it calibrates, then walks freely."""
    return make_performance(np.random.default_rng(7), rate=RATE, calibration_s=20.0, free_s=10.0)


@pytest.fixture(scope="session")
def motion(performance) -> Motion:
    return performance.motion


def part(motion, frames, rate=None):
    """Return some frames of a motion."""
    return replace(
        motion,
        rotations=motion.rotations[frames],
        origins=motion.origins[frames],
        residuals=motion.residuals[frames],
        flags=motion.flags[frames],
        rate=rate or motion.rate,
    )


def in_another_world(motion, rotation, shift):
    turn = rotation.as_matrix()
    return replace(
        motion, rotations=turn @ motion.rotations, origins=motion.origins @ turn.T + shift
    )


def in_other_frames(motion, turns, shift=0.0):
    """Return the same motion told in other limb frames: ``p' = turns[limb] p + shift``."""
    skeleton = motion.skeleton
    names = skeleton.limb_names
    at = {name: turns[i] for i, name in enumerate(names)}
    offset = np.array([shift, 0.0, 0.0])
    limbs = tuple(
        replace(
            limb,
            long_axis=at[limb.name] @ limb.long_axis,
            marker_positions=limb.marker_positions @ at[limb.name].T + offset,
        )
        for limb in skeleton.limbs
    )
    joints = tuple(
        replace(
            joint,
            centre_in_parent=at[joint.parent] @ joint.centre_in_parent + offset,
            centre_in_child=at[joint.child] @ joint.centre_in_child + offset,
            axes=None if joint.axes is None else joint.axes @ at[joint.parent].T,
            rest=None if joint.rest is None else at[joint.parent] @ joint.rest @ at[joint.child].T,
        )
        for joint in skeleton.joints
    )
    rotations = motion.rotations @ np.swapaxes(turns, -1, -2)
    return replace(
        motion,
        skeleton=replace(skeleton, limbs=limbs, joints=joints),
        rotations=rotations,
        origins=motion.origins - rotations @ offset,
    )


def noisy(motion, rng, degrees=0.0, metres=0.0):
    """Return a motion with orientations and origins wrong, differently in every frame."""
    n, m = motion.rotations.shape[:2]
    wrong = Rotation.from_rotvec(rng.normal(0, np.deg2rad(degrees), (n * m, 3))).as_matrix()
    return replace(
        motion,
        rotations=motion.rotations @ wrong.reshape(n, m, 3, 3),
        origins=motion.origins + rng.normal(0, metres, motion.origins.shape),
    )


@pytest.fixture
def turns(motion, rng):
    """Return a turn of some 20° for every limb."""
    n = len(motion.skeleton.limbs)
    return Rotation.from_rotvec(rng.normal(0, np.deg2rad(12), (n, 3))).as_matrix()


def worst(found, when="after"):
    return max(getattr(p, when).rmsd for p in found.parameters if getattr(p, when) is not None)


def test_a_motion_agrees_with_itself_exactly(performance):
    for side in (performance.motion, performance.parameters):
        found = compare(side, side)
        assert found.offset.seconds == 0
        assert len(found.times) == side.n_frames
        assert worst(found) == pytest.approx(0, abs=1e-12)
        assert worst(found, "before") == pytest.approx(0, abs=1e-12)
        assert found.world.turn == pytest.approx(0, abs=EXACT)
        assert max(j.centre for j in found.joints) == pytest.approx(0, abs=EXACT)
        assert max(limb.turn for limb in found.limbs) == pytest.approx(0, abs=EXACT)
        assert not found.limbs_only_first
        assert not found.joints_only_second


def test_another_world_and_other_frames_are_found_and_taken_out(motion, turns):
    other = in_another_world(in_other_frames(motion, turns), WORLD, SHIFT)
    found = compare(motion, other)
    assert found.offset.seconds == 0
    assert_allclose(found.world.rotation, WORLD.inv().as_matrix(), atol=EXACT)
    assert_allclose(found.world.shift, -(WORLD.inv().as_matrix() @ SHIFT), atol=EXACT)
    for limb in found.limbs:
        i = motion.skeleton.limb_names.index(limb.limb)
        assert_allclose(limb.rotation, turns[i], atol=EXACT)
        assert limb.spread < EXACT
    assert worst(found) < EXACT
    assert max(j.centre for j in found.joints) < EXACT
    # before, the frames' turns are all there is, and they are not small
    hip = next(j for j in found.joints if j.name == "left_hip")
    assert hip.orientation_before > np.deg2rad(5)
    assert hip.orientation_after < EXACT


def test_a_centre_put_elsewhere_is_told_as_constant(motion):
    skeleton = motion.skeleton
    j = skeleton.joint_names.index("left_knee")
    moved = replace(
        skeleton.joints[j],
        centre_in_parent=skeleton.joints[j].centre_in_parent + np.array([0.0, 0.03, 0.0]),
    )
    joints = (*skeleton.joints[:j], moved, *skeleton.joints[j + 1 :])
    found = compare(motion, replace(motion, skeleton=replace(skeleton, joints=joints)))
    knee = next(joint for joint in found.joints if joint.name == "left_knee")
    assert knee.centre_constant == pytest.approx(0.03, abs=3e-3)  # the fit takes some of it
    assert knee.centre_after < 2e-3


@pytest.mark.parametrize("late", [0, 37, 410])
def test_frames_cut_off_are_the_offset(motion, late):
    found = compare(motion, part(motion, slice(late, None)))
    assert found.offset.seconds == pytest.approx(-late / RATE, abs=1e-12)
    assert len(found.times) == motion.n_frames - late
    assert found.times[0] == pytest.approx(late / RATE)
    assert worst(found) < EXACT
    other_way = compare(part(motion, slice(late, None)), motion)
    assert other_way.offset.seconds == pytest.approx(late / RATE, abs=1e-12)


@pytest.mark.parametrize("quarter", [1, 2, 3])
def test_an_offset_between_frames_is_found_to_a_tenth_of_one(motion, quarter):
    """Every fourth frame, once from the first and once from a later one: 25 Hz."""
    one, other = part(motion, slice(0, None, 4), 25.0), part(motion, slice(quarter, None, 4), 25.0)
    found = compare(one, other)
    assert found.offset.seconds * 25 == pytest.approx(-quarter / 4, abs=0.1)


@pytest.mark.parametrize("quarter", [0, 1, 2])
def test_noise_and_other_frames_leave_the_offset_to_a_tenth_of_a_frame(motion, turns, rng, quarter):
    one = noisy(part(motion, slice(0, None, 4), 25.0), rng, 1.0, 0.002)
    other = in_another_world(
        in_other_frames(part(motion, slice(80 + quarter, None, 4), 25.0), turns), WORLD, SHIFT
    )
    found = compare(one, noisy(other, rng, 1.0, 0.002))
    assert found.offset.seconds * 25 == pytest.approx(-20 - quarter / 4, abs=0.1)
    assert found.world.turn == pytest.approx(WORLD.magnitude(), abs=np.deg2rad(0.2))
    bends = [p for p in found.parameters if p.kind == "bend"]
    assert max(p.after.rmsd for p in bends) < np.deg2rad(4)


def test_noise_is_measured_as_it_is(motion, rng):
    """Two noises of 1° about each axis: 2.4° between the limbs of two records of a joint."""
    found = compare(noisy(motion, rng, 1.0), noisy(motion, rng, 1.0), offset=0.0)
    for joint in found.joints:
        # two limbs on two sides, three axes each, 1° each
        assert np.rad2deg(joint.orientation_after) == pytest.approx(np.sqrt(12), rel=0.05)
    pelvis = found.parameter("trunk", "anterior_tilt").after
    assert np.rad2deg(pelvis.sd) == pytest.approx(np.sqrt(2), rel=0.1)
    assert pelvis.n_effective > 0.8 * pelvis.n  # white noise


def test_different_rates_are_brought_to_the_slower(motion):
    slow = part(motion, slice(30, None, 4), 25.0)
    found = compare(motion, slow)
    assert found.rate == pytest.approx(25.0)
    assert found.offset.seconds == pytest.approx(-0.3, abs=0.004)
    other_way = compare(slow, motion)
    assert other_way.rate == pytest.approx(25.0)
    assert other_way.offset.seconds == pytest.approx(-found.offset.seconds, abs=1e-9)
    assert worst(compare(motion, slow, offset=-0.3)) < EXACT


def test_the_other_way_round_has_the_other_sign(motion, rng):
    other = noisy(motion, rng, 0.5)
    there, back = compare(motion, other), compare(other, motion)
    assert back.offset.seconds == -there.offset.seconds
    for p in there.parameters:
        q = back.parameter(p.joint, p.name)
        if p.kind == "own":  # each way about the axes of the first, here the same
            continue
        assert q.before.bias == pytest.approx(-p.before.bias, abs=EXACT)
        assert q.before.rmsd == pytest.approx(p.before.rmsd, abs=EXACT)
        assert q.after.rmsd == pytest.approx(p.after.rmsd, abs=np.deg2rad(0.05))
    for j, k in zip(there.joints, back.joints, strict=True):
        assert k.orientation_after == pytest.approx(j.orientation_after, abs=EXACT)
        assert k.centre == pytest.approx(j.centre, abs=EXACT)


def test_moving_both_worlds_changes_nothing(motion, rng):
    other = noisy(motion, rng, 0.5, 0.002)
    one = compare(motion, other)
    two = compare(
        in_another_world(motion, WORLD, SHIFT),
        in_another_world(other, Rotation.from_euler("y", 200, degrees=True), -SHIFT),
    )
    for p in one.parameters:
        if p.joint == "trunk":  # stands in the laboratory, which was turned
            continue
        q = two.parameter(p.joint, p.name)
        assert q.after.rmsd == pytest.approx(p.after.rmsd, abs=1e-7)
    assert two.world.residual == pytest.approx(one.world.residual, abs=EXACT)


def test_a_known_change_of_one_angle_is_that_change(performance):
    parameters = performance.parameters
    j = parameters.skeleton.joint_names.index("left_knee")
    angles = np.array(parameters.angles)
    times = parameters.times
    wave = np.deg2rad(4) * np.sin(2 * np.pi * times / 5)
    angles[:, j, 0] += wave
    changed = replace(parameters, angles=angles)
    found = compare(parameters, changed, offset=0.0)
    knee = found.parameter("left_knee", "axis1")
    assert np.rad2deg(knee.before.rmsd) == pytest.approx(4 / np.sqrt(2), rel=1e-3)
    assert np.rad2deg(knee.after.rmsd) == pytest.approx(4 / np.sqrt(2), rel=0.02)
    assert knee.after.n_effective < 100  # of 3000 frames: six waves
    assert np.rad2deg(found.parameter("right_knee", "axis1").after.rmsd) < 1e-6


def test_gaps_stay_out_and_limbs_missing_are_said(motion):
    names = motion.skeleton.limb_names
    rotations, flags = np.array(motion.rotations), np.array(motion.flags)
    shank = names.index("left_shank")
    rotations[100:900, shank] = np.nan
    flags[100:900, shank] = PoseFlag.UNSEEN
    origins = np.array(motion.origins)
    origins[100:900, shank] = np.nan
    gappy = replace(motion, rotations=rotations, origins=origins, flags=flags)
    found = compare(gappy, motion)
    assert found.offset.seconds == 0
    knee = found.parameter("left_knee", "flexion").after
    assert knee.n == motion.n_frames - 800
    assert knee.rmsd < EXACT
    skeleton = motion.skeleton
    keep = [i for i, n in enumerate(names) if n not in ("left_hand", "right_hand")]
    shorter = replace(
        motion,
        skeleton=replace(
            skeleton,
            limbs=tuple(skeleton.limbs[i] for i in keep),
            joints=tuple(skeleton.joints[i - 1] for i in keep[1:]),
        ),
        rotations=motion.rotations[:, keep],
        origins=motion.origins[:, keep],
        residuals=motion.residuals[:, keep],
        flags=motion.flags[:, keep],
    )
    found = compare(shorter, motion)
    gone = set(names) - {names[i] for i in keep}
    assert set(found.limbs_only_second) == gone
    assert found.limbs_only_first == ()
    assert worst(found) < EXACT


def test_unrelated_motions_are_refused_and_compared_only_on_demand(motion):
    other = make_performance(
        np.random.default_rng(8), rate=50.0, calibration_s=0.0, free_s=30.0
    ).motion
    with pytest.raises(DegenerateMotion, match="not two records of one motion"):
        compare(motion, other)
    found = compare(motion, other, offset=0.0)
    assert any("do not bend alike" in warning for warning in found.warnings)


def test_what_cannot_be_compared_is_refused(motion, performance):
    with pytest.raises(DegenerateMotion, match="no moment in common"):
        compare(motion, motion, offset=1e4)
    with pytest.raises(BadSetting, match="finite"):
        compare(motion, motion, offset=float("nan"))
    with pytest.raises(BadRecording, match="Recording cannot be compared"):
        compare(performance.recording, motion)
    skeleton = motion.skeleton
    strange = replace(
        motion,
        skeleton=replace(
            skeleton, joints=tuple(replace(j, name=f"x_{j.name}") for j in skeleton.joints)
        ),
    )
    with pytest.raises(DegenerateMotion, match="no joint has the same name"):
        compare(motion, strange)
    unseen = replace(motion, rotations=np.full_like(motion.rotations, np.nan))
    with pytest.raises(BadRecording, match="no limb has a pose"):
        compare(motion, unseen)


def test_one_frame_and_a_still_person_take_no_offset_and_say_so(motion, turns):
    one = part(motion, slice(0, 1))
    found = compare(one, in_other_frames(one, turns))
    assert found.offset.seconds == 0
    assert any("hardly anything moves" in warning for warning in found.warnings)
    assert worst(found) < EXACT
    still = part(motion, np.zeros(50, dtype=int))
    assert compare(still, still).offset.seconds == 0
    assert compare(motion, one).parameter("left_knee", "bend").after.n == 1


def test_one_arm_that_is_lost_does_not_turn_the_body(motion):
    """The left elbow's and wrist's centres half a metre off: everything else stays in place."""
    arm = [motion.skeleton.limb_names.index(n) for n in ("left_upper_arm", "left_forearm")]
    origins = np.array(motion.origins)
    origins[:, arm] += [0.5, 0.2, -0.3]
    found = compare(motion, replace(motion, origins=origins))
    assert found.world.turn < np.deg2rad(0.05)
    assert np.linalg.norm(found.world.shift) < 1e-3
    at = {joint.name: joint for joint in found.joints}
    assert at["left_elbow"].centre == pytest.approx(np.sqrt(0.38), rel=0.01)
    assert at["right_elbow"].centre < 2e-3


def test_ill_conditioned_frames_are_left_out_of_the_angles_they_spoil(performance):
    """An arm that hangs for the first 15 s: its elevation counts, its plane does not."""
    motion = performance.motion
    names = motion.skeleton.limb_names
    rotations = np.array(motion.rotations)
    hanging = slice(0, 1500)
    rotations[hanging, names.index("left_upper_arm")] = rotations[hanging, names.index("trunk")]
    changed = replace(motion, rotations=rotations)
    found = compare(changed, changed)
    plane = found.parameter("left_shoulder", "plane_of_elevation").after
    assert plane.n <= motion.n_frames - 1500
    assert found.parameter("left_shoulder", "elevation").after.n == motion.n_frames
    assert any("left_shoulder" in w and "left out" in w for w in found.warnings)
    parameters = performance.parameters
    j = parameters.skeleton.joint_names.index("left_hip")
    assert parameters.skeleton.joints[j].n_axes == 2
    angles = np.array(parameters.angles)
    angles[:300, j, 0] = np.pi / 2  # the limb lies along the other axis
    edge = replace(parameters, angles=angles)
    assert compare(edge, edge).parameter("left_hip", "axis1").after.n < motion.n_frames - 290


def test_twists_nobody_knows_are_not_compared(motion):
    """A head that spins about itself where its twist is unknown; where it is known it agrees."""
    head = motion.skeleton.limb_names.index("head")
    rotations, flags = np.array(motion.rotations), np.array(motion.flags)
    spin = rotation_about(np.array([0.0, 1.0, 0.0]), np.linspace(0, 40, 600))
    rotations[200:800, head] = rotations[200:800, head] @ spin
    flags[200:800, head] = PoseFlag.TWIST_UNKNOWN
    found = compare(motion, replace(motion, rotations=rotations, flags=flags))
    neck = found.parameter("neck", "left_rotation").after
    assert neck.n == motion.n_frames - 600
    assert neck.rmsd < EXACT
    flags[:, head] = PoseFlag.TWIST_UNKNOWN
    found = compare(motion, replace(motion, rotations=rotations, flags=flags))
    assert found.parameter("neck", "bend").after.n == motion.n_frames
    assert any("nothing tells the twist of head on the second" in w for w in found.warnings)


def test_correlations_with_gaps_are_those_of_a_loop(rng):
    first, second = rng.normal(size=(23, 2)) + 5, rng.normal(size=(17, 2)) - 3
    first[rng.random(first.shape) < 0.2] = np.nan
    second[4:7] = np.nan
    lags, found = pooled_correlation(first, second)
    for lag, value in zip(lags.astype(int), found, strict=True):
        if np.isnan(value):
            continue
        top = left = right = 0.0
        for a, b in zip(first.T, second.T, strict=True):
            pairs = [
                (a[i + lag], b[i])
                for i in range(17)
                if 0 <= i + lag < 23 and np.isfinite(a[i + lag] + b[i])
            ]
            x, y = np.array(pairs).T
            top += ((x - x.mean()) * (y - y.mean())).sum()
            left += ((x - x.mean()) ** 2).sum()
            right += ((y - y.mean()) ** 2).sum()
        assert value == pytest.approx(top / np.sqrt(left * right), abs=1e-9)
    assert np.isfinite(found).sum() > 10


def test_a_time_between_frames_is_seen_only_where_both_are(motion):
    rotations = np.array(motion.rotations[:20])
    rotations[7] = np.nan
    side = side_from(replace(part(motion, slice(0, 20)), rotations=rotations))
    frames = np.array([5.0, 6.0, 6.4, 7.4, 8.0, 8.5])
    there = np.isfinite(sampled(side, frames / RATE).motion.rotations).all(axis=(1, 2, 3))
    assert there.tolist() == [True, True, False, False, True, True]
    halfway = sampled(side, np.array([2.5]) / RATE).motion.rotations[0]
    ends = [Rotation.from_matrix(rotations[k]) for k in (2, 3)]
    middle = Rotation.from_matrix(halfway)
    for k in (0, 1):
        assert_allclose(
            (ends[k].inv() * middle).magnitude(), (ends[0].inv() * ends[1]).magnitude() / 2
        )


def test_a_body_in_one_piece_is_compared_with_one_that_has_a_pelvis(motion):
    """The same motion, its trunk split in two that move as one: hips agree, and it is said."""
    skeleton = motion.skeleton
    trunk, *others = skeleton.limbs
    pelvis = replace(
        trunk, name="pelvis", parent=None, markers=(), marker_positions=np.empty((0, 3))
    )
    hips = ("left_thigh", "right_thigh")
    limbs = (
        pelvis,
        replace(trunk, parent="pelvis"),
        *(replace(limb, parent="pelvis") if limb.name in hips else limb for limb in others),
    )
    lumbar = replace(
        skeleton.joint("neck"),
        name="lumbar",
        parent="pelvis",
        child="trunk",
        centre_in_parent=[0.0, 0.1, 0.0],
        centre_in_child=[0.0, 0.1, 0.0],
    )
    joints = tuple(replace(j, parent="pelvis") if j.child in hips else j for j in skeleton.joints)
    columns = [0, *range(len(skeleton.limbs))]
    split = replace(
        motion,
        skeleton=replace(skeleton, limbs=limbs, joints=(lumbar, *joints)),
        rotations=motion.rotations[:, columns],
        origins=motion.origins[:, columns],
        residuals=motion.residuals[:, columns],
        flags=motion.flags[:, columns],
    )
    found = compare(motion, split)
    assert found.limbs_only_second == ("pelvis",)
    assert found.joints_only_second == ("lumbar",)
    assert any("left_hip hangs from trunk here and from pelvis there" in w for w in found.warnings)
    assert found.parameter("left_hip", "flexion").after.rmsd < EXACT
    assert {limb.other for limb in found.limbs if limb.limb == "trunk"} == {"trunk", "pelvis"}
