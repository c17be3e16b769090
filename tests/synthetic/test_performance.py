"""A performance keeps its promises: the truth is one, consistent and anatomical."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.testing import assert_allclose, assert_array_equal

from kinesphere.data import motion_from_parameters
from kinesphere.errors import BadSetting
from kinesphere.synthetic import make_performance

EXACT = 1e-12  # m; a dozen multiplications of numbers near 1
SHORT = {
    "rate": 25.0,
    "calibration_s": 20.0,
    "free_s": 7.0,
    "repetitions": 1,
}  # quick, yet every phase is there
SEEDS = st.integers(0, 2**32 - 1)
LAYOUTS = ("bodies", "cmu41")


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


def test_the_sides_mirror_each_other_nearly_but_not_quite(performance):
    mirror = np.diag([1.0, 1.0, -1.0])
    for joint in performance.skeleton.joints:
        if joint.name.startswith("left_"):
            other = performance.skeleton.joint(joint.name.replace("left_", "right_"))
            off = np.linalg.norm(joint.axes @ -mirror - other.axes, axis=1)
            assert 1e-4 < off.max() < 0.35, joint.name  # 20 deg


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
