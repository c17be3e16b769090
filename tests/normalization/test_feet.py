"""Feet that lack markers which the other foot has, and feet of which only the heel is seen."""

from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose
from scipy.spatial.transform import Rotation

from kinesphere.geometry.rotations import rotation_angle
from kinesphere.normalization import feet as feet_module
from kinesphere.normalization import normalize

SIDES = ("left", "right")
PLACES = ("toe", "inner", "outer", "arch", "heel")
FLIP = np.array([1.0, 1.0, -1.0])


@pytest.fixture
def twins(doll, tools):
    """Return a doll whose left foot is the mirror image of the right one, markers and all.

    ``turned``: (3,) rad by which the left foot with its markers leaves that in every frame.
    """

    def build(turned=(0.0, 0.0, 0.0), pitch=-0.2):
        way = np.array([1.0, pitch, 0.15])
        stance = tools.stance | {"right_foot": tuple(way), "left_foot": tuple(way * FLIP)}
        for limb in ("thigh", "shank"):
            stance[f"left_{limb}"] = tuple(np.array(stance[f"right_{limb}"]) * FLIP)
        it = doll(stance=stance, paired=True)
        skeleton = it.motion.skeleton
        i, j = (skeleton.limb_names.index(f"{side}_foot") for side in SIDES)
        right, left = skeleton.limbs[j], skeleton.limbs[i]
        places = right.marker_positions @ it.motion.rotations[0, j].T + it.motion.origins[0, j]
        own = (places * FLIP - it.motion.origins[0, i]) @ it.motion.rotations[0, i]
        limbs = list(skeleton.limbs)
        limbs[i] = replace(left, marker_positions=own)
        motion = replace(it.motion, skeleton=replace(skeleton, limbs=tuple(limbs)))
        return turned_at_the_ankle(motion, i, turned)

    return build


def turned_at_the_ankle(motion, limb, by):
    """Return the motion with a limb turned about its proximal joint, (3,) rad in the body frame."""
    turn = Rotation.from_rotvec(by).as_matrix()
    ankle = motion.skeleton.joints[limb - 1].centre_in_child
    rotations, origins = motion.rotations.copy(), motion.origins.copy()
    at = rotations[:, limb] @ ankle + origins[:, limb]
    rotations[:, limb] = turn @ rotations[:, limb]
    origins[:, limb] = at - rotations[:, limb] @ ankle
    return replace(motion, rotations=rotations, origins=origins)


def keeping(motion, **kept):
    """Return the motion with only those markers of feet, by number; 4 is the heel."""
    limbs = []
    for limb in motion.skeleton.limbs:
        at = list(kept.get(limb.name, range(len(limb.markers))))
        markers = tuple(limb.markers[k] for k in at)
        limbs.append(replace(limb, markers=markers, marker_positions=limb.marker_positions[at]))
    return replace(motion, skeleton=replace(motion.skeleton, limbs=tuple(limbs)))


def apart(one, other, limb):
    """Return the largest angle between a limb's frames in two solutions, deg."""
    i = one.skeleton.limb_names.index(limb)
    turned = np.swapaxes(one.rotations[:, i], -1, -2) @ other.rotations[:, i]
    return float(np.rad2deg(rotation_angle(turned)).max())


def pitched(one, other, limb):
    """Return by how much a limb's long axis is higher in the second, deg, median over frames."""
    i = one.skeleton.limb_names.index(limb)
    turned = np.swapaxes(one.rotations[:, i], -1, -2) @ other.rotations[:, i]
    return float(np.rad2deg(np.median(np.arctan2(turned[:, 1, 0], turned[:, 0, 0]))))


def step_of(motion):
    return motion.history[-1]


def told(motion):
    return [said for said in step_of(motion).warnings if "foot" in said]


@pytest.mark.parametrize("side", SIDES)
@pytest.mark.parametrize("kept", [(0, 1, 2), (0, 4), (4,), (1,), (0, 1, 2, 3)])
def test_a_foot_that_lacks_markers_is_the_mirror_image_of_the_other(twins, side, kept):
    motion, foot = twins(), f"{side}_foot"
    whole, less = normalize(motion), normalize(keeping(motion, **{foot: kept}))
    for limb in motion.skeleton.limb_names:
        assert apart(whole, less, limb) < 1e-5
    assert_allclose(less.origins, whole.origins, atol=1e-9)
    assert_allclose(
        [limb.length for limb in less.skeleton.limbs],
        [limb.length for limb in whole.skeleton.limbs],
        atol=1e-9,
    )
    other = SIDES[1 - SIDES.index(side)]
    lacking = [f"{other}_foot_{PLACES[k]}" for k in range(5) if k not in kept]
    assert step_of(less).findings["feet_by_the_other"] == {foot: lacking}
    assert step_of(less).findings["feet_without_heel"] == []
    (said,) = told(less)
    assert said.startswith(f"{foot} has no marker like {', '.join(lacking)} of {other}_foot: ")
    assert f"mirrored onto {', '.join(f'{foot}_{PLACES[k]}' for k in kept)}, " in said
    assert f"{10 if len(kept) > 1 else 20} deg off" in said
    assert told(whole) == []


@pytest.mark.parametrize("turned", [(0.0, 0.15, 0.0), (0.0, 0.0, -0.15)])
def test_a_foot_that_stands_otherwise_than_the_other_points_as_its_markers_do(twins, turned):
    motion = twins(turned)
    whole, less = normalize(motion), normalize(keeping(motion, left_foot=(0, 1, 4)))
    assert apart(whole, less, "left_foot") < 0.1 * np.rad2deg(0.15)


@pytest.mark.parametrize("turned", [-0.06, 0.05])
def test_a_foot_without_its_heel_rests_nearly_as_the_other_does(twins, turned):
    """Between how its markers lie and how the other foot rests: 2.4° and 1.6° rms are known."""
    motion = twins((0.0, 0.0, turned))
    whole, less = normalize(motion), normalize(keeping(motion, left_foot=(0, 1, 2)))
    share = apart(whole, less, "left_foot") / np.rad2deg(abs(turned))
    assert share == pytest.approx(2.4**2 / (2.4**2 + 1.6**2), abs=0.07)


def test_feet_that_do_rest_unlike_each_other_are_left_so(twins):
    """A contracture of 17°: three markers on the foot are no error."""
    motion = twins((0.0, 0.0, -0.3))
    less = normalize(keeping(motion, left_foot=(0, 1, 2)))
    assert apart(normalize(motion), less, "left_foot") < 0.1 * np.rad2deg(0.3)


def test_feet_that_do_not_rest_point_as_their_markers_do(twins):
    """The body spins about its own upward axis, and neither foot ever stands still."""
    motion = twins((0.0, 0.0, -0.06))
    angles = np.arange(motion.n_frames) * 0.2
    spin = Rotation.from_rotvec(angles[:, None] * [0.0, 1.0, 0.0]).as_matrix()
    motion = replace(
        motion,
        rotations=spin[:, None] @ motion.rotations,
        origins=(spin[:, None] @ motion.origins[..., None])[..., 0],
    )
    less = normalize(keeping(motion, left_foot=(0, 1, 2)))
    assert apart(normalize(motion), less, "left_foot") < 0.1 * np.rad2deg(0.06)


def test_rest_makes_up_for_markers_put_on_unlike(twins, rng, monkeypatch):
    """Against feet whose markers are in place: 5 mm off on both, the left heel lost."""
    motion, off = twins(), {True: [], False: []}
    truth = normalize(motion)
    for _ in range(12):
        limbs = [
            replace(one, marker_positions=one.marker_positions + rng.normal(0, 5e-3, (5, 3)))
            if one.name.endswith("foot")
            else one
            for one in motion.skeleton.limbs
        ]
        spoilt = replace(motion, skeleton=replace(motion.skeleton, limbs=tuple(limbs)))
        for weighed, lent in ((True, np.deg2rad(2.4)), (False, 0.0)):
            monkeypatch.setattr(feet_module, "_LENT", lent)
            less = normalize(keeping(spoilt, left_foot=(0, 1, 2)))
            off[weighed].append(pitched(truth, less, "left_foot"))
    better, without = (np.sqrt(np.mean(np.square(off[key]))) for key in (True, False))
    assert better < 0.9 * without


def test_a_foot_of_which_toes_are_not_seen_is_told(twins):
    """Heel and outer edge: named so by customary labels alone."""
    motion = keeping(twins(), left_foot=(2, 3, 4), right_foot=(2, 3, 4))
    assert told(normalize(motion)) == []
    limbs = [
        replace(one, markers=tuple(one.name[0].upper() + tail for tail in ("MT5", "NAV", "HEE")))
        if one.name.endswith("foot")
        else one
        for one in motion.skeleton.limbs
    ]
    edge = normalize(replace(motion, skeleton=replace(motion.skeleton, limbs=tuple(limbs))))
    (said,) = told(edge)
    assert "outer edge" in said
    assert "left_foot (LMT5, LNAV, LHEE), right_foot (RMT5, RNAV, RHEE)" in said
    assert step_of(edge).findings["feet_without_toes"] == ["left_foot", "right_foot"]


def test_a_single_marker_draws_the_foot_half_of_the_way(twins):
    """As far as it is sure beside how unlike two feet stand: at 6 cm from the ankle."""
    motion = twins((0.0, 0.15, 0.0))
    less = normalize(keeping(motion, left_foot=(4,)))
    assert apart(normalize(motion), less, "left_foot") < 0.55 * np.rad2deg(0.15)


def test_labels_that_are_alike_by_chance_are_no_mirror_images(doll):
    """The doll's own markers are anywhere about its feet: what a foot has of them is its line."""
    motion = doll(paired=True).motion
    limbs = [
        replace(limb, marker_positions=limb.marker_positions[[4, 1, 2, 3, 0]])
        if limb.name == "right_foot"
        else limb
        for limb in motion.skeleton.limbs
    ]
    motion = replace(motion, skeleton=replace(motion.skeleton, limbs=tuple(limbs)))
    less = normalize(keeping(motion, left_foot=(0, 1, 2, 4)))
    assert step_of(less).findings["feet_by_the_other"] == {}


def test_numbered_markers_are_no_mirror_images_of_each_other(twins):
    """The first of a cluster may be anywhere on it, though these happen to fit."""
    motion = twins()
    limbs = [
        replace(limb, markers=tuple(f"{limb.name}{k}" for k in range(len(limb.markers))))
        for limb in motion.skeleton.limbs
    ]
    motion = replace(motion, skeleton=replace(motion.skeleton, limbs=tuple(limbs)))
    less = normalize(keeping(motion, left_foot=(0, 1, 4)))
    assert step_of(less).findings["feet_by_the_other"] == {}


def test_a_foot_with_markers_that_the_other_lacks_too_keeps_its_own_line(twins):
    motion = keeping(twins((0.0, 0.15, 0.0)), left_foot=(0, 1, 4), right_foot=(0, 2, 4))
    assert step_of(normalize(motion)).findings["feet_by_the_other"] == {}


def test_the_floor_under_the_lender_levels_both(twins):
    """Neither has a heel and one has a marker less; both stand flat, by the line of the other."""
    motion = twins(pitch=-0.36)
    both = normalize(keeping(motion, left_foot=(0, 1), right_foot=(0, 1, 2, 3)))
    findings = step_of(both).findings
    assert list(findings["feet_by_the_other"]) == ["left_foot"]
    assert set(findings["feet_levelled_deg"]) == {"left_foot", "right_foot"}
    for side in SIDES:
        i = both.skeleton.limb_names.index(f"{side}_foot")
        assert_allclose(both.rotations[:, i, 1, 0], 0.0, atol=1e-9)


@pytest.mark.parametrize("turn", [0.0, 1.0])
def test_a_foot_seen_at_its_heel_alone_points_away_from_it(twins, turn):
    motion = keeping(twins(), left_foot=(4,), right_foot=(4,))
    world = Rotation.from_rotvec([0.0, turn, 0.0]).as_matrix()
    motion = replace(motion, rotations=world @ motion.rotations, origins=motion.origins @ world.T)
    found = normalize(motion)
    for side, sign in zip(SIDES, (-1.0, 1.0), strict=True):
        i = found.skeleton.limb_names.index(f"{side}_foot")
        ahead = np.array([1.0, 0.0, sign * 0.15])
        ways = found.rotations[:, i, :, 0] @ world
        assert_allclose(ways, [ahead / np.linalg.norm(ahead)] * len(ways), atol=1e-9)
    (said,) = told(found)
    assert "at its heel alone" in said
    assert said.endswith("left_foot (left_foot_heel), right_foot (right_foot_heel)")
