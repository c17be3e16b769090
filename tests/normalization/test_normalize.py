"""The whole stage: known frames, and the laws of docs/conventions.md and the paper's section 3."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.testing import assert_allclose
from scipy.spatial.transform import Rotation

from kinesphere.data import PoseFlag, Skeleton
from kinesphere.errors import AmbiguousFacing, BadSetting, DegenerateMotion
from kinesphere.geometry.rotations import rotation_angle
from kinesphere.normalization import NormalizationSettings, normalize
from kinesphere.normalization.averaging import robust_mean_rotations
from kinesphere.normalization.default_frames import _least, find_default_frames
from kinesphere.normalization.proposal import propose_bodies
from kinesphere.normalization.samples import take_samples

EXACT = 1e-9  # rad and m; rounding alone leaves about 1e-14
LOOSE = np.deg2rad(0.5)  # where arms that hang unevenly tilt the plane through the joints
MIRROR = np.diag([1.0, 1.0, -1.0])
PAPER = NormalizationSettings(position="paper", body="plane", limbs="paper", frames="single")


def apart(a, b):
    """Return the largest angle between two stacks of rotations, rad."""
    return rotation_angle(np.swapaxes(a, -1, -2) @ b).max()


def step_of(motion):
    return motion.history[-1]


def moving(tools, rng, n_frames=400, **kwargs):
    """Build a doll that stands for half of the time, then bends everything and turns."""
    ramp = np.concatenate([np.zeros(n_frames // 2), np.linspace(0, 1, n_frames - n_frames // 2)])
    bends = {
        name: ramp[:, None] * rng.normal(scale=0.8, size=3) + rng.normal(scale=0.01, size=3)
        for name in tools.plan
        if name != "pelvis"
    }
    yaw = Rotation.from_rotvec(np.outer(np.linspace(0, 2, n_frames), [0.0, 1.0, 0.0])).as_matrix()
    kwargs = {"bends": bends, "world": yaw} | kwargs
    return tools.make_doll(rng, n_frames=n_frames, **kwargs)


def test_frames_are_those_of_the_conventions(doll):
    it = doll(world=Rotation.from_rotvec([0.0, 2.0, 0.0]).as_matrix())
    result = normalize(it.motion)
    assert apart(result.rotations, it.truth) < EXACT
    assert_allclose(result.origins, it.middles, atol=EXACT)


def test_long_axes_are_canonical(doll, tools):
    result = normalize(doll().motion)
    for limb in result.skeleton.limbs:
        assert_allclose(limb.long_axis, tools.plan[limb.name][3], atol=EXACT)


def test_nothing_moves_in_the_world(tools, rng):
    motion = moving(tools, rng).motion
    result = normalize(motion)
    assert_allclose(result.joint_centres(), motion.joint_centres(), atol=EXACT)
    before, after = motion.marker_positions(), result.marker_positions()
    assert before.keys() == after.keys()
    for label in before:
        assert_allclose(after[label], before[label], atol=EXACT)
    for old, new in zip(motion.skeleton.joints, result.skeleton.joints, strict=True):
        parent = motion.skeleton.limb_names.index(old.parent)
        a, b = motion.rotations[0, parent], result.rotations[0, parent]
        assert_allclose(b @ new.covariance @ b.T, a @ old.covariance @ a.T, atol=EXACT)
    assert (result.flags == motion.flags).all()
    assert result.first_frame == motion.first_frame


@pytest.mark.parametrize("chosen", [NormalizationSettings(), PAPER], ids=["default", "paper"])
def test_frames_stay_orthonormal(chosen, tools, rng):
    result = normalize(moving(tools, rng).motion, chosen)
    unit = np.swapaxes(result.rotations, -1, -2) @ result.rotations
    assert_allclose(unit, np.broadcast_to(np.eye(3), unit.shape), atol=1e-12)
    assert_allclose(np.linalg.det(result.rotations), 1.0, atol=1e-12)


@pytest.mark.parametrize("chosen", [NormalizationSettings(), PAPER], ids=["default", "paper"])
def test_twice_is_once(chosen, tools, rng):
    once = normalize(moving(tools, rng).motion, chosen)
    twice = normalize(once, chosen)
    assert_allclose(twice.rotations, once.rotations, atol=EXACT)
    assert_allclose(twice.origins, once.origins, atol=EXACT)
    for a, b in zip(once.skeleton.limbs, twice.skeleton.limbs, strict=True):
        assert_allclose(b.marker_positions, a.marker_positions, atol=EXACT)
        assert_allclose(b.long_axis, a.long_axis, atol=EXACT)
    assert [step.name for step in twice.history] == ["normalization", "normalization"]


@given(seed=st.integers(0, 2**32 - 1))
@settings(deadline=None, max_examples=5)
@pytest.mark.parametrize("chosen", [NormalizationSettings(), PAPER], ids=["default", "paper"])
def test_frames_turn_with_the_floor(chosen, tools, seed):
    rng = np.random.default_rng(seed)
    motion = moving(tools, rng, n_frames=60).motion
    yaw = Rotation.from_rotvec([0.0, rng.uniform(-3, 3), 0.0]).as_matrix()
    shift = 50 * rng.normal(size=3)
    turned = replace(
        motion, rotations=yaw @ motion.rotations, origins=motion.origins @ yaw.T + shift
    )
    plain, other = normalize(motion, chosen), normalize(turned, chosen)
    assert_allclose(other.rotations, yaw @ plain.rotations, atol=EXACT)
    assert_allclose(other.origins, plain.origins @ yaw.T + shift, atol=EXACT)


@pytest.mark.parametrize("chosen", [NormalizationSettings(), PAPER], ids=["default", "paper"])
@pytest.mark.parametrize("scale", [0.4, 1000.0])
def test_size_does_not_matter(chosen, scale, tools, rng):
    motion = moving(tools, rng, n_frames=60).motion
    skeleton = Skeleton(
        tuple(
            replace(x, marker_positions=scale * x.marker_positions, length=scale * x.length)
            for x in motion.skeleton.limbs
        ),
        tuple(
            replace(
                j,
                centre_in_parent=scale * j.centre_in_parent,
                centre_in_child=scale * j.centre_in_child,
            )
            for j in motion.skeleton.joints
        ),
    )
    scaled = replace(motion, skeleton=skeleton, origins=scale * motion.origins)
    plain, other = normalize(motion, chosen), normalize(scaled, chosen)
    assert_allclose(other.rotations, plain.rotations, atol=EXACT)
    assert_allclose(other.origins, scale * plain.origins, atol=scale * EXACT)


def mirrored(motion):
    """Exchange left and right: names and places."""

    def other(name):
        if name is None or "_" not in name:
            return name
        side, rest = name.split("_", 1)
        return {"left": "right", "right": "left"}[side] + "_" + rest

    limbs = tuple(
        replace(
            x,
            name=other(x.name),
            parent=other(x.parent),
            marker_positions=x.marker_positions @ MIRROR,
            long_axis=MIRROR @ x.long_axis,
        )
        for x in motion.skeleton.limbs
    )
    joints = tuple(
        replace(
            j,
            parent=other(j.parent),
            child=other(j.child),
            centre_in_parent=MIRROR @ j.centre_in_parent,
            centre_in_child=MIRROR @ j.centre_in_child,
        )
        for j in motion.skeleton.joints
    )
    return replace(
        motion,
        skeleton=Skeleton(limbs, joints),
        rotations=MIRROR @ motion.rotations @ MIRROR,
        origins=motion.origins @ MIRROR,
    )


@pytest.mark.parametrize("chosen", [NormalizationSettings(), PAPER], ids=["default", "paper"])
def test_a_mirrored_body_has_mirrored_frames(chosen, tools, rng):
    motion = moving(tools, rng, n_frames=60).motion
    plain, other = normalize(motion, chosen), normalize(mirrored(motion), chosen)
    assert_allclose(other.rotations, MIRROR @ plain.rotations @ MIRROR, atol=1e-12)
    assert_allclose(other.origins, plain.origins @ MIRROR, atol=1e-12)


@pytest.mark.parametrize("chosen", [NormalizationSettings(), PAPER], ids=["default", "paper"])
def test_the_order_of_limbs_does_not_matter(chosen, tools, rng):
    motion = moving(tools, rng, n_frames=60).motion
    names = motion.skeleton.limb_names
    order = [0, 1, *(2 + rng.permutation(4)), *range(6, len(names))]
    order = sorted(order, key=lambda i: (depth(motion.skeleton, i), order.index(i)))
    skeleton = Skeleton(
        tuple(motion.skeleton.limbs[i] for i in order),
        tuple(motion.skeleton.joints[i - 1] for i in order[1:]),
    )
    shuffled = replace(
        motion,
        skeleton=skeleton,
        rotations=motion.rotations[:, order],
        origins=motion.origins[:, order],
    )
    assert order != list(range(len(names)))
    plain, other = normalize(motion, chosen), normalize(shuffled, chosen)
    assert_allclose(other.rotations, plain.rotations[:, order], atol=EXACT)


def depth(skeleton, limb):
    return 0 if limb == 0 else 1 + depth(skeleton, skeleton.parents[limb])


def test_the_default_position_is_found_and_told(tools, rng):
    motion = moving(tools, rng).motion
    found = step_of(normalize(motion)).findings
    index = found["default_frame"] - motion.first_frame
    assert 0 <= index < 230
    assert found["default_time_s"] == pytest.approx(index / motion.rate)
    assert found["n_frames_averaged"] == len(found["frames_averaged"]) > 10
    assert found["good_default_position"] is True
    assert found["facing"]["decided_by"] == "names"
    assert found["facing"]["scores"]["feet"] > 0.9
    assert 0 < found["terms"]["arm_angle_deg"] < 30
    assert step_of(normalize(motion)).warnings == ()


def test_many_frames_beat_one(tools, rng):
    """Arms and shoulders that sway in the stance average out; a single frame keeps its sway."""
    sway = {
        name: rng.normal(scale=np.deg2rad(4), size=(300, 3)) for name in tools.plan if "_" in name
    }
    sway["trunk"] = rng.normal(scale=np.deg2rad(2), size=(300, 3))
    it = tools.make_doll(rng, n_frames=300, bends=sway)
    still = NormalizationSettings(speed=10.0)
    error = {}
    for frames in ("many", "single"):
        result = normalize(it.motion, replace(still, frames=frames))
        at = it.motion.rotations[0].swapaxes(-1, -2)
        error[frames] = rotation_angle(
            (at @ result.rotations[0]).swapaxes(-1, -2) @ at @ it.truth[0]
        )
    assert np.mean(error["many"]) < 0.5 * np.mean(error["single"])
    assert np.rad2deg(error["many"].max()) < 2.0


@pytest.mark.parametrize(
    ("turn", "reason"),
    [
        ([np.pi / 2, 0, 0], "lies"),
        ([0, 0, np.pi / 2], "lies"),
        ([np.pi, 0, 0], "upside down"),
        ([0.6, 0, 0], "leans"),
    ],
)
def test_a_body_that_does_not_stand_is_aligned_and_flagged(turn, reason, doll):
    it = doll(world=Rotation.from_rotvec(turn).as_matrix())
    result = normalize(it.motion)
    assert apart(result.rotations, it.truth) < EXACT
    step = step_of(result)
    assert step.findings["good_default_position"] is False
    assert any(reason in warning and "frame 101" in warning for warning in step.warnings)


@pytest.mark.parametrize(("degrees", "said"), [(30.0, False), (55.0, True)])
def test_a_forearm_held_out_is_told_of_somebody_who_stands(degrees, said, doll, tools):
    way = np.sin(np.deg2rad(degrees)), -np.cos(np.deg2rad(degrees)), 0.0
    step = step_of(normalize(doll(stance=tools.stance | {"left_forearm": way}).motion))
    assert step.findings["good_default_position"] is True
    told = [warning for warning in step.warnings if "left_forearm" in warning]
    assert bool(told) == said
    assert not said or f"left_forearm ({degrees:.0f} deg off)" in told[0]


def without_markers(motion, limb, keep):
    """Return the motion with only those of a limb's markers, by place, that are kept."""
    old = motion.skeleton.limb(limb)
    names = tuple(np.array(old.markers)[keep].tolist())
    new = replace(old, markers=names, marker_positions=old.marker_positions[keep])
    limbs = tuple(new if it is old else it for it in motion.skeleton.limbs)
    return replace(motion, skeleton=replace(motion.skeleton, limbs=limbs))


def told_of_heels(motion):
    """Return what is said of feet without a heel, and which these are by the findings."""
    step = step_of(normalize(motion))
    return [w for w in step.warnings if "heel" in w], list(step.findings["feet_without_heel"])


def test_a_foot_without_a_heel_is_told_and_by_which_markers_it_points(doll, tools):
    it = doll()
    assert told_of_heels(it.motion) == ([], [])
    left = without_markers(it.motion, "left_foot", slice(0, 4))
    (said,), feet = told_of_heels(left)
    assert feet == ["left_foot"]
    marks = ", ".join(f"left_foot{m}" for m in range(4))
    assert said.endswith(f"angles may be 20 deg off: left_foot ({marks})")
    both = without_markers(left, "right_foot", slice(0, 2))
    assert told_of_heels(both)[1] == ["left_foot", "right_foot"]
    (said,), feet = told_of_heels(tools.renamed(left))  # nobody knows that it is a foot
    number = it.motion.skeleton.limb_names.index("left_foot") + 1
    assert feet == [f"limb_{number:02d}"]
    assert feet[0] in said


@pytest.mark.parametrize("held", ["left_forearm", "tail"])
def test_a_nameless_end_that_hangs_in_the_air_has_no_heel_to_lack(doll, tools, held):
    """It points forward like a foot; the feet beside it are told, for the body stands on them."""
    tail = ("pelvis", (-0.1, 0.0, 0.0), 0.3, (1.0, 0.0, 0.0))
    plan = {name: of for name, of in tools.plan.items() if not name.endswith("left_hand")}
    plan |= {"tail": tail} if held == "tail" else {}
    stance = tools.stance | {held: (1.0, -0.1, 0.0)}
    it = doll(tuple(plan), plan=plan, stance=stance)
    bare = without_markers(it.motion, "left_foot", slice(0, 4))
    foot = f"limb_{it.index('left_foot') + 1:02d}"
    assert told_of_heels(tools.renamed(bare))[1] == [foot]


@pytest.mark.parametrize("height", [0.0, 1.0])
def test_of_a_nameless_chain_alone_nothing_tells_that_its_end_is_a_foot(doll, tools, height):
    """It may be a leg or an arm; named it is a foot."""
    names = ("pelvis", "left_thigh", "left_shank", "left_foot")
    it = doll(names, walk=np.full((7, 3), height))
    bare = without_markers(it.motion, "left_foot", slice(0, 4))
    for motion, feet in ((bare, ["left_foot"]), (tools.renamed(bare), [])):
        step = step_of(normalize(motion, facing="+x"))
        assert step.findings["feet_without_heel"] == feet


def test_of_a_nameless_body_that_lies_on_its_side_nothing_stands(doll, tools):
    """One foot is as low as anything of the body, and is not what it stands on."""
    side = Rotation.from_euler("x", 90, degrees=True).as_matrix()
    it = doll(tools.legs, world=side)
    bare = without_markers(it.motion, "left_foot", slice(0, 4))
    bare = without_markers(bare, "right_foot", slice(0, 4))
    assert told_of_heels(bare)[1] == ["left_foot", "right_foot"]
    step = step_of(normalize(tools.renamed(bare), facing="+x"))
    assert step.findings["feet_without_heel"] == []


def test_a_nameless_foot_that_is_held_up_beside_the_other_is_not_known(doll, tools):
    lifted = np.tile([0.0, 0.0, 1.2], (7, 1))
    bends = {"left_thigh": lifted, "left_shank": -lifted}
    it = doll(bends=bends)
    bare = without_markers(it.motion, "left_foot", slice(0, 4))
    bare = without_markers(bare, "right_foot", slice(0, 4))
    assert told_of_heels(bare)[1] == ["left_foot", "right_foot"]
    right = f"limb_{it.index('right_foot') + 1:02d}"
    assert told_of_heels(tools.renamed(bare))[1] == [right]


def test_a_foot_without_markers_is_not_said_to_lack_a_heel(doll):
    it = doll()
    bare = without_markers(it.motion, "left_foot", slice(0, 0))
    assert told_of_heels(bare) == ([], [])
    one = without_markers(it.motion, "left_foot", slice(4, 5))
    assert told_of_heels(one)[1] == ["left_foot"]  # a heel alone is taken for the toes


@pytest.mark.parametrize(
    ("stance", "reason"),
    [
        ({"left_upper_arm": (0, 0.2, -1.0), "left_forearm": (0, 0.2, -1.0)}, "arms do not hang"),
        (
            {f"{side}_{limb}": way for side in ("left", "right")
             for limb, way in (("thigh", (1, 0, 0)), ("shank", (0, -1, 0)))},
            "seated",
        ),
    ],
)  # fmt: skip
def test_other_postures_are_flagged(stance, reason, doll, tools):
    it = doll(stance=tools.stance | stance)
    result = normalize(it.motion)
    assert apart(result.rotations, it.truth) < EXACT
    assert any(reason in warning for warning in step_of(result).warnings)


def test_a_t_pose_is_good_where_it_is_looked_for(doll, tools):
    arms = {
        f"{side}_{limb}": (0.02, 0.0, sign)
        for side, sign in (("left", -1.0), ("right", 1.0))
        for limb in ("upper_arm", "forearm", "hand")
    }
    it = doll(stance=tools.stance | arms)
    step = step_of(normalize(it.motion, NormalizationSettings(template="t-pose")))
    assert step.findings["good_default_position"] is True


def test_never_still_is_flagged(doll):
    walk = np.outer(np.arange(50) * 0.03, [1.0, 0.0, 0.0])  # 1.5 m/s
    step = step_of(normalize(doll(n_frames=50, walk=walk).motion))
    assert any("moves at 1500 mm/s" in warning for warning in step.warnings)


def test_parts_of_a_body_are_enough(doll, tools):
    hips = ("pelvis", "left_thigh", "right_thigh")
    it = doll(hips)
    assert apart(normalize(it.motion).rotations, it.truth) < EXACT
    shoulders = ("trunk", "head", "left_upper_arm", "right_upper_arm")
    it = doll(shoulders, plan=tools.plan | {"trunk": (None, (0.0, 0.12, 0.0), 0.4, (0, 1, 0))})
    assert apart(normalize(it.motion).rotations, it.truth) < EXACT


def test_legs_alone(doll, tools):
    it = doll(tools.legs)
    result = normalize(it.motion)
    assert apart(result.rotations, it.truth) < np.deg2rad(1.5)  # their line stands for the trunk's
    assert step_of(result).findings["facing"]["decided_by"] == "names"


@pytest.mark.parametrize("n_frames", [1, 2])
def test_a_single_frame_is_a_recording(n_frames, doll):
    it = doll(n_frames=n_frames)
    assert apart(normalize(it.motion).rotations, it.truth) < EXACT


def test_limbs_without_names_are_aligned_by_plane_and_feet(doll, tools):
    it = doll(n_frames=30)
    result = normalize(tools.renamed(it.motion))
    step = step_of(result)
    assert step.findings["body_frame"] == "plane"
    assert "feet" in step.findings["facing"]["decided_by"]
    feet = [it.index("left_foot"), it.index("right_foot")]
    assert apart(result.rotations[:, feet], it.truth[:, feet]) < np.deg2rad(6)
    assert apart(result.rotations, it.truth) < np.deg2rad(6)
    assert len(step.warnings) == 2


def test_nothing_tells_the_front_of_a_stick_figure(doll, tools):
    flat = {name: (0, -1, 0) for name in tools.stance if "foot" not in name}
    names = tuple(name for name in tools.plan if "foot" not in name and "hand" not in name)
    motion = tools.renamed(doll(names, stance=flat).motion)
    with pytest.raises(AmbiguousFacing, match="pass facing"):
        normalize(motion)
    result = normalize(motion, facing="+x")
    assert_allclose(result.rotations[0, 0], np.eye(3), atol=1e-6)
    turned = normalize(motion, facing="-x")
    assert_allclose(turned.rotations[0, 0], np.diag([-1.0, 1.0, -1.0]), atol=1e-6)


def test_too_few_joints_are_refused_with_what_would_do(doll):
    motion = doll(("pelvis", "trunk", "head")).motion
    with pytest.raises(DegenerateMotion, match=r"2 joints .* facing"):
        normalize(motion)
    with pytest.raises(DegenerateMotion, match="level facing"):
        normalize(motion, facing="+y")
    result = normalize(motion, facing="-z")
    assert_allclose(result.rotations[0, 0][:, 0], [0.0, 0.0, -1.0], atol=EXACT)


def test_nothing_seen_is_refused(doll, tools):
    motion = tools.hidden(doll().motion, "pelvis", slice(None))
    with pytest.raises(DegenerateMotion, match="no frame shows"):
        normalize(motion)


def test_an_unknown_facing_is_named(doll):
    with pytest.raises(BadSetting, match=r"'north'; known are \+x"):
        normalize(doll().motion, facing="north")


def test_a_limb_unseen_while_standing_follows_its_parent(tools, rng):
    bend = np.concatenate([np.zeros(110), np.linspace(1.0, 1.5, 90)])
    stance = tools.stance | {name: (0, -1, 0) for name in tools.stance if "foot" not in name}
    it = tools.make_doll(
        rng, n_frames=200, stance=stance, bends={"left_forearm": np.outer(bend, [0, 0, 1.0])}
    )
    motion = tools.hidden(it.motion, "left_forearm", slice(0, 110))
    motion = tools.hidden(motion, "left_hand", slice(0, 110))
    result = normalize(motion)
    assert apart(result.rotations[110:], it.truth[110:]) < EXACT
    assert np.isnan(result.rotations[:110, it.index("left_forearm")]).all()
    assert any("left_forearm" in warning for warning in step_of(result).warnings)


def test_gaps_change_nothing_elsewhere(doll, tools, rng):
    it = doll(n_frames=120)
    motion = it.motion
    for name in motion.skeleton.limb_names:
        motion = tools.hidden(motion, name, rng.random(120) < 0.2)
    result = normalize(motion)
    unseen = motion.flags == PoseFlag.UNSEEN
    assert np.isnan(result.rotations[unseen]).all()
    assert np.isnan(result.origins[unseen]).all()
    assert apart(result.rotations[~unseen], it.truth[~unseen]) < EXACT


def test_a_limb_never_seen_keeps_its_frame(doll, tools):
    it = doll()
    motion = tools.hidden(it.motion, "right_hand", slice(None))
    result = normalize(motion)
    old, new = motion.skeleton.limb("right_hand"), result.skeleton.limb("right_hand")
    assert_allclose(new.marker_positions, old.marker_positions)
    assert any("right_hand could not be aligned" in w for w in step_of(result).warnings)


def test_a_guessed_twist_is_left_out(tools, rng):
    """An upper arm whose twist is known only while the elbow is bent (Plug-in-Gait)."""
    bend = np.concatenate([np.zeros(100), np.full(100, 1.0)])
    straight = {name: (0, -1, 0) for name in tools.stance if "foot" not in name}
    it = tools.make_doll(
        rng, n_frames=200, stance=straight, bends={"left_forearm": np.outer(bend, [0, 0, 1.0])}
    )
    i = it.index("left_upper_arm")
    rotations, flags = it.motion.rotations.copy(), it.motion.flags.copy()
    along = rotations[:100, i] @ it.motion.skeleton.limbs[i].long_axis
    rotations[:100, i] = Rotation.from_rotvec(0.9 * along).as_matrix() @ rotations[:100, i]
    flags[:100, i], flags[100:, i] = PoseFlag.TWIST_UNKNOWN, PoseFlag.TWIST_BORROWED
    flags[40:60, i] = PoseFlag.FILLED  # between guesses, hence a guess
    result = normalize(replace(it.motion, rotations=rotations, flags=flags))
    assert apart(result.rotations[100:], it.truth[100:]) < EXACT
    found = step_of(result).findings
    assert found["limbs_without_twist"] == []
    flags[100:, i] = PoseFlag.TWIST_UNKNOWN
    found = step_of(normalize(replace(it.motion, rotations=rotations, flags=flags))).findings
    assert found["limbs_without_twist"] == ["left_upper_arm"]


def test_every_setting_is_on_record(doll):
    step = step_of(normalize(doll().motion, PAPER))
    assert step.settings["limbs"] == "paper"
    assert len(step.settings) == len(NormalizationSettings.__dataclass_fields__)
    with pytest.raises(BadSetting, match="posture, paper"):
        NormalizationSettings(position="best")


def test_a_walker_is_averaged_over_strides(tools, rng):
    """Shoulders turn against the pelvis, and the arms hang best at one end of that turn."""
    time = np.arange(300) / 50.0
    swing = np.sin(2 * np.pi * time)
    bends = {"trunk": np.outer(np.deg2rad(12) * swing, [0, 1.0, 0])}
    for side in ("left", "right"):
        bends[f"{side}_forearm"] = np.outer(0.25 * (1 - swing), [0, 0, 1.0])
    it = tools.make_doll(rng, n_frames=300, bends=bends, walk=np.outer(1.3 * time, [1.0, 0, 0]))
    many = normalize(it.motion)
    single = normalize(it.motion, NormalizationSettings(frames="single"))
    assert apart(many.rotations[:, 0], it.truth[:, 0]) < np.deg2rad(2.5)
    assert apart(single.rotations[:, 0], it.truth[:, 0]) > np.deg2rad(5)


def test_of_strides_the_frames_serve_in_which_shoulders_and_pelvis_face_alike(
    tools, rng, monkeypatch
):
    time = np.arange(300) / 50.0
    bends = {"trunk": np.outer(np.deg2rad(12) * np.sin(2 * np.pi * time), [0, 1.0, 0])}
    it = tools.make_doll(rng, n_frames=300, bends=bends, walk=np.outer(1.3 * time, [1.0, 0, 0]))
    half = normalize(it.motion)
    monkeypatch.setattr("kinesphere.normalization.default_frames._ALIKE", 1.0)
    whole = normalize(it.motion)
    found, before = step_of(half).findings, step_of(whole).findings
    # of a sine the rms is 0.71, that of the half nearest to its middle 0.40
    assert found["spread_rms_deg"] < 0.7 * before["spread_rms_deg"]
    assert set(found["frames_averaged"]) < set(before["frames_averaged"])
    assert found["n_frames_averaged"] == pytest.approx(before["n_frames_averaged"] / 2, abs=4)
    for motion in (half, whole):
        assert apart(motion.rotations[:, 0], it.truth[:, 0]) < np.deg2rad(1.0)


def test_of_a_few_frames_on_the_move_all_serve(tools, rng):
    time = np.arange(40) / 50.0
    bends = {"trunk": np.outer(np.deg2rad(12) * np.sin(2 * np.pi * time), [0, 1.0, 0])}
    it = tools.make_doll(rng, n_frames=40, bends=bends, walk=np.outer(1.3 * time, [1.0, 0, 0]))
    chosen = NormalizationSettings()
    samples = take_samples(it.motion, chosen.sampling, chosen.speed_window)
    proposal = propose_bodies(samples, chosen, None)
    found = find_default_frames(samples, proposal, chosen)
    assert 4 < found.chosen.sum() < 10
    assert found.chosen.all()


def test_the_body_is_the_mean_of_the_frames_that_serve(tools, rng):
    time = np.arange(300) / 50.0
    course = np.sin(2 * np.pi * time) + 0.6 * np.cos(4 * np.pi * time)  # longer at one side
    bends = {"trunk": np.outer(np.deg2rad(10) * course, [0, 1.0, 0])}
    it = tools.make_doll(rng, n_frames=300, bends=bends, walk=np.outer(1.3 * time, [1.0, 0, 0]))
    chosen = NormalizationSettings()
    samples = take_samples(it.motion, chosen.sampling, chosen.speed_window)
    proposal = propose_bodies(samples, chosen, None)
    found = find_default_frames(samples, proposal, chosen)
    bodies = proposal.root_from_body[found.chosen]
    assert_allclose(found.root_from_body, robust_mean_rotations(bodies[:, None])[0], atol=1e-9)
    assert_allclose(found.spread, rotation_angle(found.root_from_body.T @ bodies), atol=1e-9)


def test_shoulders_that_turn_in_the_stance_are_flagged(tools, rng):
    yaw = np.deg2rad(np.concatenate([np.full(60, 18.0), np.full(60, -18.0)]))
    it = tools.make_doll(rng, n_frames=120, bends={"trunk": np.outer(yaw, [0, 1.0, 0])})
    step = step_of(normalize(it.motion))
    assert step.findings["spread_max_deg"] > 10
    assert any("body frames of the default position differ" in w for w in step.warnings)


def test_lying_is_no_licence_for_any_posture(tools, rng):
    """The cost of lying must not widen the margin: raised arms are still left out."""
    lift = np.concatenate([np.zeros(100), np.full(100, -0.7)])
    it = tools.make_doll(
        rng,
        n_frames=200,
        world=np.array([[1.0, 0, 0], [0, 0, 1.0], [0, -1.0, 0]]),
        bends={"right_upper_arm": np.outer(lift, [1.0, 0, 0])},
    )
    found = step_of(normalize(it.motion)).findings
    assert max(found["frames_averaged"]) <= 101 + 105


def test_a_facing_holds_in_the_default_position_alone(doll):
    """Somebody who turns round afterwards is not averaged with himself."""
    angles = np.concatenate([np.zeros(20), np.linspace(0, 3, 80)])
    yaw = Rotation.from_rotvec(np.outer(angles, [0, 1.0, 0])).as_matrix()
    motion = doll(("pelvis", "trunk", "head"), n_frames=100, world=yaw).motion
    result = normalize(motion, facing="-z")
    assert step_of(result).findings["n_frames_averaged"] == 1
    best = step_of(result).findings["default_frame"] - motion.first_frame
    assert_allclose(result.rotations[best, 0][:, 0], [0.0, 0.0, -1.0], atol=EXACT)


def test_up_may_be_the_worlds(doll):
    leaning = doll(world=Rotation.from_rotvec([0, 0, -0.2]).as_matrix())
    result = normalize(leaning.motion, NormalizationSettings(vertical="up"))
    assert_allclose(result.rotations[0, 0], np.eye(3), atol=EXACT)


def test_legs_that_lie_are_told_by_their_own_line(doll, tools):
    it = doll(tools.legs, world=Rotation.from_rotvec([np.pi / 2, 0, 0]).as_matrix())
    result = normalize(it.motion)
    assert apart(result.rotations, it.truth) < np.deg2rad(1.5)
    assert any("lies" in warning for warning in step_of(result).warnings)


def test_a_wide_or_deep_body_is_flagged_by_the_papers_measures(doll, tools):
    arms = {f"{s}_{x}": (0, 0, z) for s, z in (("left", -1), ("right", 1))
            for x in ("upper_arm", "forearm", "hand")}  # fmt: skip
    step = step_of(normalize(tools.renamed(doll(stance=tools.stance | arms).motion)))
    assert any("times as wide as tall" in warning for warning in step.warnings)
    ahead = {f"{s}_{x}": (1, 0, 0) for s in ("left", "right") for x in ("thigh", "shank")}
    step = step_of(normalize(doll(stance=tools.stance | ahead).motion))
    assert any("mm off their plane" in warning for warning in step.warnings)


def test_the_nearest_posture_counts_where_the_default_one_is_hidden(tools, rng):
    """Frames far from hanging, in which the forearm is twisted too, must not be averaged in."""
    flexion = np.concatenate([np.zeros(60), np.full(8, 0.9), np.full(32, 1.6)])
    it = tools.make_doll(
        rng,
        n_frames=100,
        stance={name: (0, -1, 0) for name in tools.stance if "foot" not in name},
        bends={"left_forearm": np.outer(flexion, [0, 0, 1.0])},
    )
    i = it.index("left_forearm")
    rotations = it.motion.rotations.copy()
    along = rotations[68:, i] @ it.motion.skeleton.limbs[i].long_axis
    rotations[68:, i] = Rotation.from_rotvec(0.8 * along).as_matrix() @ rotations[68:, i]
    motion = tools.hidden(replace(it.motion, rotations=rotations), "left_forearm", slice(0, 60))
    result = normalize(motion)
    assert apart(result.rotations[60:68, i], it.truth[60:68, i]) < EXACT


def test_rounding_does_not_choose_among_samples_that_cost_the_same():
    """Nor does the order of markers, which rounds sums otherwise: the slowest is taken."""
    cost = np.array([np.inf, 4.0, 3.5, 3.5, 3.5, 4.0])
    speeds = np.array([0.0, 0.1, 0.3, 0.2, 0.4, 0.1])
    for rounded in (cost, cost + 1e-15 * np.array([0, 0, 0, 1, -1, 0])):
        assert _least(rounded, speeds) == 3
    assert _least(cost + np.array([0, 0, -1e-3, 0, 0, 0]), speeds) == 2
