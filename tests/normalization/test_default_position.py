"""Which frames count as the default position, by either cost."""

from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose
from scipy.spatial.transform import Rotation

from kinesphere.normalization.default_position import paper_cost, posture_cost
from kinesphere.normalization.samples import take_samples
from kinesphere.normalization.settings import NormalizationSettings

RATE = 10.0
GRID = 0.1  # deviations; what turning the rectangle in small steps leaves
HOLD = 12  # frames each pose is held for

DOWN, UP, OUT, AHEAD = (0, -1, 0), (0, 1, 0), (0, 0, 1), (1, 0, 0)


def turned_from_hanging(way):
    """Return the rotation vector that takes a hanging limb there."""
    way = np.array(way, float)
    axis = np.cross(DOWN, way)
    if not axis.any():
        return np.array([np.pi, 0.0, 0.0]) if way[1] > 0 else np.zeros(3)
    return axis / np.linalg.norm(axis) * np.arccos(np.dot(DOWN, way) / np.linalg.norm(way))


POSES = {
    "standing": {},
    "arms overhead": {"left_upper_arm": UP, "right_upper_arm": UP},
    "t-pose": {"left_upper_arm": (0, 0, -1), "right_upper_arm": OUT},
    "seated": {"left_thigh": AHEAD, "right_thigh": AHEAD, "left_shank": DOWN, "right_shank": DOWN},
    "long sitting": {"left_thigh": AHEAD, "right_thigh": AHEAD},
    "kick": {"right_thigh": (1, 0.3, 0.5)},
    "forearms ahead": {"left_forearm": AHEAD, "right_forearm": AHEAD},
}


@pytest.fixture
def sequence(tools, rng):
    """Every pose held for a while, in an order of its own; which pose each frame shows."""
    order = list(POSES)
    rng.shuffle(order)
    shown = np.repeat(order, HOLD)
    names = [name for name in tools.plan if "_" in name]
    bends = {name: np.zeros((len(shown), 3)) for name in names}
    for f, pose in enumerate(shown):
        for name in names:
            parent = name.replace("forearm", "upper_arm").replace("shank", "thigh")
            own = POSES[pose].get(name)
            above = POSES[pose].get(parent) if parent != name else None
            if own is not None and above is None:
                bends[name][f] = turned_from_hanging(own)
            elif own is not None:  # the limb before it is turned already: take that back
                bends[name][f] = turned_from_hanging(own) - turned_from_hanging(above)
    straight = {name: DOWN for name in names if "foot" not in name}
    it = tools.make_doll(rng, n_frames=len(shown), stance=straight | {}, bends=bends, rate=RATE)
    return it.motion, shown


def test_the_posture_cost_knows_standing(sequence):
    motion, shown = sequence
    samples = take_samples(motion, RATE, 0.2)
    found = posture_cost(samples, NormalizationSettings(smoothing=0.0))
    still = np.array([np.median(found.cost[shown == pose]) for pose in POSES])
    assert list(POSES)[int(still.argmin())] == "standing"
    assert still[0] < 0.5
    assert (np.delete(still, 0) > 3.0).all()


def test_the_papers_cost_prefers_slim_and_stretched(sequence):
    """Its weakness included: arms overhead or sideways reach farther than hanging ones."""
    motion, shown = sequence
    samples = take_samples(motion, RATE, 0.2)
    cost = paper_cost(samples, NormalizationSettings(smoothing=0.0, speed=10.0)).cost
    best = {pose: np.median(cost[shown == pose]) for pose in POSES}
    assert min(best, key=best.get) == "arms overhead"
    assert best["t-pose"] < best["standing"]
    assert best["standing"] < min(best["seated"], best["long sitting"], best["kick"])


@pytest.mark.parametrize("cost", [posture_cost, paper_cost])
def test_the_t_pose_can_be_asked_for(cost, sequence):
    motion, shown = sequence
    keep = np.isin(shown, ["standing", "t-pose", "seated", "kick", "long sitting"])
    samples = take_samples(motion, RATE, 0.2)
    wanted = NormalizationSettings(template="t-pose", smoothing=0.0)
    values = np.where(keep, cost(samples, wanted).cost, np.inf)
    assert shown[int(values.argmin())] == "t-pose"


def test_terms_are_what_they_say(doll, tools):
    samples = take_samples(doll(n_frames=3).motion, 100.0, 0.2)
    terms = posture_cost(samples, NormalizationSettings()).terms
    arm = np.array(tools.stance["right_forearm"])
    wanted = np.rad2deg(np.arccos(-arm[1] / np.linalg.norm(arm)))
    assert_allclose(terms["arm_angle_deg"], wanted, atol=1e-9)
    assert_allclose(terms["trunk_tilt_deg"], 0.0, atol=1e-6)
    thigh, shank = (np.array(tools.stance[f"left_{x}"]) for x in ("thigh", "shank"))
    cosine = thigh @ shank / np.linalg.norm(thigh) / np.linalg.norm(shank)
    assert_allclose(terms["knee_flexion_deg"], np.rad2deg(np.arccos(cosine)), atol=1e-9)
    assert_allclose(terms["speed_mm_per_s"], 0.0, atol=1e-9)


@pytest.mark.parametrize("rate", [12.0, 50.0, 300.0])
def test_speed_is_in_metres_a_second_at_any_rate(rate, doll):
    n_frames = int(rate)
    walk = np.outer(np.arange(n_frames) / rate, [0.0, 0.0, 1.3])
    samples = take_samples(doll(n_frames=n_frames, walk=walk, rate=rate).motion, 10.0, 0.2)
    assert_allclose(samples.speeds, 1.3, atol=1e-9)
    assert samples.rate <= 10.0


def test_the_cost_is_averaged_over_its_window(doll):
    """A single good frame amid motion is not the default position."""
    n_frames = 61
    lifted = np.zeros((n_frames, 3))
    lifted[:30, 0] = -1.2
    lifted[15, 0] = 0.0  # one frame of hanging amid lifted arms
    lifted[30:, 0] = -0.65
    motion = doll(n_frames=n_frames, bends={"left_upper_arm": lifted}, rate=10.0).motion
    samples = take_samples(motion, 10.0, 0.0)
    raw = posture_cost(samples, NormalizationSettings(smoothing=0.0, speed=10.0))
    smooth = posture_cost(samples, NormalizationSettings(smoothing=0.3, speed=10.0))
    assert raw.cost.argmin() == 15
    assert smooth.cost.argmin() > 30


def test_frames_unseen_cost_but_do_not_spread(doll, tools):
    motion = doll(n_frames=40, rate=10.0).motion
    for name in ("trunk", "left_upper_arm"):  # which leaves nobody to carry that shoulder
        motion = tools.hidden(motion, name, slice(10, 20))
    samples = take_samples(motion, 10.0, 0.2)
    cost = posture_cost(samples, NormalizationSettings()).cost
    assert np.isfinite(cost).all()
    assert cost[14] > cost[30] + 0.9  # the trunk's tilt, unseen, counts 1
    assert cost[30] == pytest.approx(cost[35])


def test_the_posture_cost_is_its_sum(sequence, doll):
    """A plain twin: squares of what the terms say, tilt and angles up to 90°, speed up to 4."""
    settings = NormalizationSettings(smoothing=0.0)
    upside_down = doll(n_frames=9, world=np.diag([1.0, -1.0, -1.0])).motion
    for motion in (sequence[0], upside_down):
        samples = take_samples(motion, RATE, 0.2)
        found = posture_cost(samples, settings)
        t, span = found.terms, samples.anatomy.span
        wanted = (
            (np.minimum(t["trunk_tilt_deg"], 90) / 15) ** 2
            + (np.minimum(t["arm_angle_deg"], 90) / 30) ** 2
            + (np.minimum(t["thigh_angle_deg"], 90) / 30) ** 2
            + (np.minimum(t["knee_flexion_deg"], 90) / 20) ** 2
            + (t["plane_distance_mm"] / 1e3 / (0.085 * span)) ** 2
            + np.minimum((t["speed_mm_per_s"] / 1e3 / (0.11 * span)) ** 2, 4)
        )
        assert_allclose(found.cost, wanted, atol=1e-9)


def test_the_papers_cost_is_its_naive_twin(sequence):
    """Plane by singular values, rectangle by turning it in small steps."""
    samples = take_samples(sequence[0], RATE, 0.2)
    angles = np.linspace(0, np.pi / 2, 3001)
    flatness, shape, reach = [], [], []
    for joints in samples.joints:
        spread = joints - joints.mean(axis=0)
        _, sizes, axes = np.linalg.svd(spread)
        flatness.append(sizes[2] ** 2 / len(joints))
        flat = spread @ axes[:2].T
        u = np.ptp(flat @ [np.cos(angles), np.sin(angles)], axis=0)
        v = np.ptp(flat @ [-np.sin(angles), np.cos(angles)], axis=0)
        k = (u * v).argmin()
        shape.append(min(u[k], v[k]) / max(u[k], v[k]))
        reach.append(np.linalg.norm(spread, axis=1).mean())

    def z(values):
        away = np.array(values) - np.median(values)
        return away / np.median(np.abs(away))

    wanted = z(flatness) + z(shape) - z(reach)
    cost = paper_cost(samples, NormalizationSettings(smoothing=0.0, speed=10.0)).cost
    assert_allclose(cost, wanted, atol=GRID)


def test_the_papers_cost_passes_over_fast_frames(doll):
    walk = np.zeros((40, 3))
    walk[20:, 0] = np.arange(20) * 0.15
    samples = take_samples(doll(n_frames=40, walk=walk, rate=RATE).motion, RATE, 0.2)
    cost = paper_cost(samples, NormalizationSettings(smoothing=0.0)).cost
    assert np.isfinite(cost[:18]).all()
    assert np.isinf(cost[23:38]).all()


def test_the_window_is_centred(sequence):
    samples = take_samples(sequence[0], RATE, 0.2)
    raw = posture_cost(samples, NormalizationSettings(smoothing=0.0)).cost
    smooth = posture_cost(samples, NormalizationSettings(smoothing=0.5)).cost
    for f in range(len(raw)):
        assert smooth[f] == pytest.approx(raw[max(f - 2, 0) : f + 3].mean())


def test_a_lying_body_is_measured_against_itself(doll):
    standing = take_samples(doll().motion, RATE, 0.2)
    turn = np.array([[1.0, 0, 0], [0, 0, 1.0], [0, -1.0, 0]])
    lying = take_samples(doll(world=turn).motion, RATE, 0.2)
    a, b = (posture_cost(s, NormalizationSettings()).terms for s in (standing, lying))
    assert b["trunk_tilt_deg"] == pytest.approx(90)
    for name in ("arm_angle_deg", "thigh_angle_deg", "knee_flexion_deg"):
        assert_allclose(b[name], a[name], atol=1e-6)


@pytest.mark.parametrize(("tilt_deg", "lies"), [(30.0, False), (60.0, True), (170.0, True)])
def test_who_lies_or_stands_on_the_head_has_a_vertical_of_their_own(doll, tilt_deg, lies):
    motion = doll(n_frames=5).motion
    turn = Rotation.from_euler("z", tilt_deg, degrees=True).as_matrix()
    tilted = replace(motion, rotations=turn @ motion.rotations, origins=motion.origins @ turn.T)
    vertical = take_samples(tilted, RATE, 0.2).vertical
    assert_allclose(vertical, np.tile(turn[:, 1] if lies else UP, (len(vertical), 1)), atol=1e-9)
