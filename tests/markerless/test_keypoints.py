"""Keypoints to a first pose: triangulated, wrong ones left out, and a body put to them."""

from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose

from kinesphere.data import BodyChoice, Scene, StartChoice, bundled_body
from kinesphere.data.keypoints import KEYPOINTS, PlacedKeypoints, SeenKeypoints
from kinesphere.markerless.anatomy import full_body, upper_body
from kinesphere.markerless.first_pose import first_pose
from kinesphere.markerless.hypotheses import facing, standing
from kinesphere.markerless.keypoint_fit import fitted, seeded
from kinesphere.markerless.keypoint_marks import marks_of
from kinesphere.markerless.keypoint_start import UnusableKeypoints, pose_from_keypoints
from kinesphere.markerless.pose import limited, moved, posed
from kinesphere.markerless.settings import TrackSettings
from kinesphere.markerless.shape import FACTORS, shaped
from kinesphere.markerless.triangulation import triangulated
from kinesphere.synthetic.film import make_film

SETTINGS = TrackSettings()
NOTHING = np.zeros(len(FACTORS))


def some_pose(body, rng, up=(0.0, 1.0, 0.0)):
    """Return a pose that is far from any that a start begins with."""
    chain = body.chain
    heading = np.cross(up, rng.normal(size=3))
    pose = facing(standing(chain), np.array([0.2, 0.8, -0.1]), heading, np.array(up))
    step = rng.normal(scale=0.5, size=chain.n_dofs)
    step[:6] = 0
    return limited(chain, moved(chain, pose, step))


def scene_with(cameras, keypoints):
    """Return a scene without images."""
    n = len(cameras)
    return Scene(
        "keypoints", cameras, 30.0, 1, None, (None,) * n, (0,) * n, np.eye(3),
        start=StartChoice(keypoints=keypoints),
    )  # fmt: skip


def projected(cameras, points, rng, noise=0.0):
    """Return what every camera sees of points, surely."""
    pixels = np.array([camera.project(points) for camera in cameras])
    pixels += rng.normal(scale=noise, size=pixels.shape) if noise else 0.0
    return SeenKeypoints(pixels, np.ones(pixels.shape[:2]))


def cloud(rng):
    """Return a point for each keypoint, anywhere."""
    return rng.uniform(-0.5, 0.5, (len(KEYPOINTS), 3)) + np.array([0, 0.9, 0])


def apart(body, pose, other_body, other):
    """Return how far joint centres are from each other, (n_limbs,) m."""
    here, there = posed(body.chain, pose).centres, posed(other_body.chain, other).centres
    return np.linalg.norm(here - there, axis=1)


def test_points_seen_exactly_are_where_they_were(ring, rng):
    points = cloud(rng)
    seen = projected(ring(3), points, rng)
    found = triangulated(ring(3), seen.pixels, seen.confidence)
    assert_allclose(found.points, points, atol=1e-6)
    assert found.seen == len(KEYPOINTS)


def test_one_wrong_camera_of_four_is_outvoted(ring, rng):
    points = cloud(rng)
    seen = projected(ring(4), points, rng, noise=1.0)
    pixels = seen.pixels.copy()
    pixels[2] += [90.0, 60.0]
    found = triangulated(ring(4), pixels, seen.confidence)
    assert np.linalg.norm(found.points - points, axis=1).max() < 0.02


def test_what_one_camera_sees_alone_is_nowhere(ring, rng):
    points = cloud(rng)
    seen = projected(ring(3), points, rng)
    confidence = seen.confidence.copy()
    confidence[1:, 4] = 0.0
    found = triangulated(ring(3), seen.pixels, confidence)
    assert np.flatnonzero(np.isnan(found.points).any(axis=1)).tolist() == [4]
    assert found.seen == len(KEYPOINTS) - 1


def test_order_of_cameras_does_not_matter(ring, rng):
    points = cloud(rng)
    seen, cameras = projected(ring(4), points, rng, noise=3.0), ring(4)
    turned = [2, 0, 3, 1]
    one = triangulated(cameras, seen.pixels, seen.confidence)
    other = triangulated([cameras[i] for i in turned], seen.pixels[turned], seen.confidence[turned])
    assert_allclose(one.points, other.points, atol=1e-9)


@pytest.mark.parametrize("up", [(0.0, 1.0, 0.0), (0.96, 0.28, 0.0), (0.0, -0.1, 0.995)])
def test_a_pose_is_found_from_its_exact_keypoints_upright_or_lying(whole, rng, up):
    marks = marks_of(whole)
    for _ in range(4):
        truth = some_pose(whole, rng, up)
        points = marks.at(whole, truth)
        found, off = fitted(whole, marks, points, SETTINGS)
        assert off.max() < 0.02
        assert apart(whole, found, whole, truth).mean() < 0.01


def test_left_and_right_are_not_taken_for_each_other(whole):
    """Mirrored keypoints are those of the mirrored pose: the heading turns with them."""
    marks = marks_of(whole)
    points = marks.at(whole, facing(standing(whole.chain), np.zeros(3), np.array([1.0, 0, 0])))
    swapped = [KEYPOINTS.index(_other_side(name)) for name in KEYPOINTS]
    found = seeded(whole, marks, dict(zip(KEYPOINTS, points[swapped], strict=True)))
    assert posed(whole.chain, found).rotations[0][:, 0] @ [1, 0, 0] < -0.9


def _other_side(name):
    side, _, rest = name.partition("_")
    return {"left": f"right_{rest}", "right": f"left_{rest}"}.get(side, name)


@pytest.mark.parametrize("seed", [1, 2, 3])
def test_noise_gaps_and_blunders_leave_a_pose_to_track_from(ring, seed):
    rng = np.random.default_rng(seed)
    surface = bundled_body()
    true = full_body(shaped(surface, {"size": 0.08, "thigh_length": 0.04}))
    truth = some_pose(true, rng)
    cameras = ring(4)
    seen = projected(cameras, marks_of(true).at(true, truth), rng, noise=5.0)
    confidence, pixels = seen.confidence.copy(), seen.pixels.copy()
    confidence[rng.random(confidence.shape) < 0.15] = 0.0
    wrong = rng.random(confidence.shape) < 0.05
    pixels[wrong] += rng.normal(scale=80, size=(int(wrong.sum()), 2))
    scene = scene_with(cameras, SeenKeypoints(pixels, confidence))
    known = pose_from_keypoints(scene, surface, NOTHING, SETTINGS, sizes=True)
    body = full_body(shaped(surface, known.logs))
    errors = apart(body, known.pose, true, truth)
    assert errors.mean() < 0.04
    # where a wrist or ankle is not known, nothing tells where the hand or foot begins
    begins = {"hand": "wrist", "foot": "ankle"}
    told = [
        np.isfinite(known.points[KEYPOINTS.index(f"{side}_{begins[limb]}")]).all()
        if limb in begins
        else True
        for side, _, limb in (name.partition("_") for name in body.chain.limb_names)
    ]
    assert errors[told].max() < 0.1
    assert abs(known.logs[0] - 0.08) < 0.05


def test_what_is_not_seen_stays_at_rest_and_is_said(whole, ring, rng):
    truth = some_pose(whole, rng)
    points = marks_of(whole).at(whole, truth)
    for name in ("left_elbow", "left_wrist", "right_ankle"):
        points[KEYPOINTS.index(name)] = np.nan
    scene = scene_with(ring(3), PlacedKeypoints(points))
    known = pose_from_keypoints(scene, bundled_body(), NOTHING, SETTINGS, sizes=False)
    assert "left arm, right leg" in known.warnings[0]
    errors = dict(zip(whole.chain.limb_names, apart(whole, known.pose, whole, truth), strict=True))
    assert max(errors[f"right_{limb}"] for limb in ("forearm", "hand", "shank")) < 0.03


def test_a_scene_turned_and_moved_gives_the_pose_turned_and_moved(whole, ring, rng):
    surface = bundled_body()
    points = marks_of(whole).at(whole, some_pose(whole, rng))
    turn, shift = np.array([[0.0, 0, 1], [0, 1, 0], [-1, 0, 0]]), np.array([3.0, -1, 2])
    found = [
        pose_from_keypoints(
            scene_with(ring(2), PlacedKeypoints(p)), surface, NOTHING, SETTINGS, sizes=True
        )
        for p in (points, points @ turn.T + shift)
    ]  # fmt: skip
    one, other = (posed(whole.chain, k.pose) for k in found)
    assert_allclose(other.centres, one.centres @ turn.T + shift, atol=1e-5)


@pytest.mark.parametrize(
    ("spoil", "says"),
    [
        (lambda p: p * 1000, "times as long"),
        (lambda p: np.where(np.arange(len(p))[:, None] < 9, p, np.nan), "are needed"),
        (lambda p: np.random.default_rng(1).permutation(p), "misses them|times as long"),
        (lambda p: p * 0, "times as long"),
    ],
)
def test_keypoints_of_nobody_are_refused(whole, ring, rng, spoil, says):
    points = marks_of(whole).at(whole, some_pose(whole, rng))
    scene = scene_with(ring(2), PlacedKeypoints(spoil(points)))
    with pytest.raises(UnusableKeypoints, match=says):
        pose_from_keypoints(scene, bundled_body(), NOTHING, SETTINGS, sizes=True)


def test_cameras_that_contradict_each_other_are_refused(whole, ring, rng):
    seen = projected(ring(2), marks_of(whole).at(whole, some_pose(whole, rng)), rng)
    pixels = seen.pixels.copy()
    pixels[1, :, 1] += 120  # off the lines on which the first camera's keypoints lie
    scene = scene_with(ring(2), SeenKeypoints(pixels, seen.confidence))
    with pytest.raises(UnusableKeypoints, match="nowhere in space"):
        pose_from_keypoints(scene, bundled_body(), NOTHING, SETTINGS, sizes=True)


def test_a_known_height_is_kept_and_the_upper_model_served(whole, upper, ring, rng):
    surface = bundled_body()
    points = marks_of(whole).at(whole, some_pose(whole, rng))
    scene = scene_with(ring(3), PlacedKeypoints(points))
    start = first_pose(scene, surface, upper_body, SETTINGS, None)
    assert (start.how, start.warnings) == ("keypoints", ())
    assert len(start.pose.angles) == upper.chain.n_dofs
    tall = replace(scene, body=BodyChoice(height=1.05 * np.ptp(surface.vertices[:, 1])))
    assert_allclose(first_pose(tall, surface, full_body, SETTINGS, None).logs[0], np.log(1.05))


@pytest.mark.slow
def test_the_images_serve_where_keypoints_do_not(whole):
    film = make_film(4, "arms", size=(200, 150), n_frames=1, n_cameras=3, masks=True)
    nobody = PlacedKeypoints(cloud(np.random.default_rng(2)) * 1000)
    scene = replace(film.scene, start=StartChoice(keypoints=nobody), body=BodyChoice(fit=False))
    start = first_pose(scene, bundled_body(), full_body, SETTINGS, scene.frame(0))
    assert start.how == "silhouettes"
    assert len(start.warnings) == 1
    assert start.warnings[0].startswith("the keypoints are not used, but the images: arms and legs")
    limbs = film.motion.surface.limbs
    names = whole.chain.limb_names
    at = posed(whole.chain, start.pose).centres[[names.index(n) for n in limbs if n in names]]
    there = film.motion.joint_centres[0, [i for i, n in enumerate(limbs) if n in names]]
    assert np.linalg.norm(at - there, axis=1).mean() < 0.1
