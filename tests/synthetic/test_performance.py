"""A performance keeps its promises: the truth is one, consistent and anatomical."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.testing import assert_allclose, assert_array_equal

from kinesphere.data import motion_from_parameters
from kinesphere.errors import BadSetting
from kinesphere.geometry.rotations import rotation_about
from kinesphere.synthetic import HUMAN, make_actor, make_performance
from kinesphere.synthetic.movement import smooth_step

EXACT = 1e-12  # m; a dozen multiplications of numbers near 1
SHORT = {
    "rate": 25.0,
    "calibration_s": 20.0,
    "free_s": 7.0,
    "repetitions": 1,
}  # quick, yet every phase is there
SEEDS = st.integers(0, 2**32 - 1)
LAYOUTS = ("bodies", "cmu41")


def lengthwise(limb):
    """Return the direction in which a limb's joint and markers spread most."""
    points = np.vstack([limb.marker_positions, -limb.length / 2 * limb.long_axis])
    return np.linalg.svd(points - points.mean(axis=0))[2][0]


@pytest.fixture(scope="module")
def performance():
    return make_performance(np.random.default_rng(7), **SHORT)


@pytest.mark.parametrize("layout", LAYOUTS)
def test_markers_are_where_the_true_motion_puts_them(rng, layout):
    performance = make_performance(rng, layout=layout, **SHORT)
    placed = motion_from_parameters(performance.parameters).marker_positions()
    assert performance.recording.labels == tuple(placed)
    for m, label in enumerate(placed):
        assert_allclose(performance.recording.markers[:, m], placed[label], atol=EXACT)
    assert performance.recording.seen.all()


def test_motion_is_what_the_parameters_say(performance):
    motion = motion_from_parameters(performance.parameters)
    assert_allclose(performance.motion.rotations, motion.rotations, atol=EXACT)
    assert_allclose(performance.motion.origins, motion.origins, atol=EXACT)


def test_joints_never_come_apart(performance):
    motion, skeleton = performance.motion, performance.skeleton
    at = {name: i for i, name in enumerate(skeleton.limb_names)}
    for j, joint in enumerate(skeleton.joints):
        p, c = at[joint.parent], at[joint.child]
        by_parent = motion.origins[:, p] + motion.rotations[:, p] @ joint.centre_in_parent
        by_child = motion.origins[:, c] + motion.rotations[:, c] @ joint.centre_in_child
        assert_allclose(by_parent, by_child, atol=EXACT)
        assert_allclose(performance.joint_centres[:, j], by_parent, atol=EXACT)


def test_angles_stay_within_the_limits_and_use_them(performance):
    low, high = performance.actor.limits[..., 0], performance.actor.limits[..., 1]
    angles = np.concatenate(
        [performance.parameters.angles, performance.parameters.twists[..., None]], axis=2
    )
    assert_array_equal(np.isnan(angles), np.broadcast_to(np.isnan(low), angles.shape))
    known = np.isfinite(low)
    assert (angles >= low)[:, known].all()
    assert (angles <= high)[:, known].all()
    stuck = (angles == low) | (angles == high)
    assert not stuck.any(), "limits are kept by the motion, not by cutting it off"
    used = np.ptp(angles, axis=0) / (high - low)
    assert np.nanmin(used[:, :3]) > 0.5
    assert np.nanmin(used[:, 3]) > 0.2  # twists only in the few seconds of free motion


@given(seed=SEEDS, low=st.floats(60, 90), cone=st.floats(60, 90))
@settings(deadline=None, max_examples=15)
def test_axes_enclose_the_angles_asked_for(seed, low, cone):
    performance = make_performance(
        np.random.default_rng(seed),
        axes_deg=(low, low + 30),
        cone_deg=(cone, 180 - cone),
        calibration_s=0,
        n_frames=1,
    )
    slack = 1e-6  # deg, of the arc cosine
    for joint in performance.skeleton.joints:
        assert_allclose(np.linalg.norm(joint.axes, axis=1), 1, atol=EXACT)
        limb = performance.skeleton.limb(joint.child)
        to_limb = np.rad2deg(np.arccos(joint.axes @ joint.rest @ limb.long_axis))
        assert np.all((to_limb >= cone - slack) & (to_limb <= 180 - cone + slack)), joint.name
        if joint.n_axes == 2:
            between = np.rad2deg(np.arccos(joint.axes[0] @ joint.axes[1]))
            assert low - slack <= between <= low + 30 + slack, joint.name


@given(seed=SEEDS)
@settings(deadline=None, max_examples=10)
def test_axes_are_close_to_where_anatomy_has_them(seed):
    """About the limb, the proximal axis is turned at most 12 deg from nominal; sides a bit more."""
    actor = make_actor(np.random.default_rng(seed))
    at = {name: i for i, name in enumerate(actor.skeleton.limb_names)}
    for joint, plan in zip(actor.skeleton.joints, actor.plan.limbs[1:], strict=True):
        limb = actor.body_from_limb[at[joint.child]] @ plan.canonical
        across = np.eye(3) - np.outer(limb, limb)
        found = across @ actor.body_from_limb[at[joint.parent]] @ joint.axes[-1]
        nominal = across @ plan.movements[-1].about
        cosine = found @ nominal / np.linalg.norm(found) / np.linalg.norm(nominal)
        assert np.rad2deg(np.arccos(min(cosine, 1))) <= 12 + 1e-6, joint.name


def test_movements_go_where_their_names_say():
    """A quarter of each movement's range takes the limb's end the way anatomy means."""
    forward, up, outward = 0, 1, 2
    ways = {
        "shoulder": [(outward, 1), (forward, 1)],
        "elbow": [(forward, 1)],
        "hip": [(outward, 1), (forward, 1)],
        "knee": [(forward, -1)],
        "ankle": [(outward, 1), (up, 1)],
        "neck": [(outward, 1), (forward, 1)],  # in the middle, outward is to the right
    }
    actor = make_actor(np.random.default_rng(1))
    at = {name: i for i, name in enumerate(actor.skeleton.limb_names)}
    for joint in actor.skeleton.joints:
        side = joint.name.partition("_")[0]
        outward_sign = -1 if side == "left" else 1
        body_from_parent = actor.body_from_limb[at[joint.parent]]
        start = joint.rest @ actor.skeleton.limb(joint.child).long_axis
        for axis, (way, sign) in zip(joint.axes, ways[joint.name.split("_")[-1]], strict=True):
            went = body_from_parent @ (rotation_about(axis, np.array(0.3)) @ start - start)
            went *= [1, 1, outward_sign]
            assert sign * went[way] > 0.2, f"{joint.name} {way}"  # the sine of 0.3 is 0.296


@given(seed=SEEDS)
@settings(deadline=None, max_examples=10)
def test_a_body_keeps_its_proportions(seed):
    actor = make_actor(np.random.default_rng(seed))
    skeleton = actor.skeleton
    for limb, plan in zip(skeleton.limbs, actor.plan.limbs, strict=True):
        assert limb.length == pytest.approx(plan.length * actor.size, rel=0.08)
        twin = limb.name.replace("left_", "right_")
        assert limb.length == pytest.approx(skeleton.limb(twin).length, rel=0.025)
    trunk = skeleton.limbs[0].length
    for name, height, breadth in (("hip", 0.0, 0.050), ("shoulder", 0.288, 0.115)):
        left, right = (skeleton.joint(f"{s}_{name}").centre_in_parent for s in ("left", "right"))
        assert left[1] + trunk / 2 == pytest.approx(height / 0.310 * trunk)
        assert_allclose(right, left * [1, 1, -1], atol=EXACT)
        assert right[2] == pytest.approx(breadth / 0.310 * trunk)
    for joint in skeleton.joints:
        child = skeleton.limb(joint.child)
        assert_allclose(joint.centre_in_child, -child.length / 2 * child.long_axis, atol=EXACT)


def test_legs_and_arms_swing_in_turn():
    limbs = {limb.name: limb for limb in HUMAN.limbs}
    for kind in ("thigh", "shank", "foot", "upper_arm"):
        for left, right in zip(
            limbs[f"left_{kind}"].movements, limbs[f"right_{kind}"].movements, strict=True
        ):
            assert (right.gait[2] - left.gait[2]) % 1 == pytest.approx(0.5)


def test_the_sides_mirror_each_other_nearly_but_not_quite(performance):
    mirror = np.diag([1.0, 1.0, -1.0])
    for joint in performance.skeleton.joints:
        if joint.name.startswith("left_"):
            other = performance.skeleton.joint(joint.name.replace("left_", "right_"))
            off = np.linalg.norm(joint.axes @ -mirror - other.axes, axis=1)
            assert 1e-4 < off.max() < 0.35, joint.name  # 20 deg
            cones = [
                one.axes @ one.rest @ performance.skeleton.limb(one.child).long_axis
                for one in (joint, other)
            ]
            assert np.abs(cones[0] + cones[1]).max() > 1e-4, joint.name


@given(seed=SEEDS)
@settings(deadline=None, max_examples=10)
def test_it_starts_standing(seed):
    performance = make_performance(
        np.random.default_rng(seed), calibration_s=12, free_s=0, rate=10, sway_deg=0
    )
    names = performance.skeleton.limb_names
    body_from_world = performance.motion.rotations[0, 0].T
    points = (performance.motion.origins[0] - performance.motion.origins[0, 0]) @ body_from_world.T
    at = {name: points[i] for i, name in enumerate(names)}
    size = performance.actor.size
    assert at["head"][1] > 0.15 * size
    assert at["left_foot"][1] < -0.5 * size
    assert performance.motion.rotations[0, 0, 1, 1] > 0.99  # the trunk is upright
    for kind in ("upper_arm", "forearm", "thigh", "shank", "foot"):
        assert at["left_" + kind][2] < -0.01, "the body's z points to its right"
        assert at["right_" + kind][2] > 0.01
    for side, outward in (("left", -1), ("right", 1)):
        arm = performance.actor.body_from_limb[names.index(f"{side}_upper_arm")] @ [0, -1, 0]
        assert 0.05 < arm[2] * outward < 0.3, "arms hang a little off the body"
    for side in ("left", "right"):
        i = names.index(f"{side}_foot")
        ahead = body_from_world @ performance.motion.rotations[0, i] @ [1, 0, 0]
        assert ahead[0] > 0.9, "feet point forward"
    heights = performance.recording.markers[0, :, 1]
    assert heights.min() > -0.12
    assert abs(heights.max() - size) < 0.2


def test_limb_frames_of_the_default_position_are_least_turns_of_the_body(rng):
    performance = make_performance(rng, calibration_s=12, free_s=0, rate=10, sway_deg=0)
    body = performance.motion.rotations[0, 0]
    for i, limb in enumerate(performance.skeleton.limbs):
        turn = body.T @ performance.motion.rotations[0, i]
        about = np.array(
            [turn[2, 1] - turn[1, 2], turn[0, 2] - turn[2, 0], turn[1, 0] - turn[0, 1]]
        )
        assert abs(about @ limb.long_axis) < EXACT, f"{limb.name} twists against the body"


def test_limbs_move_one_after_another_with_rests_between(performance):
    start, end = performance.calibration
    times = performance.recording.times
    moving = performance.moving_about[(times >= start) & (times < end)]
    joints = performance.skeleton.joint_names
    axes_at_once = moving.sum(axis=2)
    assert axes_at_once.max() == 1
    together = {frozenset(np.flatnonzero(frame)) for frame in moving.any(axis=2)}
    names = {frozenset(joints[j] for j in group) for group in together}
    assert frozenset() in names, "there are rests"
    assert {"left_elbow", "right_elbow"} in names
    assert all(len({name.split("_")[-1] for name in group}) <= 1 for group in names)
    for j, joint in enumerate(performance.skeleton.joints):
        assert_array_equal(moving[:, j].any(axis=0), np.arange(3) < joint.n_axes)
    assert not moving[times[: len(moving)] < 2.9].any(), "it stands first"


def test_every_calibration_movement_uses_its_range_as_often_as_asked():
    performance = make_performance(
        np.random.default_rng(2), calibration_s=60, free_s=0, repetitions=3, sway_deg=0
    )
    for j, joint in enumerate(performance.skeleton.joints):
        for k in range(joint.n_axes):
            low, high = performance.actor.limits[j, k]
            angle = performance.parameters.angles[:, j, k]
            far = angle > 0.75 * high
            assert np.diff(far.astype(int)).tolist().count(1) == 3, f"{joint.name} axis {k + 1}"
            if np.rad2deg(low) < -15:
                assert np.diff((angle < 0.75 * low).astype(int)).tolist().count(1) == 3
            else:
                assert angle.min() > -EXACT
            rests = angle[~performance.moving_about[:, j, k]]
            assert_allclose(rests, 0, atol=EXACT)


def test_there_are_rests_between_movements(performance):
    times = performance.recording.times
    working = (times > 3) & (times < performance.calibration[1])
    still = ~performance.moving_about.any(axis=(1, 2))
    assert still[working].mean() > 0.1


def test_sway_is_of_the_size_asked_for_and_kept_within_the_limits():
    sway = {"calibration_s": 40.0, "free_s": 0.0, "repetitions": 1}
    performance = make_performance(np.random.default_rng(6), sway_deg=0.5, **sway)
    twists = np.rad2deg(performance.parameters.twists)
    assert np.sqrt((twists**2).mean()) == pytest.approx(0.5, rel=0.15)
    wild = make_performance(np.random.default_rng(6), sway_deg=8, **sway)
    low, high = wild.actor.limits[:, 3, 0], wild.actor.limits[:, 3, 1]
    assert (wild.parameters.twists >= low).all()
    assert (wild.parameters.twists <= high).all()


def test_sway_fades_as_free_motion_begins():
    performance = make_performance(
        np.random.default_rng(6), rate=200, calibration_s=3, free_s=3, sway_deg=3
    )
    free = performance.recording.times > 3
    bends = np.diff(performance.parameters.twists[free], n=2, axis=0)
    assert np.rad2deg(np.abs(bends).max()) < 0.5  # a sway cut off would jump by degrees


def test_movements_start_and_end_gently():
    x = np.linspace(-0.5, 1.5, 401)
    step = smooth_step(x)
    assert_array_equal(step[x <= 0], 0)
    assert_allclose(step[x >= 1], 1, atol=EXACT)
    assert (np.diff(step) >= -EXACT).all()
    assert smooth_step(np.array(0.5)) == pytest.approx(0.5)
    assert np.abs(np.diff(step, n=2)).max() < 2e-4  # minimum jerk: the speed has no corner


def test_the_range_of_motion_is_that_of_the_angles(performance):
    j = performance.skeleton.joint_names.index("left_knee")
    width = np.ptp(performance.parameters.angles[:, j, 0])
    assert 0.5 * width < performance.skeleton.joints[j].range_of_motion < 1.1 * width


def test_feet_stay_on_the_floor(performance):
    """The lower foot is at the height of its sole, softly so while the weight shifts."""
    skeleton, motion = performance.skeleton, performance.motion
    ends = []
    for name in performance.actor.plan.stands_on:
        i = skeleton.limb_names.index(name)
        tip = skeleton.limbs[i].length / 2 * skeleton.limbs[i].long_axis
        ends.append((motion.origins[:, i] + motion.rotations[:, i] @ tip)[:, 1])
    lowest = np.min(ends, axis=0) - performance.actor.plan.sole * performance.actor.size
    assert -0.01 * np.log(4) - EXACT < lowest.min() < -0.001
    assert lowest.max() < EXACT


def test_it_walks_where_it_looks_and_stays_in_the_room():
    long = make_performance(np.random.default_rng(4), rate=10.0, calibration_s=0.0, free_s=300.0)
    places = long.parameters.root_positions[:, [0, 2]]
    steps = np.diff(places, axis=0)
    front = long.parameters.root_rotations[1:, [0, 2], 0]
    speeds = 10.0 * np.linalg.norm(steps, axis=1)
    walking = speeds > 0.3  # m/s
    assert 0.2 < walking.mean() < 0.9
    forward = np.einsum("fi,fi->f", steps, front)[walking]
    assert forward.sum() > 0.95 * np.linalg.norm(steps[walking], axis=1).sum()
    assert speeds.sum() / 10.0 > 50  # m, many times around
    assert np.ptp(places, axis=0).max() < 6  # m


def test_roaming_starts_where_the_calibration_ends(performance):
    calibrating = performance.recording.times < performance.calibration[1]
    ground = performance.motion.origins[:, 0, [0, 2]]
    assert np.ptp(ground[calibrating], axis=0).max() < 0.1
    steps = np.linalg.norm(np.diff(ground, axis=0), axis=1) * performance.recording.rate
    assert steps.max() < 2.0  # m/s


def test_only_the_moving_limb_moves(performance):
    times = performance.recording.times
    calibrating = times < performance.calibration[1]
    still = calibrating[:, None, None] & ~performance.moving_about
    swaying = np.abs(performance.parameters.angles)[
        still & np.isfinite(performance.parameters.angles)
    ]
    assert np.rad2deg(swaying.max()) < 1.0  # sway of 0.2 deg, at most a few times that
    turned = np.abs(performance.parameters.angles)[performance.moving_about]
    assert np.rad2deg(turned.max()) > 80


def test_motion_is_smooth(performance):
    """No marker is faster than a thrown ball's hand, in the hurried calibration of this one."""
    steps = np.linalg.norm(np.diff(performance.recording.markers, axis=0), axis=2)
    assert steps.max() * performance.recording.rate < 8  # m/s


def test_same_generator_same_performance():
    one, two = (make_performance(np.random.default_rng(3), **SHORT) for _ in range(2))
    assert_array_equal(one.recording.markers, two.recording.markers)
    other = make_performance(np.random.default_rng(4), **SHORT)
    assert other.actor.size != one.actor.size


def test_the_cmu_layout_has_its_41_markers(rng):
    performance = make_performance(rng, layout="cmu41", **SHORT)
    assert len(performance.recording.labels) == 41
    owner = {m: s.name for s in performance.model.segments for m in s.markers}
    assert owner["LKNE"] == "left_thigh"
    assert owner["RANK"] == "right_shank"
    assert owner["LSHO"] == "trunk"
    assert owner["RFIN"] == "right_forearm"
    right_of_body = performance.motion.rotations[0, 0] @ [0, 0, 1]
    for left, right in performance.model.mirror:
        assert left[0] == "L"
        assert right == "R" + left[1:]
        apart = np.diff(
            performance.recording.markers[0, performance.recording.columns((left, right))], axis=0
        )
        assert (apart @ right_of_body)[0] > 0, f"{left} is on the left of {right}"


def test_marker_bodies_are_bodies(rng):
    performance = make_performance(rng, n_frames=1, calibration_s=0)
    for limb in performance.skeleton.limbs:
        assert 3 <= len(limb.markers) <= 5
        offsets = limb.marker_positions - limb.marker_positions.mean(axis=0)
        spread = np.sqrt((offsets**2).sum(axis=1).mean())
        assert 0.05 - EXACT <= spread <= 0.10 + EXACT
        assert np.linalg.svd(offsets, compute_uv=False)[1] > 0.01, f"{limb.name}: in a line"


@given(seed=SEEDS)
@settings(deadline=None, max_examples=8)
def test_markers_tell_where_a_limb_at_the_end_of_a_chain_points(seed):
    performance = make_performance(np.random.default_rng(seed), n_frames=1, calibration_s=0)
    carriers = {limb.parent for limb in performance.skeleton.limbs}
    for limb in performance.skeleton.limbs:
        gaps = np.linalg.norm(limb.marker_positions[:, None] - limb.marker_positions, axis=2)
        assert gaps[gaps > 0].min() > 0.017, f"{limb.name}: two markers on one spot"
        if limb.name in carriers:
            continue
        from_joint = limb.marker_positions + limb.length / 2 * limb.long_axis
        assert_allclose(np.cross(from_joint.mean(axis=0), limb.long_axis), 0, atol=EXACT)
        assert from_joint.mean(axis=0) @ limb.long_axis > 0
        assert_allclose(np.cross(lengthwise(limb), limb.long_axis), 0, atol=EXACT)


@given(seed=SEEDS)
@settings(deadline=None, max_examples=5)
def test_cmu_markers_sit_where_anatomy_says(seed):
    performance = make_performance(
        np.random.default_rng(seed), layout="cmu41", n_frames=1, calibration_s=0
    )
    at = dict(zip(performance.recording.labels, performance.recording.markers[0], strict=True))
    centre = dict(zip(performance.skeleton.joint_names, performance.joint_centres[0], strict=True))
    for side, name in (("L", "left"), ("R", "right")):
        for label, joint in (
            ("KNE", "knee"),
            ("ANK", "ankle"),
            ("ELB", "elbow"),
            ("SHO", "shoulder"),
        ):
            off = np.linalg.norm(at[side + label] - centre[f"{name}_{joint}"])
            assert 0.01 < off < 0.09, side + label
        foot = performance.skeleton.limb(f"{name}_foot")
        assert_allclose(np.cross(lengthwise(foot), foot.long_axis), 0, atol=EXACT)
        forearm = performance.skeleton.limb_names.index(f"{name}_forearm")
        axis = performance.motion.rotations[0, forearm] @ [0, -1, 0]
        for point in ((at[side + "WRA"] + at[side + "WRB"]) / 2, at[side + "FIN"]):
            off = point - centre[f"{name}_elbow"]
            assert_allclose(np.cross(off, axis), 0, atol=EXACT)
    assert (
        at["LFHD"][1] > at["C7"][1] > at["T10"][1] > at["LFWT"][1] > at["LKNE"][1] > at["LTOE"][1]
    )


def test_frames_can_be_counted_instead(rng):
    performance = make_performance(rng, calibration_s=10, rate=20, n_frames=331)
    assert performance.recording.n_frames == 331
    assert performance.calibration == (0, 10)


@pytest.mark.parametrize(
    ("wrong", "match"),
    [
        ({"n_frames": 100}, "calibration alone takes 3000 frames"),
        ({"rate": 0.0}, "rate 0.0 Hz"),
        ({"free_s": -1.0}, "must not be negative"),
        ({"axes_deg": (50.0, 70.0)}, "within 60–120"),
        ({"cone_deg": (100.0, 80.0)}, "cone_deg is 100.0–80.0"),
        ({"layout": "cmu53"}, "known are bodies, cmu41"),
    ],
)
def test_what_cannot_be_is_refused(rng, wrong, match):
    with pytest.raises(BadSetting, match=match):
        make_performance(rng, **wrong)
