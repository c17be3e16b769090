"""Linked bodies fitted all at once, against linkages we hung ourselves."""

import numpy as np
import pytest
from numpy.testing import assert_allclose
from scipy.ndimage import gaussian_filter1d

from kinesphere.geometry.linkage import Linkage, by_pose_of, equations, idle, misfit
from kinesphere.geometry.linkage_fit import fit_linkage, pose_linkage
from kinesphere.geometry.rotations import rotation_angle, rotation_exp

FRAMES = 150
COUNTS = (4, 2, 5)
NEARLY = 1e-4
"""m: the fit ends where a step is a tenth of this."""


def smooth(rng, scale):
    walk = gaussian_filter1d(rng.normal(size=(FRAMES, 3)), 4, axis=0)
    return scale * walk / walk.std(axis=0)


@pytest.fixture
def hung(rng):
    """Three bodies, one after another, the middle one of two markers."""
    shapes = [rng.normal(scale=0.06, size=(n, 3)) for n in COUNTS]
    shapes[1] = np.array([[0.02, -0.06, 0.0], [-0.01, -0.21, 0.02]])
    centres = np.array([[0.0, 0.0, 0.0], [0.05, -0.08, 0.02], [0.01, -0.27, 0.0]])
    rotations = np.stack([rotation_exp(smooth(rng, 0.6)) for _ in COUNTS], axis=1)
    return Linkage((-1, 0, 1), tuple(shapes), centres, rotations, smooth(rng, 0.1))


def markers(linkage):
    empty = np.zeros((FRAMES, sum(len(s) for s in linkage.shapes), 3))
    return misfit(linkage, empty, np.ones(empty.shape[:2], dtype=bool))


def shaken(rng, linkage, size=0.01, turn=0.2):
    """Return the linkage as somebody might first take it to be."""
    others = tuple(s + size * rng.normal(size=s.shape) for s in linkage.shapes[1:])
    centres = linkage.centres + size * rng.normal(size=(3, 3))
    off = rotation_exp(turn * rng.normal(size=(FRAMES, 3, 3)))
    return linkage._replace(
        shapes=(linkage.shapes[0], *others), centres=centres, rotations=off @ linkage.rotations
    )


def ends(linkage):
    """Distances of every body's markers from both its joints: no choice of frame changes them."""
    first = np.linalg.norm(linkage.shapes[1], axis=1)
    second = np.linalg.norm(linkage.shapes[1] - linkage.centres[2], axis=1)
    return np.concatenate([first, second, np.linalg.norm(linkage.shapes[2], axis=1)])


def fitted(start, points, expected):
    return fit_linkage(start, points, expected, np.array([0.0, 400.0, 400.0]), looks=20.0)


def test_what_was_hung_is_found(rng, hung):
    start = shaken(rng, hung)
    fit = fitted(start, markers(hung), start.centres)
    assert_allclose(fit.linkage.centres[1], hung.centres[1], atol=NEARLY)
    assert_allclose(ends(fit.linkage), ends(hung), atol=NEARLY)
    assert np.linalg.norm(start.centres[1] - hung.centres[1]) > 0.005  # there was something to find


def test_gaps_and_a_foreign_stretch_change_little(rng, hung):
    points = markers(hung) + 0.0005 * rng.normal(size=(FRAMES, sum(COUNTS), 3))
    points[rng.random(points.shape[:2]) < 0.05] = np.nan
    points[20:30, 8] += 0.05
    start = shaken(rng, hung)
    fit = fitted(start, points, start.centres)
    assert_allclose(ends(fit.linkage), ends(hung), atol=2e-3)
    assert fit.scale == pytest.approx(0.0005, rel=0.3)


def test_what_is_told_says_how_far_off_centres_are(rng, hung):
    """Frames are all independent here, so looks are frames."""
    off, told = [], []
    for _ in range(6):
        points = markers(hung) + 0.002 * rng.normal(size=(FRAMES, sum(COUNTS), 3))
        fit = fit_linkage(hung, points, hung.centres, np.array([0.0, 1.0, 1.0]), float(FRAMES))
        off.append(fit.linkage.centres[1] - hung.centres[1])
        told.append(np.trace(np.linalg.inv(fit.information[1])))
    ratio = np.sqrt(np.mean(np.sum(np.square(off), axis=1)) / np.mean(told))
    assert 0.4 < ratio < 2.0


def test_an_expectation_does_not_turn_a_body_in_its_own_frame(rng, hung):
    """No marker tells such a turn: a centre off its expectation once drew it on for ever."""
    points = markers(hung) + 0.001 * rng.normal(size=(FRAMES, sum(COUNTS), 3))
    expected = hung.centres + np.array([0.0, 0.0, 0.04])
    prior = np.array([0.0, 1e4, 1e4])
    few, many = (
        fit_linkage(hung, points, expected, prior, 20.0, rounds=rounds).linkage
        for rounds in (10, 200)
    )
    for one, other in zip((*few.shapes, few.centres), (*many.shapes, many.centres), strict=True):
        assert_allclose(one, other, atol=1e-5)


def test_steps_that_turn_a_body_in_its_own_frame_fit_alike(rng, hung):
    points = markers(hung)
    steps = idle(hung)
    assert steps.shape == (3 * (COUNTS[1] + COUNTS[2] + 2), 6)
    weights = np.ones(points.shape[:2])
    told = equations(hung, 0.0 * points, weights).told
    assert_allclose(told @ steps, 0.0, atol=1e-4 * np.abs(told).max())  # poses are held a little


def test_poses_alone_come_back(rng, hung):
    start = hung._replace(rotations=shaken(rng, hung, turn=0.1).rotations)
    start.rotations[:, 0] = hung.rotations[:, 0]
    found, settled = pose_linkage(start, markers(hung)[:, COUNTS[0] :])
    assert settled.all()
    off = np.swapaxes(found.rotations, 2, 3) @ hung.rotations
    assert_allclose(rotation_angle(off), 0.0, atol=1e-3)


def test_markers_follow_poses_as_differences_say(rng, hung):
    points, step = markers(hung), 1e-6
    by_pose = by_pose_of(hung, points.shape[1])
    for k in range(3):
        turned = hung.rotations.copy()
        turned[:, 1] = rotation_exp(np.tile(step * np.eye(3)[k], (FRAMES, 1))) @ turned[:, 1]
        slope = (markers(hung._replace(rotations=turned)) - points) / step
        assert_allclose(slope, by_pose[..., 3 + k], atol=1e-6)
