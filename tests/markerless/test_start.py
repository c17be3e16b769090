"""From silhouettes alone: the hull, the stance, the pose; and one chain's pose in another's."""

import numpy as np
import pytest
from numpy.testing import assert_allclose

from kinesphere.data import bundled_body
from kinesphere.errors import BadScene
from kinesphere.markerless.anatomy import full_body
from kinesphere.markerless.eyes import fitter_for
from kinesphere.markerless.hull import visual_hull
from kinesphere.markerless.hypotheses import arm_poses, facing, standing, turned_about
from kinesphere.markerless.pose import bind_pose, limited, moved, posed
from kinesphere.markerless.rim import Canvas
from kinesphere.markerless.settings import TrackSettings
from kinesphere.markerless.shape import shaped
from kinesphere.markerless.silhouettes import largest_piece, looked_at, plate_difference
from kinesphere.markerless.stance import stances_of
from kinesphere.markerless.start import find_start
from kinesphere.markerless.transfer import taken_over
from kinesphere.markerless.views import view_of


def ball_masks(views, centre, radius):
    """Return the silhouettes of a ball."""
    out = []
    for view in views:
        col, row = np.meshgrid(np.arange(view.width), np.arange(view.height))
        fx, fy, cx, cy = view.lens
        rays = np.stack([(col - cx) / fx, (row - cy) / fy, np.ones_like(col, float)], axis=-1)
        rays /= np.linalg.norm(rays, axis=-1, keepdims=True)
        to = view.rotation @ centre + view.shift
        along = rays @ to
        out.append(((to @ to - along**2 < radius**2) * 255).astype(np.uint8))
    return out


def test_the_hull_of_a_ball_holds_the_ball(ring):
    views = [view_of(c, 320) for c in ring(4)]
    centre = np.array([0.1, 0.9, -0.15])
    hull = visual_hull(views, ball_masks(views, centre, 0.3), side=0.05)
    assert_allclose(hull.mean(axis=0), centre, atol=0.04)
    away = np.linalg.norm(hull - centre, axis=1)
    assert away.max() < 0.55
    assert len(hull) * 0.05**3 > 0.9 * 4 / 3 * np.pi * 0.3**3


def test_silhouettes_of_two_places_are_refused(ring):
    views = [view_of(c, 320) for c in ring(4)]
    heights = (0.2, 0.7, 1.2, 1.7)
    masks = [
        ball_masks([view], np.array([0.0, height, 0.0]), 0.1)[0]
        for view, height in zip(views, heights, strict=True)
    ]
    with pytest.raises(BadScene, match="nothing in common"):
        visual_hull(views, masks)


def test_one_silhouette_is_too_few(ring):
    views = [view_of(c, 320) for c in ring(3)]
    masks = ball_masks(views, np.array([0.0, 0.9, 0.0]), 0.15)
    with pytest.raises(BadScene, match="in 1 of 3 cameras"):
        visual_hull(views, [masks[0], None, np.zeros_like(masks[2])])


def test_a_tall_hull_stands_and_a_long_one_lies(rng):
    body = full_body(bundled_body())
    cloud = rng.uniform(-0.5, 0.5, (500, 3))
    upright = stances_of(cloud * [0.4, 1.8, 0.4] + [0, 0.9, 0], body, None, None, sizes=True)
    assert all(s.up @ [0, 1, 0] == 1 for s in upright)
    assert abs(np.mean([s.log_size for s in upright]) - np.log(1.8 / 1.66)) < 0.05
    lying = stances_of(cloud * [1.8, 0.4, 0.4] + [0, 0.3, 0], body, None, None, sizes=True)
    assert {round(s.up[0]) for s in lying} == {1, -1}
    for stance in (*upright, *lying):
        heads = np.array(stance.headings)
        assert_allclose(heads @ stance.up, 0, atol=1e-9)
        assert_allclose(np.linalg.norm(heads, axis=1), 1)


def test_a_known_size_is_kept(rng):
    cloud = rng.uniform(-0.5, 0.5, (500, 3)) * [0.4, 1.8, 0.4]
    assert {
        s.log_size for s in stances_of(cloud, full_body(bundled_body()), None, None, sizes=False)
    } == {0.0}


def test_facing_puts_the_body_where_it_is_told(whole):
    pose = facing(bind_pose(whole.chain), np.array([1.0, 2, 3]), np.array([0.0, 0.3, 1.0]))
    at = posed(whole.chain, pose)
    assert_allclose(at.centres[0], [1, 2, 3])
    assert_allclose(at.rotations[0] @ [1, 0, 0], [0, 0, 1], atol=1e-12)
    assert_allclose(at.rotations[0] @ [0, 1, 0], [0, 1, 0], atol=1e-12)


def test_arms_are_tried_on_their_own_side_and_both_sides_alike(whole):
    ends = {}
    for side in ("left", "right"):
        limb = whole.chain.limb_names.index(f"{side}_forearm")
        poses = arm_poses(whole.chain, bind_pose(whole.chain), side)
        ends[side] = np.array([posed(whole.chain, p).centres[limb] for p in poses])
    assert len(ends["left"]) > 20
    assert_allclose(ends["left"] * [1, 1, -1], ends["right"], atol=2e-3)
    for stance, low, high in (("standing", -1.0, -0.15), ("t-pose", -0.05, 0.05)):
        at = posed(whole.chain, standing(whole.chain, stance))
        names = whole.chain.limb_names
        rise = at.centres[names.index("left_forearm")] - at.centres[names.index("left_upper_arm")]
        assert low < rise[1] < high


def test_turned_about_each_limb_is_where_its_other_one_was(whole):
    chain, names = whole.chain, whole.chain.limb_names
    pose = facing(standing(chain, "a-pose"), np.array([0.2, 0.9, 0.1]), np.array([1.0, 0, 1.0]))
    step = np.zeros(chain.n_dofs)
    step[whole.parameter_names.index("left_thigh.turn3")] = 0.4  # one leg ahead
    step[whole.parameter_names.index("left_upper_arm.turn1")] = -0.3  # one arm higher
    pose = limited(chain, moved(chain, pose, step))
    before, other = posed(chain, pose), turned_about(chain, pose)
    after = posed(chain, other)
    assert_allclose(after.rotations[0][:, [0, 2]], -before.rotations[0][:, [0, 2]], atol=1e-12)
    for limb in ("thigh", "shank", "upper_arm", "forearm"):
        left, right = (names.index(f"{side}_{limb}") for side in ("left", "right"))
        assert np.linalg.norm(before.centres[left] - before.centres[right]) > 0.1
        for one, twin in ((left, right), (right, left)):
            assert_allclose(after.centres[one], before.centres[twin], atol=0.06)
    again = posed(chain, turned_about(chain, other))
    assert_allclose(again.centres, before.centres, atol=1e-9)


def test_a_pose_taken_over_by_the_upper_model_keeps_the_arms(whole, upper):
    pose = standing(whole.chain, "t-pose")
    other = taken_over(whole.chain, pose, upper.chain)
    a, b = posed(whole.chain, pose), posed(upper.chain, other)
    for limb in upper.chain.limb_names:
        i, j = whole.chain.limb_names.index(limb), upper.chain.limb_names.index(limb)
        assert_allclose(a.rotations[i], b.rotations[j], atol=1e-6)


def test_a_plate_shows_the_person_and_not_the_shadow(rng):
    plate = np.full((80, 100, 3), (140, 130, 120), dtype=np.float64)
    image = plate.copy()
    image[20:60, 40:60] = (60, 90, 170)
    image[60:70, 40:95] *= 0.7  # a shadow on the floor
    image *= 1.05  # and a little more light
    noisy = [
        np.clip(p + rng.normal(scale=2, size=p.shape), 0, 255).astype(np.uint8)
        for p in (image, plate)
    ]
    found = plate_difference(*noisy) > 0
    truth = np.zeros((80, 100), dtype=bool)
    truth[20:60, 40:60] = True
    assert (found & truth).sum() / (found | truth).sum() > 0.85


def test_the_largest_piece_is_kept():
    mask = np.zeros((60, 60), dtype=np.uint8)
    mask[5:15, 5:15], mask[30:55, 30:50] = 255, 255
    kept = largest_piece(mask)
    assert kept[40, 40] == 255
    assert kept[10, 10] == 0
    assert (largest_piece(np.zeros_like(mask)) == 0).all()


def test_cameras_look_at_what_they_look_at(ring):
    views = [view_of(c, 320) for c in ring(4, target=(0.3, 0.9, -0.2))]
    assert_allclose(looked_at(views), [0.3, 0.9, -0.2], atol=1e-3)


@pytest.mark.slow
def test_a_person_of_other_size_is_found_from_masks(ring):
    surface = bundled_body()
    true = full_body(shaped(surface, {"size": 0.06, "shank_length": 0.05}))
    cameras = ring(4)
    truth = facing(standing(true.chain, "a-pose"), np.array([0.1, 0.95, 0]), np.array([0.5, 0, 1]))
    points = true.skinned(posed(true.chain, truth))
    views = [view_of(c, 320) for c in cameras]
    masks = [(Canvas(v, true, 6).draw(points).limbs >= 0).astype(np.uint8) * 255 for v in views]
    settings = TrackSettings(largest=320)
    fitter = fitter_for(full_body(surface), cameras, settings, masks=True)
    start = find_start(fitter, surface, full_body, masks)
    assert np.nanmin(start.overlap) > 0.85
    found = full_body(shaped(surface, start.logs))
    at, there = posed(found.chain, start.pose), posed(true.chain, truth)
    errors = np.linalg.norm(at.centres - there.centres, axis=1)
    assert errors.mean() < 0.03
    assert np.median(errors) < 0.02
    assert at.rotations[0][:, 0] @ there.rotations[0][:, 0] > 0.9  # front is front
