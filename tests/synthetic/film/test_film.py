"""Films know their truth: angles as asked for, joints inside the skin, masks where the skin is."""

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal

from kinesphere.data import bundled_body
from kinesphere.errors import BadSetting
from kinesphere.synthetic.film import (
    CONDITIONS,
    MOVEMENTS,
    BodyMotion,
    another_person,
    make_film,
    stretched,
)

pytestmark = pytest.mark.slow  # rendering takes long in plain Python

SMALL = {"size": (64, 48), "n_frames": 12}


@pytest.mark.parametrize("movement", sorted(MOVEMENTS))
def test_limbs_keep_their_lengths_and_meet_at_the_joints(movement):
    film = make_film(3, movement, **SMALL)
    motion, surface = film.motion, film.motion.surface
    assert_allclose(np.linalg.det(motion.turns), 1, atol=1e-9)
    assert_allclose(motion.turns @ np.swapaxes(motion.turns, -1, -2),
                    np.broadcast_to(np.eye(3), motion.turns.shape), atol=1e-9)  # fmt: skip
    for limb in ("left_forearm", "right_shank"):
        i = surface.limbs.index(limb)
        length = np.linalg.norm(motion.ends[:, i] - motion.joint_centres[:, i], axis=-1)
        rest = np.linalg.norm(surface.ends[i] - surface.joint_centres[i])
        assert_allclose(length, rest, atol=1e-9)
    # the wrist is where the hand begins
    fore, hand = (surface.limbs.index(f"left_{limb}") for limb in ("forearm", "hand"))
    assert_allclose(motion.ends[:, fore], motion.joint_centres[:, hand], atol=1e-9)


def test_skin_of_one_limb_is_carried_rigidly():
    film = make_film(3, "body", **SMALL)
    surface = film.motion.surface
    i = surface.limbs.index("left_forearm")
    own = np.flatnonzero(surface.weights[:, i] == 1)
    assert len(own) > 20
    expected = (surface.vertices[own] - surface.joint_centres[i]) @ film.motion.turns[7, i].T
    assert_allclose(
        film.motion.vertices(7)[own], expected + film.motion.joint_centres[7, i], atol=1e-9
    )


def test_elbows_bend_as_the_movement_says():
    film = make_film(1, "arms", **SMALL)
    t = np.arange(12) / film.motion.rate
    left = 55 - 38 * np.cos(2 * np.pi * 0.37 * t)
    assert_allclose(np.degrees(film.elbow_angles[:, 0]), left, atol=1e-6)


def test_push_ups_keep_hands_and_toes_where_they_are():
    film = make_film(1, "push-ups", size=(64, 48), n_frames=90)
    centres = film.joint_centres
    for side in ("left", "right"):
        wrist, toes = centres[f"{side}_hand"], film.motion.ends[
            :, film.motion.surface.limbs.index(f"{side}_foot")
        ]  # fmt: skip
        assert np.ptp(wrist, axis=0).max() < 0.002
        assert np.ptp(toes, axis=0).max() < 0.03
    bent = np.degrees(film.elbow_angles)
    assert bent.min() < 40
    assert bent.max() > 95
    skin = [film.motion.vertices(i)[:, 1].min() for i in range(0, 90, 15)]
    assert min(skin) > -0.03


def test_a_turn_goes_all_the_way_round():
    film = make_film(1, "turn", n_cameras=3, **SMALL)
    ahead = film.motion.turns[:, 0, :, 0]
    steps = np.arctan2(-ahead[:, 2], ahead[:, 0])
    assert np.degrees(np.unwrap(steps)[-1] - steps[0]) == pytest.approx(360, abs=1e-6)
    assert len(film.scene.cameras) == 3


def test_the_same_frame_looks_the_same_however_it_is_reached():
    film = make_film(5, "arms", conditions="clutter", **SMALL)
    alone = film.scene.frame(7)
    among = list(make_film(5, "arms", conditions="clutter", **SMALL).scene.frames(5, 9))[2]
    assert among.index == 7
    for a, b in zip(alone.images, among.images, strict=True):
        assert_array_equal(a, b)
    other = make_film(6, "arms", conditions="clutter", **SMALL).scene.frame(7)
    assert (alone.images[0] != other.images[0]).mean() > 0.5


def test_masks_are_where_the_person_differs_from_the_plate():
    quiet = CONDITIONS["plain"].__class__(noise=0.0, shadows=0.0)
    film = make_film(2, "arms", conditions=quiet, plates=True, size=(320, 240), n_frames=3)
    frame = film.scene.frame(1)
    assert film.scene.has_masks is False
    assert frame.masks == (None,) * 4
    for image, mask, plate in zip(frame.images, frame.references, film.scene.plates, strict=True):
        differs = np.abs(image.astype(int) - plate).max(axis=2) > 2
        agree = (differs & mask).sum() / (differs | mask).sum()
        assert agree > 0.9  # a rim of half-covered pixels is left
        assert 0.02 < mask.mean() < 0.3


def test_spoils_are_switched_on_one_by_one():
    base = CONDITIONS["plain"].__class__(noise=0.0, shadows=0.0)
    plain = make_film(2, "arms", conditions=base, **SMALL).scene.frame(10).images[0].astype(float)
    for name, value in (("noise", 4.0), ("pattern", 1.0), ("clutter", 1.0), ("moving", True),
                        ("changing_light", True), ("shadows", 0.5), ("loose", 0.03)):  # fmt: skip
        how = CONDITIONS["plain"].__class__(**{"noise": 0.0, "shadows": 0.0, name: value})
        other = make_film(2, "arms", conditions=how, **SMALL).scene.frame(10).images[0]
        assert np.abs(other - plain).max() > 8, name


def test_posts_hide_the_person_before_two_cameras_and_stand_in_the_empty_room():
    size = {"size": (160, 120), "n_frames": 6}
    bare = make_film(1, "arms", masks=True, plates=True, **size)
    film = make_film(1, "arms", conditions="hidden", masks=True, plates=True, **size)
    frame, free = film.scene.frame(3), bare.scene.frame(3)
    shares = [m.sum() / f.sum() for m, f in zip(frame.masks, free.masks, strict=True)]
    assert max(shares[:2]) < 1
    assert min(shares[:2]) < 0.8
    assert shares[2:] == [1, 1]
    for mask, whole, image, plate, empty in zip(
        frame.masks, free.masks, frame.images, film.scene.plates, bare.scene.plates, strict=True
    ):
        assert not (mask & ~whole).any()
        hidden = whole & ~mask
        post = np.abs(plate.astype(int) - empty).max(axis=-1) > 20
        assert post[hidden].mean() > 0.7 if hidden.any() else True
        if hidden.any():  # there the image shows the post, but for noise
            assert np.median(np.abs(image.astype(int) - plate)[hidden & post]) < 6


def test_loose_clothes_only_add():
    how = CONDITIONS["plain"].__class__(loose=0.03)
    film = make_film(2, "arms", conditions=how, **SMALL)
    surface, skin = film.motion.surface, film.motion.vertices(4)
    off = ((film.footage.skin(4) - skin) * surface.normals(skin)).sum(axis=1)
    assert off.min() >= -1e-12
    assert 0.015 < off.max() <= 0.03 + 1e-12
    bare = surface.weights[:, [surface.limbs.index("head")]].sum(axis=1) == 1
    assert_allclose(off[bare], 0, atol=1e-12)


def test_another_body_is_another_size():
    tall = make_film(2, "arms", shape={"height": 0.3}, **SMALL)
    usual = make_film(2, "arms", **SMALL)
    taller = np.ptp(tall.motion.surface.vertices[:, 1])
    assert taller > 1.02 * np.ptp(usual.motion.surface.vertices[:, 1])
    assert_allclose(tall.elbow_angles, usual.elbow_angles, atol=1e-6)


def test_what_nobody_knows_is_said():
    with pytest.raises(BadSetting, match="known are arms"):
        make_film(1, "flying")
    with pytest.raises(BadSetting, match="known are plain"):
        make_film(1, conditions="fog")
    with pytest.raises(BadSetting, match="at least 1"):
        make_film(1, n_frames=0)


def test_angle_of_a_straight_and_a_square_arm():
    body = bundled_body()
    turns = np.tile(np.eye(3), (1, len(body.limbs), 1, 1))
    motion = BodyMotion(body, turns, np.zeros((1, 3)), 30.0)
    knee = body.limbs.index("left_shank")
    before = body.joint_centres[knee] - body.joint_centres[knee - 1]
    after = body.ends[knee] - body.joint_centres[knee]
    expected = np.arccos(before @ after / np.linalg.norm(before) / np.linalg.norm(after))
    assert motion.angle_at("left_shank")[0] == pytest.approx(expected)


def test_another_person_is_off_in_every_measure(rng):
    body = bundled_body()
    other = another_person(body, rng)
    before = np.linalg.norm(body.ends - body.joint_centres, axis=1)
    after = np.linalg.norm(other.ends - other.joint_centres, axis=1)
    factors = dict(zip(body.limbs, after / before, strict=True))
    for limb in ("upper_arm", "forearm", "thigh", "shank"):
        assert factors[f"left_{limb}"] == pytest.approx(factors[f"right_{limb}"])
    off = np.abs(np.array(list(factors.values())) - 1)
    assert 0.02 < off.max() < 0.17
    assert len(np.unique(np.round(off, 6))) > 5
    assert other.vertices[:, 1].min() == pytest.approx(body.vertices[:, 1].min())


def test_stretched_limbs_are_as_long_and_as_thick_as_asked():
    body = bundled_body()
    long, thick = 1.07, 0.95
    other = stretched(body, {"forearm": long}, {"forearm": thick})
    i = body.limbs.index("left_forearm")
    own = np.flatnonzero(body.weights[:, i] == 1)
    axis = body.ends[i] - body.joint_centres[i]
    axis = axis / np.linalg.norm(axis)
    before = body.vertices[own] - body.joint_centres[i]
    after = other.vertices[own] - other.joint_centres[i]
    assert_allclose(after @ axis, long * (before @ axis), atol=1e-12)
    across = np.eye(3) - np.outer(axis, axis)
    assert_allclose(after @ across, thick * (before @ across), atol=1e-12)
    hand = body.limbs.index("left_hand")
    assert_allclose(other.ends[i], other.joint_centres[hand], atol=1e-9)
    same = body.limbs.index("left_thigh")
    assert_allclose(other.joint_centres[same] - other.joint_centres[0],
                    body.joint_centres[same] - body.joint_centres[0], atol=1e-12)  # fmt: skip
