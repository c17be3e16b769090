"""Limb frames by the conventions' rule and by the paper's, whose defects are on record here."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.testing import assert_allclose

from kinesphere.geometry.rotations import rotation_angle
from kinesphere.normalization.limb_frames import (
    canonical_direction,
    minimal_frame,
    paper_frame,
    projected_normals,
)

EXACT = 1e-12
DOWN = np.array([0.0, -1.0, 0.0])


def unit(*values):
    return np.array(values) / np.linalg.norm(values)


def abducted(degrees, side=1.0):
    """Return where an arm points that is lifted sideways from hanging."""
    a = np.deg2rad(degrees)
    return np.array([0.0, -np.cos(a), side * np.sin(a)])


@given(seed=st.integers(0, 2**32 - 1))
@settings(deadline=None, max_examples=50)
def test_both_rules_give_a_frame_with_the_limb_on_an_axis(seed):
    points = unit(*np.random.default_rng(seed).normal(size=3))
    frame, along = paper_frame(points)
    for it, axis in ((frame, along), (minimal_frame(points, DOWN), DOWN)):
        assert_allclose(it.T @ it, np.eye(3), atol=EXACT)
        assert np.linalg.det(it) == pytest.approx(1.0)
        assert_allclose(it @ axis, points, atol=EXACT)


def test_a_limb_in_its_ideal_place_has_the_body_frame():
    assert_allclose(minimal_frame(DOWN, DOWN), np.eye(3), atol=EXACT)
    frame, along = paper_frame(DOWN)
    assert_allclose(frame, np.eye(3), atol=EXACT)
    assert_allclose(along, DOWN, atol=EXACT)


def test_the_least_rotation_is_no_larger_than_the_angle():
    points = unit(0.5, -0.7, 0.3)
    turned = rotation_angle(minimal_frame(points, DOWN))
    assert turned == pytest.approx(np.arccos(points @ DOWN))


def test_two_projected_normals_are_not_at_right_angles():
    """For a limb along (.5, .5, −.7) the paper's rule projects two axes that enclose 109.7°."""
    points = unit(0.5, 0.5, -0.7)
    a, b = projected_normals(points, [0, 1]).T
    enclosed = np.rad2deg(np.arccos(a @ b / np.linalg.norm(a) / np.linalg.norm(b)))
    assert enclosed == pytest.approx(109.7, abs=0.05)
    frame, _ = paper_frame(points)
    lean = [np.rad2deg(np.arccos(frame[:, k] @ p / np.linalg.norm(p))) for k, p in ((0, a), (1, b))]
    assert_allclose(lean, (enclosed - 90) / 2, atol=1e-9)  # both give way alike


def test_the_papers_frame_jumps_when_an_arm_is_lifted_past_45_degrees():
    before, after = paper_frame(abducted(44.9))[0], paper_frame(abducted(45.1))[0]
    assert np.rad2deg(rotation_angle(before.T @ after)) == pytest.approx(90, abs=0.5)
    smooth = minimal_frame(abducted(44.9), DOWN).T @ minimal_frame(abducted(45.1), DOWN)
    assert np.rad2deg(rotation_angle(smooth)) == pytest.approx(0.2, abs=1e-6)


@pytest.mark.parametrize("rule", [lambda p: paper_frame(p)[0], lambda p: minimal_frame(p, DOWN)])
def test_left_and_right_mirror_each_other(rule):
    mirror = np.diag([1.0, 1.0, -1.0])
    points = unit(0.2, -0.9, 0.5)
    assert (rule(mirror @ points) == mirror @ rule(points) @ mirror).all()


def test_an_unnamed_limb_points_up_down_or_forward():
    assert_allclose(canonical_direction("limb_07", unit(0.1, 0.9, 0.3), at_end=True), [0, 1, 0])
    assert_allclose(canonical_direction("limb_07", unit(0.6, -0.7, 0.0), at_end=True), [0, -1, 0])
    assert_allclose(canonical_direction("limb_07", unit(0.9, -0.3, 0.2), at_end=True), [1, 0, 0])
    assert_allclose(canonical_direction("limb_07", unit(0.9, -0.3, 0.2), at_end=False), [0, -1, 0])
    assert_allclose(canonical_direction("left_foot", DOWN, at_end=True), [1, 0, 0])
