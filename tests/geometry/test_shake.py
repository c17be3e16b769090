"""What shaking orientations feign, against shaking that we made."""

import numpy as np
import pytest
from numpy.testing import assert_allclose

from kinesphere.geometry.centres import Turning, View
from kinesphere.geometry.pose_errors import point_covariance
from kinesphere.geometry.rotations import rotation_exp
from kinesphere.geometry.shake import clear_of_shake, doubt_of, find_shake
from kinesphere.geometry.skin import fit_through_skin

CENTRE = np.array([0.01, -0.2, 0.2])
INNER = np.array([0.02, 0.25, -0.01])
AXIS = np.array([0.0, 0.0, 1.0])


def covariance(turn_deg, shift):
    sizes = np.concatenate([np.deg2rad(turn_deg), np.full(3, shift)])
    return np.diag(sizes**2)


def view_of(rng, turns, pose, seeing):
    """Return a view whose poses err as told: each by a small turn and a shift in its own frame."""
    n = len(turns)
    own, other = (
        rng.normal(size=(n, 6)) @ np.linalg.cholesky(p + 1e-18 * np.eye(6)).T
        for p in (pose, seeing)
    )
    # the turning limb seen from the seeing one: x = R y + t, each frame off by its own error
    shifts = CENTRE - turns @ INNER
    wrong = rotation_exp(other[:, :3])
    turned = wrong @ turns @ rotation_exp(own[:, :3])
    shifts = (wrong @ (shifts + (turns @ own[:, 3:, None])[..., 0])[..., None])[..., 0]
    nothing = 1e-24 * np.eye(6)
    turning = Turning(turned, shifts + other[:, 3:], pose, 1e-4, nothing, nothing)
    return View(np.full((n, 1, 3), np.nan), np.array([1e-3]), seeing, turning)


def hinge(rng, n, second_deg):
    t = np.linspace(0, 60, n)
    bends = rotation_exp(np.deg2rad(50 - 50 * np.cos(t))[:, None] * AXIS)
    twist = np.deg2rad(second_deg) * np.sin(0.7 * t)[:, None] * np.array([0.0, 1.0, 0.0])
    return bends @ rotation_exp(twist)


def test_the_gradient_is_that_of_the_squares_that_noise_adds(rng):
    view = view_of(
        rng,
        hinge(rng, 40, 5.0),
        covariance([1.0, 2.0, 0.5], 1e-3),
        covariance([0.5, 1.0, 1.5], 2e-3),
    )
    mixed = rng.normal(size=(6, 6)) * 1e-3
    view = View(view.points, view.noise, view.pose + mixed @ mixed.T, view.turning)
    turning, weights = view.turning, rng.uniform(0.5, 2.0, size=40)
    whitening = np.eye(3) + 0.1 * rng.normal(size=(3, 3))

    def squares(x):
        own = point_covariance(turning.pose, turning.place(x))
        carried = turning.back @ point_covariance(view.pose, x) @ np.swapaxes(turning.back, 1, 2)
        whitened = whitening @ (own + carried) @ whitening.T
        return 0.5 * weights @ np.trace(whitened, axis1=1, axis2=2)

    shake, drawn = find_shake(view, turning, CENTRE, whitening, weights)
    step = 1e-3 * np.eye(3)
    slope = [(squares(CENTRE + s) - squares(CENTRE - s)) / 2e-3 for s in step]
    assert_allclose(drawn, slope, rtol=1e-6)
    curve = [find_shake(view, turning, CENTRE + s, whitening, weights)[1] - drawn for s in step]
    assert_allclose(shake, np.array(curve) / 1e-3, rtol=1e-6, atol=1e-9)


def test_where_nothing_shakes_all_is_heard(rng):
    told = np.diag([1.0, 1e4, 1e8])
    curve, heard = clear_of_shake(told, np.zeros((3, 3)), np.zeros((3, 3)))
    assert_allclose(curve, told)
    assert_allclose(heard, np.eye(3), atol=1e-12)


def test_where_all_is_shake_nothing_is_heard_and_the_rest_is(rng):
    told = np.diag([1.0, 4.0, 9.0])
    curve, heard = clear_of_shake(told, np.diag([2.0, 0.0, 0.0]), np.zeros((3, 3)))
    assert_allclose(curve, np.diag([0.0, 4.0, 9.0]), atol=1e-12)
    assert_allclose(heard, np.diag([0.0, 1.0, 1.0]), atol=1e-12)


def test_information_is_less_the_more_is_shake_and_the_less_is_known_of_it():
    told = np.diag([1.0, 4.0, 9.0])

    def known(shake, doubt=0.0):
        curve, heard = clear_of_shake(told, np.diag([shake, 0, 0]), np.diag([doubt, 0.0, 0.0]))
        information = heard @ curve
        assert_allclose(information, information.T, atol=1e-12)
        return information[0, 0]

    assert known(0.5) == pytest.approx(0.25)  # (told - shake)² / told
    assert known(0.5, 1.0) == pytest.approx(0.25 / 2)
    assert known(0.0) > known(0.2) > known(0.8) > known(1.0) == pytest.approx(0.0)


def test_doubt_is_half_of_what_draws_where_the_centre_may_be(rng):
    shake, drawn = np.diag([3.0, 2.0, 1.0]), np.array([0.5, 0.0, -0.2])
    deviations = np.array([0.1, 0.2, 0.05])
    pulls = drawn + (rng.normal(size=(200_000, 3)) * deviations) @ shake
    halves = 0.25 * pulls.T @ pulls / len(pulls)
    assert_allclose(doubt_of(shake, drawn, np.diag(deviations**-2)), halves, atol=1e-3)


def test_a_centre_is_not_drawn_along_a_hinge_by_orientations_that_shake(rng):
    """The same motion, seen again and again: on average the centre is where it is."""
    pose, seeing = covariance([0.8, 1.5, 0.8], 5e-4), covariance([0.8, 1.5, 0.8], 5e-4)
    still = 1e-24 * np.eye(6)
    prior = 1e-4 * np.eye(3)
    free, drawn = [], []
    for _ in range(30):
        view = view_of(rng, hinge(rng, 300, 4.0), pose, seeing)
        fit = fit_through_skin(view, CENTRE, CENTRE, prior, 300.0)
        free.append((fit.centre - CENTRE) @ AXIS)
        calm = Turning(view.turning.rotations, view.turning.shifts, still, 3e-3, still, still)
        calm = View(view.points, view.noise, still, calm)
        fit = fit_through_skin(calm, CENTRE, CENTRE, prior, 300.0)
        drawn.append((fit.centre - CENTRE) @ AXIS)
    assert abs(np.mean(drawn)) > 0.03
    assert abs(np.mean(free)) < 0.15 * abs(np.mean(drawn))
