"""Angles about one, two and three axes, and the branch they take."""

import numpy as np
import pytest
from numpy.testing import assert_allclose
from scipy.spatial.transform import Rotation

from kinesphere.geometry.chain import joint_rotations
from kinesphere.parameterization.angles import solve_angles, unwrapped
from kinesphere.parameterization.settings import AngleSettings, TwistSettings

EXACT = 1e-9  # rad; rounding leaves some 1e-12 away from singular poses


def unit(rng):
    v = rng.normal(size=3)
    return v / np.linalg.norm(v)


def draw_joint(rng, between, cone=90.0):
    """Two axes ``between`` deg apart, a limb at ``cone`` deg to both, all in any frame."""
    half = np.deg2rad(between) / 2
    axes = np.array([[np.sin(half), np.cos(half), 0], [-np.sin(half), np.cos(half), 0]])
    up = np.cos(np.deg2rad(cone)) / np.cos(half)
    direction = np.array([0, up, np.sqrt(1 - up**2)])
    long_axis = unit(rng)
    turn = Rotation.random(rng=rng)
    swing, _ = Rotation.align_vectors([direction], [turn.apply(long_axis)])
    frame = Rotation.random(rng=rng)
    axes = axes[:: rng.choice([-1, 1])]  # the limb may rest on either side of their plane
    return frame.apply(axes), (frame * swing * turn).as_matrix(), long_axis


def solve(rotations, axes, rest, long_axis, branch="viterbi", known=None):
    known = np.ones(len(rotations), dtype=bool) if known is None else known
    return solve_angles(
        rotations, axes, rest, long_axis, known, AngleSettings(branch=branch), TwistSettings()
    )


def smooth(rng, n, amplitudes):
    """Angles that swing slowly, (n, len(amplitudes)) rad, each reaching its amplitude in deg."""
    t = np.linspace(0, 1, n)[:, None]
    waves = sum(
        rng.normal(size=len(amplitudes))
        * np.sin(2 * np.pi * f * t + rng.uniform(0, 6, len(amplitudes)))
        for f in range(1, 6)
    )
    return np.deg2rad(amplitudes) * waves / np.abs(waves).max(axis=0)


@pytest.mark.parametrize(("between", "cone"), [(70, 90), (90, 75), (110, 100), (45, 90)])
def test_two_axes_return_what_was_put_in(rng, between, cone):
    axes, rest, long_axis = draw_joint(rng, between, cone)
    truth = smooth(rng, 120, [60, 80, 40])
    rotations = joint_rotations(axes, rest, long_axis, truth[:, :2], truth[:, 2])
    solved = solve(rotations, axes, rest, long_axis)
    assert_allclose(solved.angles[:, :2], truth[:, :2], atol=EXACT)
    assert np.isnan(solved.angles[:, 2]).all()
    assert_allclose(solved.twists, truth[:, 2], atol=EXACT)
    assert solved.excess.max() < EXACT


def test_one_axis_returns_what_was_put_in(rng):
    axes, rest, long_axis = draw_joint(rng, 90, 80)
    truth = smooth(rng, 90, [150, 100])
    rotations = joint_rotations(axes[:1], rest, long_axis, truth[:, :1], truth[:, 1])
    solved = solve(rotations, axes[:1], rest, long_axis)
    assert_allclose(solved.angles[:, 0], truth[:, 0], atol=EXACT)
    assert np.isnan(solved.angles[:, 1:]).all()
    assert_allclose(solved.twists, truth[:, 1], atol=EXACT)
    assert solved.excess.max() < EXACT


def test_one_axis_says_how_far_outside_its_cone_the_limb_is(rng):
    axis, long_axis = np.eye(3)[2], np.eye(3)[0]
    tilt = Rotation.from_rotvec([0, -np.deg2rad(13), 0])  # x towards z, out of the plane
    rotations = (Rotation.from_rotvec([0, 0, 0.7]) * tilt).as_matrix()[None]
    solved = solve(rotations, axis[None], np.eye(3), long_axis)
    assert solved.angles[0, 0] == pytest.approx(0.7, abs=EXACT)
    assert solved.excess[0] == pytest.approx(np.deg2rad(13), abs=EXACT)


def test_three_axes_of_any_direction_leave_no_twist(rng):
    axes, rest, long_axis = draw_joint(rng, 75, 85)
    axes = np.stack([unit(rng), *axes])
    truth = smooth(rng, 110, [50, 40, 60])
    rotations = joint_rotations(axes, rest, long_axis, truth, np.zeros(110))
    solved = solve(rotations, axes, rest, long_axis)
    rebuilt = joint_rotations(axes, rest, long_axis, solved.angles, solved.twists)
    assert_allclose(solved.twists, 0, atol=0)
    reached = solved.excess < EXACT
    assert reached.mean() > 0.9
    assert_allclose(rebuilt[reached], rotations[reached], atol=1e-7)


def test_angles_lie_above_minus_pi_up_to_pi(rng):
    axes, rest, long_axis = draw_joint(rng, 90)
    half_turn = joint_rotations(
        axes[:1], rest, long_axis, np.array([[np.pi], [-np.pi]]), np.zeros(2)
    )
    solved = solve(half_turn, axes[:1], rest, long_axis)
    assert_allclose(np.abs(solved.angles[:, 0]), np.pi, atol=EXACT)
    assert (solved.angles[:, 0] > -np.pi).all()


@pytest.mark.parametrize(("branch", "most"), [("viterbi", 0.01), ("smallest-twist", 0.03)])
def test_wide_swings_take_the_right_branch(rng, branch, most):
    wrong, rules = [], []
    for _ in range(4):
        axes, rest, long_axis = draw_joint(rng, 80)
        truth = smooth(rng, 600, [140, 60, 30])
        rotations = joint_rotations(axes, rest, long_axis, truth[:, :2], truth[:, 2])
        for found, rule in ((wrong, branch), (rules, "default-sign")):
            angles = solve(rotations, axes, rest, long_axis, rule).angles[:, :2]
            off = np.abs(np.angle(np.exp(1j * (angles - truth[:, :2])))).max(axis=1)
            found.append((off > np.deg2rad(30)).mean())
    assert np.mean(wrong) <= most
    assert np.mean(rules) > 0.1  # the rest position's side alone is not enough


@pytest.mark.parametrize("turn", [1, -1])
def test_without_twist_the_path_stays_on_the_side_of_rest(rng, turn):
    axes, rest, long_axis = draw_joint(rng, 90)
    axes = axes[::turn]
    truth = smooth(rng, 200, [60, 60, 170])
    rotations = joint_rotations(axes, rest, long_axis, truth[:, :2], truth[:, 2])
    solved = solve(rotations, axes, rest, long_axis, known=np.zeros(200, dtype=bool))
    assert_allclose(solved.angles[:, :2], truth[:, :2], atol=EXACT)
    assert np.isnan(solved.twists).all()


def test_a_gap_leaves_all_other_frames_as_they_were(rng):
    axes, rest, long_axis = draw_joint(rng, 100)
    truth = smooth(rng, 80, [110, 60, 20])
    rotations = joint_rotations(axes, rest, long_axis, truth[:, :2], truth[:, 2])
    whole = solve(rotations, axes, rest, long_axis)
    rotations[30:37] = np.nan
    gappy = solve(rotations, axes, rest, long_axis)
    assert np.isnan(gappy.angles[30:37]).all()
    assert np.isnan(gappy.twists[30:37]).all()
    seen = np.isfinite(rotations[:, 0, 0])
    assert (gappy.angles[seen, :2] == whole.angles[seen, :2]).all()


def test_turning_on_and_on_unwraps(rng):
    turning = np.linspace(0, 15, 90)[:, None] * [1.0, -0.4]
    wrapped = np.angle(np.exp(1j * turning))
    assert_allclose(unwrapped(wrapped), turning, atol=1e-12)
    wrapped[20:24, 0] = np.nan
    wrapped[:, 1] = np.nan
    found = unwrapped(wrapped)
    seen = np.isfinite(wrapped[:, 0])
    assert_allclose(found[seen, 0], turning[seen, 0], atol=1e-12)
    assert np.isnan(found[~seen]).all()
    assert np.isnan(found[:, 1]).all()


def test_the_singularity_measure_is_the_sine_of_the_angle_to_the_plane(rng):
    axes, rest, long_axis = draw_joint(rng, 80, 90)
    normal = np.cross(*axes)
    normal /= np.linalg.norm(normal)
    theta = np.linspace(-1.5, 1.5, 31)
    rotations = joint_rotations(
        axes, rest, long_axis, np.stack([theta, 0.3 * theta], axis=1), 0 * theta
    )
    before_proximal = joint_rotations(axes[:1], rest, long_axis, theta[:, None], 0 * theta)
    expected = np.abs(before_proximal @ long_axis @ normal)
    assert_allclose(solve(rotations, axes, rest, long_axis).sines, expected, atol=1e-7)


def test_a_limb_along_the_proximal_axis_has_angles_all_the_same():
    axes = np.eye(3)[[0, 1]]
    for direction in (axes[1], -axes[1]):
        turn, _ = Rotation.align_vectors([direction], [[0.0, 0.0, 1.0]])
        solved = solve(turn.as_matrix()[None], axes, np.eye(3), np.array([0.0, 0.0, 1.0]))
        assert np.isfinite(solved.angles[0, :2]).all()
        assert solved.sines[0] < 1e-6


def test_a_limb_spun_about_itself_keeps_its_branch_where_angles_run_on(rng):
    axes, rest, long_axis = draw_joint(rng, 70)
    n = 2000
    truth = smooth(rng, n, [50, 60, 1])
    truth[:, 2] += 16 * np.pi * np.clip(np.linspace(-0.2, 1.2, n), 0, 1)
    rotations = joint_rotations(axes, rest, long_axis, truth[:, :2], truth[:, 2])
    known = np.ones(n, dtype=bool)
    solved = solve_angles(
        rotations, axes, rest, long_axis, known, AngleSettings(unwrap=True), TwistSettings()
    )
    assert_allclose(solved.angles[:, :2], truth[:, :2], atol=EXACT)
    assert_allclose(unwrapped(solved.twists), truth[:, 2], atol=1e-8)


@pytest.mark.parametrize("branch", ["viterbi", "smallest-twist"])
def test_the_size_of_a_turn_about_the_first_of_three_axes_does_not_matter(rng, branch):
    axes, rest, long_axis = draw_joint(rng, 90)
    axes = np.array([rest @ long_axis, *axes])
    truth = smooth(rng, 400, [170, 60, 60])
    rotations = joint_rotations(axes, rest, long_axis, truth, np.zeros(400))
    assert_allclose(solve(rotations, axes, rest, long_axis, branch).angles, truth, atol=EXACT)


def shaken(rng, rotations, deg):
    """Turn every frame by itself about anything, ``deg`` about each axis."""
    return (
        Rotation.from_rotvec(np.deg2rad(deg) * rng.normal(size=(len(rotations), 3))).as_matrix()
        @ rotations
    )


def wrong(angles, truth):
    """Return the share of frames with an angle more than 30 deg off."""
    off = np.abs(np.angle(np.exp(1j * (angles - truth)))).max(axis=1)
    return (off > np.deg2rad(30)).mean()


def test_a_limb_spun_about_itself_keeps_its_branch_also_where_angles_are_wrapped(rng):
    n = 1200
    for most in (130, 170):
        axes, rest, long_axis = draw_joint(rng, 70)
        truth = smooth(rng, n, [45, 60, most])
        rotations = joint_rotations(axes, rest, long_axis, truth[:, :2], truth[:, 2])
        solved = solve(shaken(rng, rotations, 1.0), axes, rest, long_axis)
        assert wrong(solved.angles[:, :2], truth[:, :2]) == 0


@pytest.mark.parametrize("unwrap", [False, True])
def test_noise_of_standing_never_buys_a_change_of_branch(rng, unwrap):
    n, rate = 4500, 50.0
    settings = AngleSettings(unwrap=unwrap)
    for _ in range(6):
        axes, rest, long_axis = draw_joint(rng, 80, 80)
        if not unwrap:
            axes = np.array([rest @ long_axis, *axes])
        truth = np.where(np.arange(n)[:, None] % 1500 < 300, smooth(rng, n, [40, 30, 40]), 0)
        if unwrap:
            rotations = joint_rotations(axes, rest, long_axis, truth[:, 1:], truth[:, 0])
        else:
            rotations = joint_rotations(axes, rest, long_axis, truth, np.zeros(n))
        known = np.ones(n, dtype=bool)
        solved = solve_angles(
            shaken(rng, rotations, 3.0),
            axes,
            rest,
            long_axis,
            known,
            settings,
            TwistSettings(),
            rate,
        )
        found = solved.angles[:, :2] if unwrap else solved.angles
        assert wrong(found, truth[:, 1:] if unwrap else truth) == 0


@pytest.mark.parametrize("axes_told", [2, 3])
def test_after_a_gap_the_angles_are_not_half_a_turn_off(rng, axes_told):
    n, rate = 600, 50.0
    settings = AngleSettings(unwrap=axes_told == 2)
    for _ in range(20):
        axes, rest, long_axis = draw_joint(rng, 80)
        truth = smooth(rng, n, [60, 60, 90])
        if axes_told == 3:
            axes = np.array([rest @ long_axis, *axes])
            truth = truth[:, [2, 0, 1]]
            rotations = joint_rotations(axes, rest, long_axis, truth, np.zeros(n))
        else:
            rotations = joint_rotations(axes, rest, long_axis, truth[:, :2], truth[:, 2])
        for start in rng.integers(0, n - 40, 3):
            rotations[start : start + 40] = np.nan
        solved = solve_angles(
            rotations, axes, rest, long_axis, np.ones(n, bool), settings, TwistSettings(), rate
        )
        seen = np.isfinite(solved.angles[:, 0])
        assert seen.mean() > 0.7
        assert wrong(solved.angles[seen, :axes_told], truth[seen, :axes_told]) == 0


def test_one_mistaken_at_a_singularity_finds_back_where_angles_run_on(rng):
    n, rate, shares = 600, 50.0, []
    for _ in range(20):
        axes, rest, long_axis = draw_joint(rng, 80)
        truth = smooth(rng, n, [140, 60, 30])
        rotations = joint_rotations(axes, rest, long_axis, truth[:, :2], truth[:, 2])
        solved = solve_angles(
            shaken(rng, rotations, 3.0),
            axes,
            rest,
            long_axis,
            np.ones(n, bool),
            AngleSettings(unwrap=True),
            TwistSettings(),
            rate,
        )
        shares.append(wrong(solved.angles[:, :2], truth[:, :2]))
    assert max(shares) < 0.1  # 12 % where only the whole path is mirrored
