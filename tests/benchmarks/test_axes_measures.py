"""The benchmark's measures, against cases counted by hand."""

import numpy as np
import pytest
from benchmarks.axes.bars import Bar, number
from benchmarks.axes.estimators import cell
from benchmarks.axes.measures import (
    axis_deviations,
    axis_errors,
    deviations_pairwise,
    deviations_to_mean,
    f1,
    geodesics,
    line_angles,
    mirrored,
    position_deviations,
    rms,
    wrapped,
)
from benchmarks.axes.papers_metrics import random_axes
from numpy.testing import assert_allclose

from kinesphere.geometry.rotations import rotation_about

X, Y, Z = np.eye(3)
EXACT = 1e-9


def about(axis, degrees):
    return rotation_about(np.asarray(axis), np.deg2rad(degrees))


def test_f1_of_masks():
    true = np.array([1, 1, 1, 0, 0, 0], dtype=bool)
    assert f1(true, true) == 1
    assert f1(np.array([1, 1, 0, 1, 0, 0], dtype=bool), true) == pytest.approx(2 / 3)
    assert f1(~true, true) == 0
    assert f1(np.zeros(6, dtype=bool), np.zeros(6, dtype=bool)) == 0


def test_lines_have_no_direction():
    assert_allclose(line_angles(X, np.stack([X, -X, Y])), [0, 0, 90], atol=EXACT)
    tilted = about(Z, 170) @ X
    assert line_angles(X, tilted) == pytest.approx(10)


def test_axes_are_matched_before_they_are_compared():
    true = np.stack([X, Y])
    found = np.stack([-(about(Z, 3) @ Y), about(Y, 4) @ X])
    assert_allclose(axis_errors(found, true), [4, 3], atol=EXACT)
    assert_allclose(axis_errors(np.stack([about(Z, 3) @ Y]), true), [90, 3], atol=EXACT)
    assert_allclose(axis_errors(np.empty((0, 3)), true), [90, 90])


def test_deviations_of_one_turn():
    measured, rebuilt = np.stack([np.eye(3)] * 2), np.stack([about(Z, 30), about(Z, -2e-7)])
    # about one of its axes two of the three move, and no sum is less than that
    assert_allclose(axis_deviations(measured, rebuilt)[0], [30, 30, 0], atol=EXACT)
    assert_allclose(geodesics(measured, rebuilt), [30, 2e-7], rtol=1e-6)
    assert_allclose(axis_deviations(measured, rebuilt)[1, :2], 2e-7, rtol=1e-6)
    lever = np.array([0.15, 0.0, 0.0])
    chord = 2 * 150 * np.sin(np.deg2rad(15))
    assert_allclose(position_deviations(measured, rebuilt, lever), [chord, 0], atol=1e-5)
    assert_allclose(position_deviations(measured, rebuilt, 0.15 * Z), 0, atol=EXACT)


def test_half_a_turn_is_180_degrees():
    assert_allclose(axis_deviations(np.eye(3), about(X, 180)), [0, 180, 180], atol=1e-5)


def test_frames_about_their_mean():
    frames = np.stack([about(Z, 0), about(Z, 6), about(Z, -6)])
    assert_allclose(sorted(deviations_to_mean(frames)), [0] * 5 + [6] * 4, atol=1e-6)
    assert_allclose(sorted(deviations_pairwise(frames)), [0, 0, 0, 6, 6, 6, 6, 12, 12], atol=1e-6)


def test_angles_are_wrapped_half_open():
    assert_allclose(
        wrapped(np.array([0.5, np.pi, -np.pi, 2 * np.pi + 0.25])), [0.5, np.pi, np.pi, 0.25]
    )


def test_a_flexion_axis_is_its_own_mirror_image():
    assert_allclose(mirrored(Z), Z)
    assert_allclose(mirrored(X), -X)
    assert_allclose(mirrored(mirrored(np.array([0.1, 0.2, 0.3]))), [0.1, 0.2, 0.3])


def test_rms_leaves_out_what_nobody_knows():
    assert rms(np.array([3.0, -4.0, np.nan])) == pytest.approx(np.sqrt(12.5))
    assert np.isnan(rms(np.array([np.nan])))


def test_a_cell_counts_runs_not_axes():
    row = cell([[1.0, 3.0], [0.0, 20.0], [2.0, 2.0]])
    assert row["median_deg"] == 2.0
    assert row["failed_percent"] == pytest.approx(100 / 3)
    assert row["worst_deg"] == 20.0


def test_random_axes_are_unit_and_apart(rng):
    for _ in range(50):
        axes = random_axes(rng, 2)
        assert_allclose(np.linalg.norm(axes, axis=1), 1)
        assert line_angles(axes[0], axes[1]) >= 45
    assert random_axes(rng, 1).shape == (1, 3)


@pytest.mark.parametrize(
    ("value", "at_least", "met"),
    [(1.0, False, True), (1.1, False, False), (0.9, True, False), (1.0, True, True)],
)
def test_bars(value, at_least, met):
    bar = Bar("part", "figure", value, "deg", 1.0, at_least)
    assert bar.met == met
    assert bar.verdict == ("met" if met else "**missed**")


def test_figures_carry_their_unit():
    assert Bar("part", "figure", 2e-15, "rad", 1e-9).measured == "2e-15 rad"
    assert Bar("part", "figure", 4.0, "", 0).measured == "4"
    assert Bar("part", "figure", 1.234, "mm", 2).measured == "1.23 mm"
    assert Bar("part", "figure", 0.9, "", 0.95, at_least=True).asked == "≥ 0.95"


def test_nothing_measured_meets_nothing():
    bar = Bar("part", "figure", float("nan"), "deg", 1.0)
    assert not bar.met
    assert bar.as_json()["value"] is None


@pytest.mark.parametrize(
    ("value", "text"),
    [
        (0.0, "0"),
        (2e-9, "2e-09"),
        (3e-14, "0"),
        (0.0123, "0.012"),
        (0.955, "0.955"),
        (3.14159, "3.14"),
        (87.65, "87.7"),
        (1234.5, "1234"),
        (None, "–"),
        (float("nan"), "–"),
    ],
)
def test_numbers_are_short(value, text):
    assert number(value) == text
