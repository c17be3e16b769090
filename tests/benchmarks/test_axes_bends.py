"""What single bends and laid-on frames tell, on cases whose answer is known."""

import numpy as np
import pytest
from benchmarks.axes.bends import HIGH, LOW, bends, scatter
from benchmarks.axes.hinges import make_hinge
from benchmarks.axes.means import MEANS, plain_mean, resisting_mean, spatial_median
from benchmarks.axes.outlying import coverage
from benchmarks.axes.same_person import summary, turned
from numpy.testing import assert_allclose
from scipy.spatial.transform import Rotation

from kinesphere.geometry.rotations import rotation_about, rotation_angle
from kinesphere.parameterization.samples import runs

PLAIN = next(iter(MEANS))
UP = np.array([0.0, 1.0, 0.0])


def cycles(axes, samples=40):
    """Return poses and degrees of a knee that bends and returns about one axis after another."""
    ramp = np.linspace(0.0, 120.0, samples)
    degrees = np.concatenate([ramp if i % 2 == 0 else ramp[::-1] for i in range(len(axes))])
    around = np.repeat(axes, samples, axis=0)
    return Rotation.from_rotvec(np.deg2rad(degrees)[:, None] * around).as_matrix(), degrees


def tilted(degrees):
    return rotation_about(UP, np.deg2rad(degrees)) @ [0.0, 0.0, 1.0]


def test_every_bend_and_return_tells_its_own_axis():
    tilts = np.array([0.0, 3.0, -2.0, 5.0, 1.0, -4.0])
    axes = np.array([tilted(t) for t in tilts])
    turns, degrees = cycles(axes)
    turns[7], degrees[60] = np.nan, np.nan
    found = bends(turns, degrees)
    assert [bending for _, bending, _ in found] == [True, False] * 3
    assert_allclose(np.array([axis for _, _, axis in found]), axes, atol=1e-9)
    assert [frame // 40 for frame, _, _ in found] == list(range(6))


def test_scatter_leads_to_the_difference_of_halves_that_it_leads_to(rng):
    """Of many trials of ten bends with one axis the halves differ as expected, rms."""
    expected, halves = [], []
    for _ in range(400):
        found = [
            (i, i % 2 == 0, np.array([*np.deg2rad(rng.normal(scale=2.0, size=2)), 1.0]))
            for i in range(10)
        ]
        row = scatter(found, 5)
        expected.append(row["expected_deg"])
        halves.append(row["means_deg"][PLAIN])
    rms = [np.sqrt(np.mean(np.square(x))) for x in (expected, halves)]
    assert rms[0] == pytest.approx(2.0 * np.sqrt(2 * 2 / 5), rel=0.05)
    assert rms[0] == pytest.approx(rms[1], rel=0.1)


def test_hysteresis_and_the_first_bend_are_told_apart():
    tilts = [20.0, 20.0, *[0.0, 4.0] * 4]
    found = [(i, i % 2 == 0, tilted(t)) for i, t in enumerate(tilts)]
    row = scatter(found, 4.5)
    assert row["n"] == 10
    assert row["means_deg"][PLAIN] == pytest.approx(44 / 5 - 12 / 5, rel=0.02)
    assert row["without_first"]["means_deg"][PLAIN] == pytest.approx(12 / 5 - 4 / 3, rel=0.01)
    same = scatter([(i, i % 2 == 0, tilted(0.0)) for i in range(8)], 4)
    assert same["hysteresis_deg"] == same["scatter_deg"] == 0.0
    assert scatter(found[2:], 7)["hysteresis_deg"] == pytest.approx(4.0, abs=0.01)
    assert scatter(found[:5], 2) is None
    assert scatter(found, 0) is None
    assert bends(np.tile(np.eye(3), (5, 1, 1)), np.full(5, (LOW + HIGH) / 2)) == []


def test_means_that_resist_leave_an_outlier_aside():
    """Nine axes within a degree and one at 40°: Weiszfeld's and the t mean stay with the nine."""
    axes = np.array([tilted(t) for t in [*np.linspace(-1.0, 1.0, 9), 40.0]])
    plain, resisting, median = (mean(axes) for mean in MEANS.values())
    assert np.rad2deg(np.arccos(plain @ tilted(0.0))) > 3.5
    for mean in (resisting, median):
        assert np.rad2deg(np.arccos(mean @ tilted(0.0))) < 0.5
        assert np.linalg.norm(mean) == pytest.approx(1.0)


@pytest.mark.parametrize("mean", MEANS.values())
@pytest.mark.parametrize("tilts", [[3.0], [1.0, 5.0], [3.0] * 4, [-2.0, 8.0, 3.0, 3.0]])
def test_means_of_few_or_alike_axes_are_the_plain_one(mean, tilts):
    assert_allclose(mean(np.array([tilted(t) for t in tilts])), tilted(3.0), atol=1e-9)


def test_means_turn_with_their_axes(rng):
    axes = rng.normal(scale=0.05, size=(7, 3)) + np.array([0.0, 0.0, 1.0])
    axes /= np.linalg.norm(axes, axis=1)[:, None]
    turn = Rotation.random(rng=rng).as_matrix()
    for mean in (plain_mean, resisting_mean, spatial_median):
        assert_allclose(mean(axes @ turn.T), turn @ mean(axes), atol=1e-9)


def test_only_the_first_bend_of_a_hinge_is_lifted():
    joint = make_hinge(np.random.default_rng(4), "clean", 6.0)
    off = np.rad2deg(rotation_angle(joint.rotations @ np.swapaxes(joint.clean.rotations, 1, 2)))
    first, *others = runs(joint.moving)
    assert len(others) == 4
    assert off[slice(*first)].max() == pytest.approx(6.0, abs=0.01)
    off[slice(*first)] = 0.0
    assert off.max() < 1e-6
    plain = make_hinge(np.random.default_rng(4), "clean", 0.0)
    assert_allclose(plain.rotations, joint.clean.rotations, atol=1e-12)


@pytest.mark.parametrize("kind", ["turning", "renewed"])
def test_a_hinge_turns_about_its_limb_alone_by_as_much_as_asked_for(kind):
    plain = make_hinge(np.random.default_rng(4), "OU 1°")
    limb = plain.long_axis
    squares = []
    for seed in range(24):
        joint = make_hinge(np.random.default_rng(seed), "OU 1°", **{kind: 4.0})
        turns = np.rad2deg(joint.angles - make_hinge(np.random.default_rng(seed), "OU 1°").angles)
        assert_allclose(turns[:, :2], 0.0)
        squares.append((turns[joint.moving, 2] ** 2).mean())
        still = np.abs(turns[~joint.moving, 2]).max()
        assert still < 1e-9 if kind == "renewed" else still > 1.0
    assert np.sqrt(np.mean(squares)) == pytest.approx(4.0, rel=0.2)
    turned = make_hinge(np.random.default_rng(4), "OU 1°", **{kind: 4.0})
    assert_allclose(turned.rotations @ limb, plain.rotations @ limb, atol=1e-12)
    assert np.abs(turned.rotations - plain.rotations).max() > 0.02


def test_errors_are_counted_against_what_was_said_of_them():
    errors, said = np.array([0.5, 1.5, 3.0, 1.0]), np.array([1.0, 1.0, 1.0, 2.0])
    assert coverage(errors, said) == {"within_1_percent": 50.0, "within_2_percent": 75.0}


def test_frames_are_laid_upon_each_other_by_their_markers(rng):
    places = {f"M{i}": x for i, x in enumerate(rng.normal(size=(4, 3)))}
    turn = Rotation.random(rng=rng).as_matrix()
    moved = {name: turn @ place + 0.3 for name, place in places.items()}
    assert_allclose(turned(places, moved), turn, atol=1e-12)
    assert turned(places, dict(list(moved.items())[:2])) is None


def test_the_same_frames_deviate_by_nothing_and_a_turned_one_by_its_angle(rng):
    places = rng.normal(size=(4, 3))

    def trial(degrees, *, good=True):
        turn = rotation_about(UP, np.deg2rad(degrees))
        held = {f"M{i}": (turn @ x).tolist() for i, x in enumerate(places)}
        return {"good": good, "paper": {"left_thigh": held}, "default": {"left_thigh": held}}

    same = summary([trial(0.0), trial(0.0), {}, trial(50.0, good=False)])
    assert (same["trials"], same["good"]) == (3, 2)
    assert same["parts"]["thighs, shanks"]["default"]["pairwise"]["mean"] < 1e-6
    apart = summary([trial(0.0), trial(3.0)])["parts"]["thighs, shanks"]["paper"]
    assert apart["pairwise"]["mean"] == pytest.approx(2.0)  # two axes turn by 3, one by nothing
    assert apart["mean"]["mean"] == pytest.approx(1.0)
    assert summary([])["parts"] == {}
