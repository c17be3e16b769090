"""Colour statistics: densities, learning, what pixels are taken for."""

import cv2
import numpy as np
import pytest
from numpy.testing import assert_allclose

from kinesphere.markerless.colours import Colours, _nearest
from kinesphere.markerless.eyes import colour_groups
from kinesphere.markerless.fit import near_limbs
from kinesphere.markerless.histograms import SIDE, change, lab_bins, mix
from kinesphere.markerless.kernels.colour import blurred_kernel
from kinesphere.markerless.kernels.lines import REACH, SAMPLES
from kinesphere.markerless.pose import bind_pose, posed
from kinesphere.markerless.rim import Canvas, Parts
from kinesphere.markerless.views import view_of


def test_bins_are_those_of_lab(rng):
    colours = rng.integers(0, 32, (40, 3))
    rgb = (colours * 8 + 4).astype(np.float32)[None] / 255
    lab = cv2.cvtColor(rgb, cv2.COLOR_RGB2LAB)[0]
    bins = lab_bins()[(colours[:, 0] << 10) + (colours[:, 1] << 5) + colours[:, 2]]
    lightness, rest = np.divmod(bins, SIDE * SIDE)
    a, b = np.divmod(rest, SIDE)
    assert_allclose(lightness, np.clip(lab[:, 0] / 100 * SIDE, 0, SIDE - 1).astype(int))
    for axis, found in ((1, a), (2, b)):
        assert_allclose(found, np.clip((lab[:, axis] + 64) / 8, 0, SIDE - 1).astype(int))


def test_a_blurred_histogram_is_a_density_about_where_the_counts_were():
    counts = np.zeros(SIDE**3, dtype=np.float32)
    counts[(5 * SIDE + 7) * SIDE + 9] = 40
    out = np.empty_like(counts)
    blurred_kernel(counts, SIDE, out)
    cube = out.reshape(SIDE, SIDE, SIDE)
    assert out.sum() == pytest.approx(1, abs=1e-6)
    assert cube[5, 7, 9] == pytest.approx(1 / 8)
    assert cube[4, 7, 9] == pytest.approx(1 / 16)
    assert cube[4, 6, 10] == pytest.approx(1 / 64)
    assert_allclose(np.argwhere(cube > 0).mean(axis=0), [5, 7, 9])


def test_an_empty_histogram_stays_empty():
    out = np.ones(SIDE**3, dtype=np.float32)
    blurred_kernel(np.zeros(SIDE**3, dtype=np.float32), SIDE, out)
    assert (out == 0).all()


def test_densities_change_from_nothing_to_all():
    one, other = np.zeros((2, 1, SIDE**3), dtype=np.float32)
    one[0, 700:708], other[0, 900:908] = 1 / 8, 1 / 8
    assert change(one, one) == 0
    assert change(np.zeros_like(one), one) == 0
    # all of it where only the floor was
    assert change(one, other) == pytest.approx(np.log(1 / 8 / 2e-5), abs=1e-3)
    few = [change((1 - share) * one + share * other, one) for share in (0.01, 0.05, 0.3)]
    assert 0 < few[0] < few[1] < few[2]


def test_new_densities_have_their_share_and_all_of_what_was_unknown():
    known = np.array([[0.5, 0.5], [0.2, 0.8], [0, 0], [0, 0]], dtype=np.float32)
    mix(known, np.array([[0.75, 0.25], [0, 0], [0.25, 0.75], [0, 0]], dtype=np.float32), 0.1)
    assert_allclose(known, [[0.525, 0.475], [0.2, 0.8], [0.25, 0.75], [0, 0]], atol=1e-6)


def test_left_and_right_share_colours_and_unknown_limbs_do_not():
    groups = colour_groups(["left_forearm", "right_forearm", "trunk", "tail", "left_clavicle"])
    assert groups[0] == groups[1]
    assert groups[2] == groups[4]
    assert len({groups[0], groups[2], groups[3]}) == 3


@pytest.mark.slow
def test_what_was_learnt_is_recognised(whole, ring):
    canvas = Canvas(view_of(ring(2)[0], 640), whole, 6)
    points = whole.skinned(posed(whole.chain, bind_pose(whole.chain)))
    normals = whole.normals(points)
    parts = canvas.draw(points)
    rim = canvas.rim(points, normals, parts)
    image = np.full((*parts.limbs.shape, 3), (60, 90, 60), dtype=np.uint8)
    image[parts.limbs >= 0] = (180, 120, 100)
    colours = Colours(colour_groups(whole.chain.limb_names), near_limbs(whole), 0.7)
    assert not colours.seeing
    colours.look(image)
    assert colours.seeing
    use = np.ones((len(rim.shares), SAMPLES), dtype=np.int8)
    before = colours.samples(rim, use, 1)
    assert_allclose(before, 0.5)  # nothing learnt yet, nothing told
    colours.learn(rim, parts, 1.0)
    after = colours.samples(rim, use, 1)
    outer = rim.parts[:, 1] < 0
    assert np.median(after[outer, : REACH - 1]) > 0.95
    assert np.median(after[outer, REACH + 2 :]) < 0.05
    scores, counts = np.zeros(len(whole.chain.links)), np.zeros(len(whole.chain.links))
    colours.score(parts, scores, counts)
    assert scores.sum() / counts.sum() > 2
    model, person = colours.person(parts.limbs >= 0)
    assert (model & person).sum() / (model | person).sum() > 0.95


@pytest.mark.slow
def test_ratios_ask_each_pixel_for_the_limb_nearest_to_it(whole, ring):
    canvas = Canvas(view_of(ring(2)[0], 320), whole, 6)
    points = whole.skinned(posed(whole.chain, bind_pose(whole.chain)))
    parts = canvas.draw(points)
    names = whole.chain.limb_names
    arm = np.isin(parts.limbs, [names.index(f"left_{b}") for b in ("forearm", "hand")])
    skin, cloth, room = (200, 140, 120), (60, 90, 160), (90, 90, 90)
    image = np.full((*parts.limbs.shape, 3), room, dtype=np.uint8)
    image[parts.limbs >= 0] = cloth
    image[arm] = skin
    colours = Colours(colour_groups(names), near_limbs(whole), 0.7)
    colours.look(image)
    rim = canvas.rim(points, whole.normals(points), parts)
    colours.learn(rim, parts, 1.0)
    ratios = colours.ratios(parts, 20)
    inside = cv2.erode((parts.limbs >= 0).astype(np.uint8), np.ones((5, 5))) > 0
    outside = cv2.dilate((parts.limbs >= 0).astype(np.uint8), np.ones((5, 5))) == 0
    assert np.median(ratios[inside]) > 2
    near = cv2.dilate((parts.limbs >= 0).astype(np.uint8), np.ones((25, 25))) > 0
    assert np.median(ratios[outside & near]) < -2
    far = cv2.dilate((parts.limbs >= 0).astype(np.uint8), np.ones((61, 61))) == 0
    assert (ratios[far & (np.arange(ratios.shape[0])[:, None] < 2)] == 0).all()
    # skin beside the trunk is no trunk; beside the forearm it is the arm
    colours.look(np.full_like(image, skin))
    by_limb = colours.ratios(parts, 20)
    trunk = parts.limbs == names.index("trunk")
    assert np.median(by_limb[arm]) > 2
    assert np.median(by_limb[trunk & inside]) < 0.5
    assert (colours.ratios(Parts(np.full_like(parts.limbs, -1), parts.nearness), 20) == 0).all()


ROOM, SKIN = (60, 90, 60), (180, 120, 100)


def _seen(whole, ring):
    """Return what a camera sees of the body: rim, parts, and an image of them."""
    canvas = Canvas(view_of(ring(2)[0], 320), whole, 6)
    points = whole.skinned(posed(whole.chain, bind_pose(whole.chain)))
    parts = canvas.draw(points)
    rim = canvas.rim(points, whole.normals(points), parts)
    image = np.full((*parts.limbs.shape, 3), ROOM, dtype=np.uint8)
    image[parts.limbs >= 0] = SKIN
    return rim, parts, image


def _gain(colours, image, parts):
    """Return how much likelier what the limbs cover is theirs than background, nats a pixel."""
    n = parts.limbs.max() + 1
    scores, counts = np.zeros(n), np.zeros(n)
    colours.look(image)
    colours.score(parts, scores, counts)
    return scores.sum() / counts.sum()


@pytest.mark.slow
def test_limbs_put_wrong_teach_nothing_while_the_light_stays(whole, ring):
    rim, parts, image = _seen(whole, ring)
    colours = Colours(colour_groups(whole.chain.limb_names), near_limbs(whole), 0.7)
    colours.look(image)
    colours.learn(rim, parts, 1.0)
    skin = parts.limbs >= 0
    before = np.median(colours.ratios(parts, 20)[skin])
    # the limbs' place shows something else; the room is as it was
    wrong = np.where((image == SKIN).all(axis=2)[..., None], (90, 60, 150), image)
    colours.look(wrong.astype(np.uint8))
    for _ in range(40):
        colours.learn(rim, parts, 0.05)
    colours.look(image)
    assert np.median(colours.ratios(parts, 20)[skin]) == pytest.approx(before, abs=1e-3)


@pytest.mark.slow
@pytest.mark.parametrize("steps", [1, 40], ids=["at once", "slowly"])
def test_limbs_are_learnt_anew_where_the_light_changes(whole, ring, steps):
    rim, parts, image = _seen(whole, ring)
    colours = Colours(colour_groups(whole.chain.limb_names), near_limbs(whole), 0.7)
    colours.look(image)
    colours.learn(rim, parts, 1.0)
    before = _gain(colours, image, parts)
    dim = (image * 0.5).astype(np.uint8)
    assert _gain(colours, dim, parts) < 0.2 * before
    for i in range(1, 81):
        light = 1 - 0.5 * min(1.0, i / steps)
        colours.look((image * light).astype(np.uint8))
        colours.learn(rim, parts, 0.05)
    assert _gain(colours, dim, parts) > 0.8 * before


@pytest.mark.slow
def test_a_view_without_background_has_no_witness_of_light(whole, ring):
    rim, parts, image = _seen(whole, ring)
    colours = Colours(colour_groups(whole.chain.limb_names), near_limbs(whole), 0.7)
    colours.look(image)
    colours.learn(rim, parts, 1.0)
    before = _gain(colours, image, parts)
    full = Parts(np.zeros_like(parts.limbs), parts.nearness)
    colours.learn(rim, full, 0.05)
    assert _gain(colours, image, parts) == pytest.approx(before, abs=1e-9)


def test_every_pixel_belongs_to_its_nearest_limb(rng):
    limbs = np.full((30, 40), -1, dtype=np.int32)
    limbs[5:9, 5:9], limbs[20:25, 28:35] = 3, 7
    row, col = np.mgrid[:30, :40]
    away = [np.hypot(row - limb[0], col - limb[1]) for limb in np.argwhere(limbs >= 0)]
    owner = limbs[limbs >= 0][np.argmin(away, axis=0)]
    apart = np.abs(np.min(away[:16], axis=0) - np.min(away[16:], axis=0)) > 1
    assert np.array_equal(_nearest(limbs)[apart], owner[apart])
