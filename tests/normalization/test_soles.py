"""Feet without a heel marker: level where they rest flat on the floor, if their line is steep."""

from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose
from scipy.spatial.transform import Rotation

from kinesphere.data import PoseFlag
from kinesphere.normalization import normalize
from kinesphere.normalization.soles import turned_by

FEET = ("left_foot", "right_foot")
PITCH = {"left_foot": -0.2, "right_foot": -0.36}  # of the lines of feet that stand flat
FLAT = {"left_foot": (1.0, np.tan(-0.2), 0.0), "right_foot": (1.0, np.tan(-0.36), 0.0)}
RAISED = 0.4  # rad by which the heels are lifted
N = 200  # frames, 50 Hz


def heelless(motion):
    """Return the motion with feet whose last marker, the heel, is not there."""
    limbs = tuple(
        replace(limb, markers=limb.markers[:-1], marker_positions=limb.marker_positions[:-1])
        if limb.name.endswith("foot")
        else limb
        for limb in motion.skeleton.limbs
    )
    return replace(motion, skeleton=replace(motion.skeleton, limbs=limbs))


def about_z(angles):
    """Return rotation vectors about the body's lateral axis, (n,) rad; positive lifts the toes."""
    return np.asarray(angles)[:, None] * [0.0, 0.0, 1.0]


def both(limb, vectors):
    return {f"{side}_{limb}": vectors for side in ("left", "right")}


def on_tiptoe():
    """Return bends and way of a body flat on its feet, arms out, that then hangs its arms.

    On its toes it bobs by a few millimetres; these are the frames of the default position.
    """
    t = np.arange(N) / 50.0
    later = t >= 2.0
    out = np.where(later, 0.0, 1.4)[:, None]
    arms = {"left_upper_arm": out * [-1.0, 0, 0], "right_upper_arm": out * [1.0, 0, 0]}
    bends = arms | both("foot", about_z(np.where(later, -RAISED, 0.0)))
    height = np.where(later, 0.2 * RAISED + 0.003 * np.sin(2 * np.pi * t), 0.0)
    return bends, height[:, None] * [0.0, 1.0, 0.0]


def stepping():
    """Return bends of a body that lifts its feet by turns, toes down."""
    phase = np.arange(N) / 50.0
    bends = {}
    for side, lag in (("left", 0.0), ("right", 0.5)):
        lifted = np.maximum(0.0, np.sin(2 * np.pi * (phase + lag))) ** 2
        bends |= {f"{side}_thigh": about_z(0.6 * lifted), f"{side}_foot": about_z(-0.9 * lifted)}
    return bends


def pitch_of(result, limb, up=(0.0, 1.0, 0.0)):
    """Return the pitch of a normalized foot in the world, (n_frames,) rad."""
    ahead = result.rotations[:, result.skeleton.limb_names.index(limb), :, 0]
    return np.arcsin(np.clip(ahead @ np.array(up), -1, 1))


def said(motion):
    """Return what is warned of feet whose frame rests on toes alone, by the line of the markers."""
    return [w for w in motion.history[-1].warnings if "heel; its frame" in w]


def soles(motion):
    return motion.history[-1].findings["feet_levelled_deg"]


def assert_left_alone(motion):
    """Feet have the frames of their lines, which the doll's heels lie on, and that is said once."""
    found = normalize(heelless(motion))
    assert_allclose(found.rotations, normalize(motion).rotations, atol=1e-9)
    assert len(said(found)) == 1
    assert all(name in said(found)[0] for name in FEET)
    assert soles(found) == {}


@pytest.mark.parametrize("pitch", [-0.3, -0.36])
def test_a_foot_without_a_heel_is_level_where_the_body_stands(doll, tools, pitch):
    """Of who stands the sole is level; the line from the ankle to the toes is not."""
    feet = {"left_foot": (1.0, pitch, -0.15), "right_foot": (1.0, pitch, 0.10)}
    it = doll(stance=tools.stance | feet)
    with_heels, without = normalize(it.motion), normalize(heelless(it.motion))
    assert said(without) == []
    assert soles(with_heels) == {}
    for name in feet:
        i = it.index(name)
        for result, tilt in ((with_heels, pitch), (without, 0.0)):
            body, foot = result.rotations[:, 0], result.rotations[:, i]
            ahead = np.swapaxes(body, -1, -2) @ foot[:, :, 0, None]
            way = np.array(feet[name]) * [1, 0, 1] + [0, tilt, 0]
            assert_allclose(ahead[..., 0], [way / np.linalg.norm(way)] * len(ahead), atol=1e-9)


@pytest.mark.parametrize("pitch", [-0.25, 0.1, 0.3])
def test_a_line_that_hardly_runs_down_is_the_foots(doll, tools, pitch):
    assert_left_alone(doll(stance=tools.stance | dict.fromkeys(FEET, (1.0, pitch, 0.0))).motion)


@pytest.mark.parametrize("heel", [0.0, -0.1, 0.1])
def test_a_foot_without_a_heel_gets_the_zero_of_the_other(doll, tools, heel):
    """By as much as the other's line pitches on the floor, not by all of its own."""
    feet = {"left_foot": (1.0, np.tan(-0.4), 0.0), "right_foot": (1.0, np.tan(heel), 0.0)}
    motion = doll(stance=tools.stance | feet, n_frames=20).motion
    right = motion.skeleton.limb("right_foot")
    bare = heelless(motion)
    limbs = tuple(right if it.name == right.name else it for it in bare.skeleton.limbs)
    found = normalize(replace(bare, skeleton=replace(bare.skeleton, limbs=limbs)))
    assert list(soles(found)) == ["left_foot"]
    for name in FEET:
        assert_allclose(pitch_of(found, name), heel, atol=1e-9)
    i = motion.skeleton.limb_names.index("right_foot")
    assert (found.rotations[:, i] == normalize(motion).rotations[:, i]).all()


def test_levelled_again_nothing_changes(doll, tools):
    found = normalize(heelless(doll(stance=tools.stance | FLAT, n_frames=20).motion))
    assert len(soles(found)) == 2
    assert_allclose(normalize(found).rotations, found.rotations, atol=1e-9)


def test_one_frame_of_somebody_standing_is_enough(doll, tools):
    found = normalize(heelless(doll(stance=tools.stance | FLAT, n_frames=1).motion))
    for name in FEET:
        assert_allclose(pitch_of(found, name), 0.0, atol=1e-9)


def test_a_heel_raised_in_the_default_position_stays_raised(doll, tools):
    bends, way = on_tiptoe()
    it = doll(stance=tools.stance | FLAT, n_frames=N, bends=bends, walk=way)
    found = normalize(heelless(it.motion))
    assert found.history[-1].findings["times_averaged_s"][0] >= 1.9
    for name in FEET:
        assert soles(found)[name] == pytest.approx(np.rad2deg(PITCH[name]), abs=1e-6)
        assert_allclose(pitch_of(found, name)[:100], 0.0, atol=1e-6)
        assert_allclose(pitch_of(found, name)[100:], -RAISED, atol=1e-6)


def test_of_somebody_who_steps_feet_are_level_on_the_floor(doll, tools):
    it = doll(stance=tools.stance | FLAT, n_frames=N, bends=stepping())
    found = normalize(heelless(it.motion))
    for name, flat in (("left_foot", slice(25, 50)), ("right_foot", slice(0, 25))):
        assert_allclose(pitch_of(found, name)[flat], 0.0, atol=1e-6)
        assert pitch_of(found, name).min() < -0.2


@pytest.mark.parametrize("kind", ["tiptoe", "steps"])
def test_backwards_in_time_and_turned_round_it_is_the_same(doll, tools, kind):
    bends, way = on_tiptoe() if kind == "tiptoe" else (stepping(), None)
    motion = heelless(doll(stance=tools.stance | FLAT, n_frames=N, bends=bends, walk=way).motion)
    turn = Rotation.from_euler("y", 70, degrees=True).as_matrix()
    back = replace(motion, rotations=motion.rotations[::-1], origins=motion.origins[::-1])
    turned = replace(motion, rotations=turn @ motion.rotations, origins=motion.origins @ turn.T)
    found = normalize(motion)
    assert set(soles(found)) == set(FEET)
    assert_allclose(normalize(back).rotations[::-1], found.rotations, atol=1e-9)
    assert_allclose(normalize(turned).rotations, turn @ found.rotations, atol=1e-9)


@pytest.mark.parametrize("turned", ["on the back", "prone", "on the head", "on the side"])
def test_of_somebody_who_does_not_stand_nothing_is_known(doll, tools, turned):
    axis, degrees = {
        "on the back": ("z", 90),
        "prone": ("z", -90),
        "on the head": ("z", 180),
        "on the side": ("x", 90),
    }[turned]
    world = Rotation.from_euler(axis, degrees, degrees=True).as_matrix()
    assert_left_alone(doll(stance=tools.stance | FLAT, world=world).motion)


def test_where_shanks_are_not_seen_the_body_must_be_upright(doll, tools):
    motion = doll(stance=tools.stance | FLAT, n_frames=20).motion
    for side in ("left", "right"):
        motion = tools.hidden(motion, f"{side}_shank", slice(1, 20))
    lies = Rotation.from_euler("x", 90, degrees=True).as_matrix()
    lying = replace(motion, rotations=lies @ motion.rotations, origins=motion.origins @ lies.T)
    assert set(soles(normalize(heelless(motion)))) == set(FEET)
    assert_left_alone(lying)


def test_a_foot_held_still_in_the_air_does_not_stand(doll, tools):
    held = np.where(np.arange(N) < 120, 1.2, 0.0)
    bends = {
        "left_thigh": about_z(held),
        "left_shank": about_z(-held),
        "left_foot": about_z(-0.5 * held),
    }
    it = doll(stance=tools.stance | FLAT, n_frames=N, bends=bends)
    found = normalize(heelless(it.motion))
    assert_allclose(pitch_of(found, "left_foot")[120:], 0.0, atol=1e-6)


def test_a_foot_that_turns_about_its_toes_does_not_rest(doll, tools):
    """Both heels go up and down while the toes stay where they are; at first they are down."""
    t = np.arange(N) / 50.0
    lifted = np.where(t > 0.8, 0.3 * (1 - np.cos(2 * np.pi * (t - 0.8))), 0.0)
    line = -0.36 - lifted
    toes = 0.2 * np.stack([np.cos(line), np.sin(line), np.zeros(N)], axis=1)
    feet = dict.fromkeys(FEET, FLAT["right_foot"])
    bends = both("foot", about_z(-lifted))
    it = doll(stance=tools.stance | feet, n_frames=N, bends=bends, walk=toes[0] - toes)
    found = normalize(heelless(it.motion))
    for name in FEET:
        assert_allclose(pitch_of(found, name), -lifted, atol=1e-6)


def test_a_foot_on_its_toes_is_left_as_it_is(doll, tools):
    feet = dict.fromkeys(FEET, (1.0, -1.3, 0.0))
    assert_left_alone(doll(stance=tools.stance | feet).motion)


def test_feet_that_never_rest_are_left_as_they_are(doll, tools):
    glides = np.arange(N)[:, None] / 50.0 * [1.0, 0.0, 0.0]
    assert_left_alone(doll(stance=tools.stance | FLAT, n_frames=N, walk=glides).motion)


def test_feet_that_rest_in_two_ways_are_left_as_they_are(doll, tools):
    """As long on tiptoe as flat, and as still; unless one of the two is not measured."""
    up = np.arange(N) >= N // 2
    bends, way = both("foot", about_z(np.where(up, -0.4, 0.0))), np.outer(0.08 * up, [0, 1, 0])
    motion = doll(stance=tools.stance | FLAT, n_frames=N, bends=bends, walk=way).motion
    assert_left_alone(motion)
    flags = np.where(up[:, None], PoseFlag.FILLED, motion.flags)
    found = soles(normalize(heelless(replace(motion, flags=flags))))
    assert found == pytest.approx({name: np.rad2deg(PITCH[name]) for name in FEET}, abs=1e-6)


def test_feet_behind_somebody_who_kneels_do_not_stand(doll, tools):
    """Shanks lie on the floor, and so do the feet, toes down."""
    kneels = both("shank", about_z(np.full(N, -1.5))) | both("foot", about_z(np.full(N, 1.0)))
    assert_left_alone(doll(stance=tools.stance | FLAT, n_frames=N, bends=kneels).motion)


def test_a_direction_too_steep_to_have_a_lateral_axis_is_left():
    steep = np.array([0.3, -0.9, 0.1]) / np.linalg.norm([0.3, -0.9, 0.1])
    assert_allclose(turned_by(steep, -0.2), steep)
    assert_allclose(turned_by(np.array([0.8, -0.6, 0.0]), np.arcsin(-0.6)), [1, 0, 0], atol=1e-12)
