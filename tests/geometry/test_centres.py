"""Joint centres against ones we placed: exact, noisy, hinged, silent."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.testing import assert_allclose
from scipy.spatial.transform import Rotation

from kinesphere.geometry.algebraic_centres import score_centre, sphere_centre
from kinesphere.geometry.centres import Turning, View, fit_centre
from kinesphere.geometry.pose_errors import pose_covariance
from kinesphere.geometry.rigid import into_frame, out_of_frame

FRAMES = 150
CENTRE = np.array([0.1, -0.2, 0.05])
CHILD = np.array([[0.03, -0.2, 0.05], [-0.04, -0.3, 0.02], [0.02, -0.25, -0.06]])
PARENT = np.array([[0.1, 0.1, 0.0], [-0.1, 0.12, 0.02], [0.0, 0.05, 0.1], [0.0, 0.08, -0.1]])
SPREAD = 0.02
EXACT = 1e-6  # m; the noise floor of the weights keeps it from zero
NOISE = 1e-3  # m


def turns(rng, axes):
    t = np.linspace(0, 1, FRAMES)
    waves = np.sin(np.outer(t, [7.0, 11.0, 13.0]) + rng.uniform(0, 6, 3))
    return Rotation.from_rotvec(0.7 * waves * axes).as_matrix()


def view_of(rng, axes, *, noise=0.0, n_child=2, turning=False):
    """Return the child's markers as the parent sees them, and the child's orientation."""
    r = turns(rng, axes)
    child = out_of_frame(r, np.tile(CENTRE, (FRAMES, 1)), CHILD)
    own = np.full(4, max(noise, NOISE))
    if noise:
        child = child + rng.normal(scale=noise, size=child.shape)
    spin = None
    if turning:
        spin = Turning(r, np.tile(CENTRE, (FRAMES, 1)), pose_covariance(CHILD, own[:3]), NOISE)
    return View(child[:, :n_child], own[:n_child], pose_covariance(PARENT, own), spin)


@pytest.mark.parametrize("turning", [False, True])
@pytest.mark.parametrize("n_child", [1, 2, 3])
def test_a_ball_joint_is_found_whatever_was_expected(rng, n_child, turning):
    view = view_of(rng, (1, 1, 1), n_child=n_child, turning=turning)
    fit = fit_centre(view, CENTRE + np.array([0.02, 0.015, -0.01]), SPREAD)
    assert_allclose(fit.centre, CENTRE, atol=EXACT)


def test_a_hinge_is_exact_across_and_as_expected_along(rng):
    expected = CENTRE + np.array([0.03, 0.01, -0.01])
    fit = fit_centre(view_of(rng, (1, 0, 0)), expected, SPREAD)
    assert_allclose(fit.centre[1:], CENTRE[1:], atol=EXACT)
    assert fit.centre[0] == pytest.approx(expected[0], abs=1e-4)
    deviations = np.sqrt(np.diag(fit.data_covariance))
    assert deviations[0] > 10 * SPREAD
    assert deviations[1:].max() < EXACT


def test_a_limb_that_does_not_move_stays_where_it_is_expected(rng):
    view = view_of(rng, (0, 0, 0), noise=1e-4)
    expected = CENTRE + np.array([0.02, -0.01, 0.01])
    fit = fit_centre(view, expected, SPREAD, hidden=3.0)
    assert np.linalg.norm(fit.centre - expected) < 0.2 * SPREAD
    assert np.sqrt(np.linalg.eigvalsh(fit.data_covariance)).min() > 0.5 * SPREAD


def test_noise_shows_in_the_covariance_and_little_in_the_centre(rng):
    fit = fit_centre(view_of(rng, (1, 1, 1), noise=NOISE), CENTRE + 0.01, SPREAD)
    error = fit.centre - CENTRE
    assert np.linalg.norm(error) < 3 * NOISE
    assert fit.noise == pytest.approx(NOISE, rel=0.3)
    # frames count by distinct poses, far fewer than there are: the error is well inside
    assert error @ np.linalg.solve(fit.covariance, error) < 16.3  # chi² of 3, one in a thousand


def test_a_shaky_frame_does_not_draw_the_centre_to_its_axis(rng):
    """A parent whose twist wobbles sees the child on circles about its own long axis."""
    thin = np.array([[0.0, 0.0, 0.0], [0.0, -0.4, 0.0], [0.0, -0.2, 0.03]])
    centre = np.array([0.0, -0.42, 0.05])  # off the long axis, as a knee is
    wobble, draws = 0.05, 6
    shaky = wobble * np.sqrt(2 / 3) * 0.03  # m, noise of the thin body's points that wobbles it so
    drawn = {shaky: 0.0, 1e-6: 0.0}
    for _ in range(draws):
        r = turns(rng, (0, 0.3, 1.2))
        child = out_of_frame(r, np.tile(centre, (FRAMES, 1)), CHILD)
        twist = np.outer(rng.normal(scale=wobble, size=FRAMES), [0, 1, 0])
        turned = Rotation.from_rotvec(twist).as_matrix()
        child = into_frame(turned, np.zeros((FRAMES, 3)), child)
        child = child + rng.normal(scale=NOISE, size=child.shape)
        for noise in drawn:
            view = View(child[:, :2], np.full(2, NOISE), pose_covariance(thin, np.full(3, noise)))
            drawn[noise] += (centre - fit_centre(view, centre, 1.0).centre)[2] / draws
    assert drawn[1e-6] > 0.01  # without: a centimetre and more towards the axis
    assert abs(drawn[shaky]) < 0.5 * drawn[1e-6]


def test_noise_about_a_hinge_is_not_taken_for_motion_along_it(rng):
    fit = fit_centre(view_of(rng, (1, 0, 0), noise=4 * NOISE), CENTRE, SPREAD)
    deviations = np.sqrt(np.diag(fit.data_covariance))
    assert deviations[0] > 0.1  # m; the noise alone would make it a few centimetres
    assert deviations[1:].max() < SPREAD


def test_outliers_hardly_move_the_centre(rng):
    view = view_of(rng, (1, 1, 1), noise=NOISE)
    points = view.points.copy()
    points[::15] += 0.1
    fit = fit_centre(View(points, view.noise, view.pose), CENTRE + 0.01, SPREAD)
    assert np.linalg.norm(fit.centre - CENTRE) < 5 * NOISE


@given(seed=st.integers(0, 2**32 - 1))
@settings(deadline=None, max_examples=5)
def test_the_centre_does_not_care_for_order_time_or_gaps(seed):
    rng = np.random.default_rng(seed)
    view = view_of(rng, (1, 1, 1), noise=NOISE)
    expected = CENTRE + np.array([0.01, 0.0, -0.01])
    fit = fit_centre(view, expected, SPREAD)
    backwards = View(view.points[::-1, ::-1].copy(), view.noise[::-1], view.pose)
    assert_allclose(fit_centre(backwards, expected, SPREAD).centre, fit.centre, atol=EXACT)
    gaps = np.concatenate([view.points, np.full((9, 2, 3), np.nan)])
    assert_allclose(
        fit_centre(View(gaps, view.noise, view.pose), expected, SPREAD).centre,
        fit.centre,
        atol=EXACT,
    )


def test_nothing_seen_leaves_the_expectation():
    fit = fit_centre(View(np.full((5, 1, 3), np.nan), np.array([NOISE]), np.eye(6)), CENTRE, SPREAD)
    assert_allclose(fit.centre, CENTRE, atol=EXACT)
    assert fit.n_poses == 1


def test_score_finds_one_point_in_both_limbs_whichever_comes_first(rng):
    r, centre_in_child = turns(rng, (1, 1, 1)), np.array([0.02, 0.3, -0.1])
    shifts = CENTRE - r @ centre_in_child
    a, b, rms = score_centre(r, shifts, ridge=0.0)
    assert_allclose(a, CENTRE, atol=1e-9)
    assert_allclose(b, centre_in_child, atol=1e-9)
    assert rms < 1e-9
    back = np.swapaxes(r, 1, 2)
    swapped_b, swapped_a, _ = score_centre(back, (-back @ shifts[..., None])[..., 0], ridge=0.0)
    assert_allclose(swapped_a, a, atol=1e-9)
    assert_allclose(swapped_b, b, atol=1e-9)


def test_spheres_have_one_centre_and_a_silent_set_none(rng):
    points = view_of(rng, (1, 1, 1)).points
    assert_allclose(sphere_centre(points, CENTRE + 0.1, ridge=0.0), CENTRE, atol=1e-9)
    still = np.full((5, 1, 3), np.nan)
    assert_allclose(sphere_centre(still, CENTRE), CENTRE, atol=0)


def test_four_looks_at_a_sphere_tell_nothing(rng):
    """A centre and a distance fit any four points."""
    directions = rng.normal(size=(40, 3))
    directions /= np.linalg.norm(directions, axis=1, keepdims=True)
    told = []
    for n in (4, 40):
        seen = (CENTRE + 0.3 * directions[:n])[:, None]
        view = View(seen, np.array([NOISE]), pose_covariance(PARENT, np.full(len(PARENT), 1e-9)))
        told.append(fit_centre(view, CENTRE, SPREAD).covariance)
    assert_allclose(told[0], SPREAD**2 * np.eye(3), rtol=1e-6)
    assert np.linalg.eigvalsh(told[1])[2] < 0.1 * SPREAD**2


def test_few_looks_make_a_centre_less_sure_not_nearer_to_its_expectation(rng):
    """Seen in a narrow cone it is known badly along that, and expected elsewhere there."""
    strays, told = [], []
    for _ in range(30):
        directions = rng.normal(size=(8, 3)) * [0.35, 0.35, 0] + [0, 0, 1]
        directions /= np.linalg.norm(directions, axis=1, keepdims=True)
        seen = np.repeat(CENTRE + 0.3 * directions, 20, axis=0)
        seen = (seen + rng.normal(scale=NOISE, size=seen.shape))[:, None]
        view = View(seen, np.array([NOISE]), pose_covariance(PARENT, np.full(len(PARENT), 1e-9)))
        expected = CENTRE + np.array([0, 0, 0.03])
        fit = fit_centre(view, expected, SPREAD)
        strays.append(fit.centre - CENTRE)
        told.append(np.trace(fit.covariance))
    squares = np.square(strays).sum(axis=1)
    assert np.sqrt(squares.mean()) < 8.5e-3  # pulled by four looks fewer: 10 mm
    assert np.sqrt((squares / told).mean()) < 1.35  # told as if all looks counted: 1.4
