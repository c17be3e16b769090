"""Joints' centres where skin moves with the joint, against skin and centres we put there."""

import numpy as np
import pytest
from numpy.testing import assert_allclose

from kinesphere.geometry.centres import Turning, View, fit_centre
from kinesphere.geometry.joint_turns import joint_modes, main_axis, nearest_poses
from kinesphere.geometry.pose_errors import pose_covariance
from kinesphere.geometry.pose_worth import noise_share, pose_worth
from kinesphere.geometry.rigid import fit_rigid, fit_shape, into_frame
from kinesphere.geometry.rotations import rotation_exp
from kinesphere.geometry.skin import fit_through_skin
from kinesphere.geometry.skin_noise import skin_noise

FRAMES = 160
PARENT = np.array([[75, -17, -144], [71, -40, 112], [-93, 22, -56], [-92, 16, 35], [-82, 53, -13]])
CHILD = np.array([[41, -218, -83], [-4, -452, -50], [18, -460, 48], [-5, -227, -84]])
CENTRE = np.array([0.02, -0.11, -0.09])
EXACT = 1e-7  # m; rounding leaves about 1e-9
NOISE = 3e-4  # m
AXIS = np.array([0.6, 0.0, 0.8])  # of hinges: across the limbs
OTHER = np.array([-0.8, 0.0, 0.6])


def ball_turns(rng):
    """Flexion in the first half, abduction and circling in the second, as in a functional trial."""
    t = np.linspace(0, 1, FRAMES // 2)
    bend = np.stack([10 * np.sin(9 * t), 4 * np.sin(7 * t), 35 - 35 * np.cos(25 * t)], axis=1)
    circle = np.stack([22 - 22 * np.cos(40 * t), 5 * np.sin(20 * t), 20 * np.sin(25 * t)], axis=1)
    return rotation_exp(np.deg2rad(np.concatenate([bend, circle]) + rng.normal(size=(FRAMES, 3))))


def hinge_turns(angles):
    return rotation_exp(angles[:, None] * AXIS)


def seen(rng, turns, skin=0.0, noise=0.0, share=0.8):
    """Return both limbs' markers; skin in m per radian, ``share`` of it as one body."""
    parent, child = PARENT * 1e-3, CHILD * 1e-3
    angles = joint_modes(turns) * 0.3

    def moved(shape, size):
        alone = rng.normal(size=(*shape.shape, 3)) * size * (1 - share)
        common = rng.normal(size=(3, 3)) * size * share
        turned = np.cross((angles @ rng.normal(size=(3, 3)) * size * share / 0.15)[:, None], shape)
        return (
            shape + np.einsum("mij,fj->fmi", alone, angles) + (angles @ common.T)[:, None] + turned
        )

    p = moved(parent, skin)
    c = np.einsum("fij,fmj->fmi", turns, moved(child, 2 * skin)) + CENTRE
    return p + rng.normal(size=p.shape) * noise, c + rng.normal(size=c.shape) * noise


def view_of(parent, child, *, skin=True):
    """Return how the parent sees the child, the parent's shape being where `PARENT` lies."""
    sides = []
    for points, at in ((parent, PARENT * 1e-3), (child, None)):
        shape = fit_shape(points)
        if at is not None:  # back to where the truth is told
            there = fit_rigid(shape, at[None])
            shape = shape @ there.rotations[0].T + there.shifts[0]
        sides.append((shape, fit_rigid(shape, points)))
    (a, pose), (b, other) = sides
    turns = np.swapaxes(pose.rotations, 1, 2) @ other.rotations
    modes = joint_modes(turns)
    noise = [
        skin_noise(into_frame(fit.rotations, fit.shifts, points), shape, modes)
        for points, (shape, fit) in zip((parent, child), sides, strict=True)
    ]
    turning = Turning(
        turns,
        into_frame(pose.rotations, pose.shifts, other.shifts[:, None])[:, 0],
        pose_covariance(b, np.full(len(b), 1e-3)),
        1e-3,
        pose_covariance(b, noise[1]) if skin else None,
        pose_covariance(a, noise[0]) if skin else None,
    )
    own = into_frame(pose.rotations, pose.shifts, child)
    return View(own, np.full(len(b), 1e-3), pose_covariance(a, np.full(len(a), 1e-3)), turning)


def test_without_skin_the_centre_is_exact(rng):
    fit = fit_centre(view_of(*seen(rng, ball_turns(rng))), CENTRE + 0.03, 0.1)
    assert_allclose(fit.centre, CENTRE, atol=EXACT)


def test_skin_that_goes_with_the_joint_is_told_from_motion(rng):
    errors = {True: [], False: []}
    for _ in range(12):
        parent, child = seen(rng, ball_turns(rng), skin=0.01, noise=NOISE)
        for skin in errors:
            fit = fit_centre(view_of(parent, child, skin=skin), CENTRE + 0.02, 0.1, hidden=3.0)
            errors[skin].append(np.linalg.norm(fit.centre - CENTRE))
    assert np.sqrt(np.mean(np.square(errors[True]))) < np.sqrt(np.mean(np.square(errors[False])))


def test_halves_with_different_movements_agree_better_and_within_what_is_said(rng):
    apart, told = {True: [], False: []}, []
    half = FRAMES // 2
    for _ in range(12):
        parent, child = seen(rng, ball_turns(rng), skin=0.01, noise=NOISE)
        for skin in apart:
            first, second = (
                fit_centre(view_of(parent[s], child[s], skin=skin), CENTRE, 0.1, hidden=3.0)
                for s in (slice(half), slice(half, None))
            )
            off = second.centre - first.centre
            apart[skin].append(np.linalg.norm(off))
            if skin:
                told.append(off @ np.linalg.solve(first.covariance + second.covariance, off) / 3)
    assert np.median(apart[True]) < 0.8 * np.median(apart[False])
    assert np.mean(told) < 2.0


@pytest.mark.parametrize(("skin", "noise"), [(0.0, 1e-3), (0.005, NOISE), (0.02, NOISE)])
@pytest.mark.parametrize("hinge", [False, True])
def test_centres_are_off_by_about_what_is_told(rng, skin, noise, hinge):
    """Over noise and skin of several sizes: neither many times too careful nor too sure."""
    bends = hinge_turns(np.deg2rad(60 - 60 * np.cos(np.linspace(0, 40, FRAMES))))
    turns, across = ball_turns(rng), np.eye(3)
    if hinge:
        turns, across = bends, np.eye(3) - np.outer(AXIS, AXIS)
    squares = []
    for _ in range(20):
        view = view_of(*seen(rng, turns, skin=skin, noise=noise, share=0.5))
        fit = fit_centre(view, CENTRE + 0.01, 0.1, hidden=3.0, hinge=AXIS if hinge else None)
        off, told = across @ (fit.centre - CENTRE), across @ fit.covariance @ across
        squares.append(off @ off / np.trace(told))
    assert 0.3 < np.sqrt(np.mean(squares)) < 1.3
    assert np.sqrt(max(squares)) < 3


def test_the_centre_moves_with_the_parent(rng):
    parent, child = seen(rng, ball_turns(rng), skin=0.01, noise=NOISE)
    view = view_of(parent, child)
    turn, shift = rotation_exp(rng.normal(size=3)), rng.normal(size=3)
    t = view.turning
    six = np.zeros((6, 6))  # a turn of the frame about another origin: what poses' errors become
    six[:3, :3] = six[3:, 3:] = turn
    skew = np.cross(np.eye(3), shift)
    six[3:, :3] = -skew.T @ turn
    moved = View(
        view.points @ turn.T + shift,
        view.noise,
        six @ view.pose @ six.T,
        Turning(
            turn @ t.rotations,
            t.shifts @ turn.T + shift,
            t.pose,
            t.noise,
            t.skin,
            six @ t.skin_seeing @ six.T,
        ),
    )
    prior, looks = 100.0 * np.eye(3), 30.0
    here = fit_through_skin(view, CENTRE, CENTRE, prior, looks)
    at = turn @ CENTRE + shift
    there = fit_through_skin(moved, at, at, prior, looks)
    assert_allclose(there.centre, turn @ here.centre + shift, atol=EXACT)
    for one, other in zip(here.told, there.told, strict=True):
        assert_allclose(other, turn @ one @ turn.T, rtol=1e-4)


def test_the_centre_of_a_hinge_keeps_to_the_expectation_along_it(rng):
    turns = hinge_turns(np.deg2rad(60 - 60 * np.cos(np.linspace(0, 40, FRAMES))))
    view = view_of(*seen(rng, turns, noise=NOISE))
    axis, strays = main_axis(view.turning)
    assert strays < 1e-4
    assert abs(axis @ AXIS) == pytest.approx(1.0, abs=1e-4)
    expected = CENTRE + 0.03 * axis
    fit = fit_centre(view, expected, 0.1, hidden=3.0, hinge=axis)
    off = fit.centre - CENTRE
    assert off @ axis == pytest.approx(0.03, abs=2e-3)
    assert np.linalg.norm(off - (off @ axis) * axis) < 1e-3
    # next to nothing was measured along it
    assert 0.07 < np.sqrt(axis @ fit.covariance @ axis) <= 0.1


@pytest.mark.parametrize("across", [6.0, 12.0])
def test_a_hinge_that_turns_about_a_second_axis_is_measured_along_its_first(rng, across):
    t = np.linspace(0, 40, FRAMES)
    second = np.deg2rad(across) * np.sin(0.7 * t)[:, None] * OTHER
    bends = hinge_turns(np.deg2rad(60 - 60 * np.cos(t)))
    view = view_of(*seen(rng, bends @ rotation_exp(second), noise=NOISE))
    fit = fit_centre(view, CENTRE + 0.03 * AXIS, 0.1, hidden=3.0, hinge=AXIS)
    assert abs((fit.centre - CENTRE) @ AXIS) < 3e-3


def test_the_axis_of_a_hinge_is_the_motions_whatever_the_model_takes_it_for(rng):
    turns = hinge_turns(np.deg2rad(60 - 60 * np.cos(np.linspace(0, 40, FRAMES))))
    view = view_of(*seen(rng, turns, noise=NOISE))
    here, there = (
        fit_centre(view, CENTRE + 0.03 * AXIS, 0.1, hidden=3.0, hinge=told).centre
        for told in (AXIS, OTHER)
    )
    assert_allclose(here, there)


def test_a_joint_that_turns_about_its_limb_alone_is_not_held_along_it(rng):
    """A forearm that only turns says nothing about how far along it the elbow is expected."""
    arm = np.array([0.0, -1.0, 0.0])
    turns = rotation_exp(np.deg2rad(60 * np.sin(np.linspace(0, 40, FRAMES)))[:, None] * arm)
    nudged = turns @ rotation_exp(0.1 * np.sin(np.linspace(0, 33, FRAMES))[:, None] * AXIS)
    view = view_of(*seen(rng, nudged, noise=NOISE))
    fit = fit_centre(view, CENTRE + 0.05 * arm, 0.1, hidden=3.0, hinge=AXIS)
    assert np.linalg.norm(fit.centre - CENTRE) < 5e-3


def test_skin_noise_is_what_follows_the_joint_and_no_more(rng):
    modes = joint_modes(ball_turns(rng))
    shape = PARENT * 1e-3
    local = np.tile(shape, (FRAMES, 1, 1))
    local[:, 0] += 0.004 * modes
    local += rng.normal(size=local.shape) * 1e-3
    noise = skin_noise(local, shape, modes)
    grown = np.sqrt(15 / 9)
    assert noise[0] == pytest.approx(0.004 * grown, rel=0.1)
    assert (noise[1:] < 3e-4 * grown).all()


def test_skin_is_as_large_however_many_markers_hide(rng):
    """A fit to fewer markers leaves less of it, and others of it in every frame."""
    modes, shape = joint_modes(ball_turns(rng)), PARENT * 1e-3
    points = shape + np.einsum("mij,fj->fmi", 2e-3 * rng.normal(size=(len(shape), 3, 3)), modes)
    hiding = np.where(rng.random(points.shape[:2])[..., None] < 0.45, np.nan, points)
    told = []
    for some in (points, hiding):
        fit = fit_rigid(shape, some)
        local = into_frame(fit.rotations, fit.shifts, some)
        known = fit.fitted
        noise = skin_noise(local[known], shape, modes[known])
        told.append(float(np.sqrt(np.mean(noise**2))))
    assert told[1] == pytest.approx(told[0], rel=0.15)


def test_what_goes_with_the_joint_by_chance_is_hardly_skin(rng):
    modes = joint_modes(ball_turns(rng))
    shape = PARENT * 1e-3
    jitter = rng.normal(size=(FRAMES, *shape.shape)) * 1e-3
    by_chance = np.sqrt(15 / 9) * 1e-3 * np.sqrt(3 / FRAMES)
    noise = skin_noise(shape + jitter, shape, modes)
    assert 0.2 * by_chance < np.sqrt(np.mean(noise**2)) < 0.7 * by_chance


def worth_of(strays, crowd, hidden=3.0, looks=20.0):
    t = np.linspace(0, 40, len(strays))
    near = nearest_poses(rotation_exp(np.stack([np.sin(t), np.cos(1.3 * t), 0 * t], axis=1)))
    return pose_worth(noise_share(strays, near), crowd, looks, hidden)


def test_noise_counts_by_frames_and_what_lasts_by_poses(rng):
    t = np.linspace(0, 40, 600)
    lasting = np.stack([np.sin(t), np.cos(1.3 * t), np.sin(t) * np.cos(1.3 * t)], axis=1)
    noise, even = rng.normal(size=(600, 3)), np.ones(600)
    lasts, averages, both = (
        worth_of(strays, even).sum() for strays in (lasting, noise, lasting + 0.5 * noise)
    )
    assert lasts == pytest.approx(20 / 9, rel=0.2)
    assert 5 * lasts < averages <= 600
    assert lasts < both < averages


def test_poses_that_are_held_share_what_lasts_but_not_noise(rng):
    t = np.linspace(0, 40, 600)
    lasting = np.stack([np.sin(t), np.cos(1.3 * t), np.sin(t) * np.cos(1.3 * t)], axis=1)
    crowd = np.where(np.arange(600) < 300, 30.0, 1.0)
    held = worth_of(lasting, crowd)
    assert held[0] == pytest.approx(held[-1] / 30, rel=0.05)
    noisy = worth_of(rng.normal(size=(600, 3)), crowd, hidden=1.0)
    assert noisy[0] > noisy[-1] / 10
