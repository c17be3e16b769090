"""Feet that lack markers which the other foot has, and feet of which only the heel is seen."""

from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose
from scipy.spatial.transform import Rotation

from kinesphere.geometry.rotations import rotation_angle
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
    assert f"{8 if len(kept) > 1 else 20} deg off" in said
    assert told(whole) == []


@pytest.mark.parametrize("turned", [(0.0, 0.15, 0.0), (0.0, 0.0, -0.15)])
def test_a_foot_that_stands_otherwise_than_the_other_points_as_its_markers_do(twins, turned):
    motion = twins(turned)
    whole, less = normalize(motion), normalize(keeping(motion, left_foot=(0, 1, 4)))
    assert apart(whole, less, "left_foot") < 0.1 * np.rad2deg(0.15)


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
