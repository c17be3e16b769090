"""Poses from perfect masks: how near, and the laws that any scene obeys."""

from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose
from scipy.spatial.transform import Rotation

from kinesphere.data import bundled_body
from kinesphere.markerless.anatomy import full_body
from kinesphere.markerless.contour_fit import ContourFitter
from kinesphere.markerless.eyes import fitter_for
from kinesphere.markerless.pose import Pose, bind_pose, difference, limited, moved, posed
from kinesphere.markerless.prediction import expectation, rest
from kinesphere.markerless.recovery import recovered
from kinesphere.markerless.rim import Canvas
from kinesphere.markerless.settings import TrackSettings
from kinesphere.markerless.shape import FACTORS, shaped
from kinesphere.markerless.shape_fit import Instant, fit_shape
from kinesphere.markerless.views import view_of

pytestmark = pytest.mark.slow  # in plain Python

ANGLE, JOINT = np.radians(0.7), 3e-3  # what perfect masks must give
SETTINGS = TrackSettings().for_masks()
TIMES = 5  # as often as a tracker fits its first pose


def masks_of(body, pose, cameras):
    points = body.skinned(posed(body.chain, pose))
    return [
        (Canvas(view_of(c, 960), body, 6).draw(points).limbs >= 0).astype(np.uint8) * 255
        for c in cameras
    ]


def fitted(body, start, cameras, masks, settings=SETTINGS):
    fitter = fitter_for(body, cameras, settings, masks=True)
    for eye, mask in zip(fitter.eyes, masks, strict=True):
        eye.evidence.look(mask)
    for _ in range(TIMES):
        start = fitter.fit(start, (expectation(body.chain, start, settings),))
    return start


def a_pose(body, seed, spread=0.15):
    """Return a pose near one in which a person stands freely, arms off the body."""
    rng = np.random.default_rng(seed)
    step = rng.normal(scale=spread, size=body.chain.n_dofs)
    step[:3] *= 0.3
    return limited(body.chain, moved(body.chain, bind_pose(body.chain), step))


def off(body, pose, seed, angle=0.03, shift=0.015):
    rng = np.random.default_rng(1000 + seed)
    step = rng.normal(scale=angle, size=body.chain.n_dofs)
    step[:3] = rng.normal(scale=shift, size=3)
    return limited(body.chain, moved(body.chain, pose, step))


def joint_errors(body, found, truth):
    a, b = posed(body.chain, found), posed(body.chain, truth)
    return np.linalg.norm(a.centres - b.centres, axis=1)


@pytest.mark.parametrize("seed", [0, 1, 3])
def test_the_upper_body_is_found_from_perfect_masks(upper, ring, seed):
    cameras = ring(4, target=(0, 1.2, 0))
    truth = a_pose(upper, seed)
    found = fitted(upper, off(upper, truth, seed), cameras, masks_of(upper, truth, cameras))
    assert joint_errors(upper, found, truth).mean() < JOINT
    elbows = [i for i, n in enumerate(upper.parameter_names) if n.endswith("forearm.angle1")]
    assert np.abs(difference(upper.chain, found, truth))[elbows].max() < ANGLE


def test_contours_find_it_too_by_either_equation(upper, ring):
    cameras = ring(4, target=(0, 1.2, 0))
    truth = a_pose(upper, 1)
    start = off(upper, truth, 1)
    masks = masks_of(upper, truth, cameras)
    for equations, bound in (("image", 2e-3), ("plucker", 4e-3)):
        settings = TrackSettings(method="level-set", equations=equations, contour_iterations=15)
        fitter = fitter_for(upper, cameras, settings, masks=True)
        contours = ContourFitter(fitter, True)
        contours.look(masks)
        found = contours.fit(start, (expectation(upper.chain, start, settings),))
        assert joint_errors(upper, found, truth).mean() < bound
        assert joint_errors(upper, start, truth).mean() > 2 * bound


def test_the_order_of_cameras_is_nothing(upper, ring):
    cameras = ring(3, target=(0, 1.2, 0))
    truth = a_pose(upper, 2)
    start, masks = off(upper, truth, 2), masks_of(upper, truth, cameras)
    one = fitted(upper, start, cameras, masks)
    other = fitted(upper, start, cameras[::-1], masks[::-1])
    assert_allclose(difference(upper.chain, one, other), 0, atol=1e-6)


def test_a_turned_scene_gives_the_turned_pose(upper, ring):
    cameras = ring(4, target=(0, 1.2, 0))
    truth = a_pose(upper, 1)
    start, masks = off(upper, truth, 1, angle=0.015, shift=0.008), masks_of(upper, truth, cameras)
    turn, shift = Rotation.from_rotvec([0.3, -1.1, 0.4]).as_matrix(), np.array([3.0, -1, 2])
    there = tuple(camera.turned(turn, shift) for camera in cameras)

    def taken(pose):
        balls = pose.balls.copy()
        balls[0] = turn @ balls[0]
        return Pose(turn @ pose.position + shift, balls, pose.angles)

    one = taken(fitted(upper, start, cameras, masks))
    other = fitted(upper, taken(start), there, masks)
    # steps are damped along the world's axes, so that they go another way to the same place
    apart = joint_errors(upper, one, other)
    assert np.median(apart) < 0.3e-3
    assert apart.max() < 3e-3


def test_a_camera_without_image_is_left_out(upper, ring):
    cameras = ring(4, target=(0, 1.2, 0))
    truth = a_pose(upper, 4)
    start, masks = off(upper, truth, 4), masks_of(upper, truth, cameras)
    without = fitted(upper, start, cameras[:3], masks[:3])
    blind = fitted(upper, start, cameras, [*masks[:3], None])
    assert_allclose(difference(upper.chain, without, blind), 0, atol=1e-9)


def test_no_contrast_moves_nothing(upper, ring):
    cameras = ring(3, target=(0, 1.2, 0))
    start = a_pose(upper, 5)
    grey = [np.full((480, 640), 128, dtype=np.uint8)] * 3
    found = fitted(upper, start, cameras, grey)
    assert joint_errors(upper, found, start).max() < 2e-3


def test_an_arm_put_wrong_is_brought_back(whole, ring):
    cameras = ring(4)
    truth = a_pose(whole, 6, spread=0.1)
    settings = TrackSettings()
    fitter = fitter_for(whole, cameras, settings, masks=True)
    for eye, mask in zip(fitter.eyes, masks_of(whole, truth, cameras), strict=True):
        eye.evidence.look(mask)
    wrong = replace(truth, balls=truth.balls.copy())
    limb = whole.chain.limb_names.index("left_upper_arm")
    wrong.balls[limb] = Rotation.from_rotvec([1.6, 0, 0]).as_matrix() @ wrong.balls[limb]
    wrong = limited(whole.chain, wrong)
    hand = whole.chain.limb_names.index("left_hand")
    assert joint_errors(whole, wrong, truth)[hand] > 0.3
    better = recovered(fitter, wrong, ["left arm"])
    assert better is not None
    assert joint_errors(whole, better, truth)[hand] < 0.03
    # and where nothing is lost, nothing better is found
    right = fitter.fit(truth, (rest(whole.chain, settings, truth),))
    assert recovered(fitter, right, ["left arm", "right leg"]) is None


def test_proportions_are_found_from_a_few_instants(ring):
    surface = bundled_body()
    truth = {"size": 0.04, "forearm_length": 0.05, "shank_length": -0.05, "trunk_width": 0.05}
    true_body, body = full_body(shaped(surface, truth)), full_body(surface)
    cameras = ring(4)
    fitter = fitter_for(body, cameras, TrackSettings(), masks=True)
    instants = []
    for seed in range(4):
        pose = a_pose(true_body, seed, spread=0.12)
        masks = tuple(masks_of(true_body, pose, cameras))
        for eye, mask in zip(fitter.eyes, masks, strict=True):
            eye.evidence.look(mask)
        start = Pose(pose.position, pose.balls, pose.angles)
        instants.append(
            Instant(masks, fitter.fit(start, (expectation(body.chain, start, SETTINGS),)))
        )
    logs, poses = fit_shape(fitter, surface, full_body, np.zeros(len(FACTORS)), instants)
    found = full_body(shaped(surface, logs))
    assert len(poses) == 4
    for limb, end in (("forearm", "hand"), ("shank", "foot"), ("thigh", "shank")):
        lengths = [
            np.linalg.norm(
                b.chain.centres[b.chain.limb_names.index(f"left_{end}")]
                - b.chain.centres[b.chain.limb_names.index(f"left_{limb}")]
            )
            for b in (found, true_body, body)
        ]
        assert abs(lengths[0] - lengths[1]) < 8e-3
        assert abs(lengths[0] - lengths[1]) < 0.5 * abs(lengths[2] - lengths[1]) + 4e-3


@pytest.mark.parametrize(("directions", "near"), [(True, 0.004), (False, 0.03)])
def test_joints_of_another_mesh_are_found_by_its_directions_of_shape(ring, directions, near):
    """Factors alone leave them where they lie below the model's own skin."""
    surface, cameras = bundled_body(), ring(4)
    true_body = full_body(surface.shaped({"sex": -1.0, "proportions": 0.5}))
    model = surface if directions else replace(surface, shapes=())
    fitter = fitter_for(full_body(model), cameras, TrackSettings(), masks=True)
    instants = []
    for seed in range(4):
        pose = a_pose(true_body, seed, spread=0.12)
        masks = tuple(masks_of(true_body, pose, cameras))
        for eye, mask in zip(fitter.eyes, masks, strict=True):
            eye.evidence.look(mask)
        start = fitter.fit(pose, (expectation(fitter.body.chain, pose, SETTINGS),))
        instants.append(Instant(masks, start))
    logs = np.zeros(len(FACTORS))
    for _ in range(2):
        logs, poses = fit_shape(fitter, model, full_body, logs, instants)
        instants = [replace(i, pose=p) for i, p in zip(instants, poses, strict=True)]
    found = full_body(shaped(model, logs)).chain
    apart = [
        np.linalg.norm(
            posed(found, poses[k]).centres
            - posed(true_body.chain, a_pose(true_body, k, spread=0.12)).centres,
            axis=1,
        ).mean()
        for k in range(4)
    ]
    assert np.mean(apart) < near
    assert directions or np.mean(apart) > 0.008
