"""A limb's body, measured from its markers and the joint that it hangs from."""

import numpy as np
import pytest
from scipy.ndimage import gaussian_filter1d

from kinesphere.data import JointModel
from kinesphere.geometry.centres import with_expectation
from kinesphere.geometry.pose_errors import point_covariance, pose_covariance
from kinesphere.geometry.rigid import fit_rigid
from kinesphere.geometry.rotations import mean_rotation, rotation_angle, rotation_exp
from kinesphere.skeleton.body import Body, measure_shape
from kinesphere.skeleton.limb_body import measure_limb
from kinesphere.skeleton.limb_joint import FoundJoint
from kinesphere.skeleton.measured import MeasuredJoint
from kinesphere.skeleton.settings import SkeletonSettings
from kinesphere.skeleton.tree import Tree

FRAMES, NOISE = 200, 0.001
JOINT = JointModel("knee", "thigh", "shank")
PLATE = np.array([[0.03, -0.22, 0], [-0.03, -0.22, 0.01], [0, -0.28, 0.03], [0.01, -0.26, -0.03]])
TREE = Tree("thigh", (JOINT,), {"thigh": ("A", "B", "C"), "shank": ("D", "E")}, ())


def measured(rng, beside):
    """Return a shank of two markers, one so far, in m, beside the line of knee and the other."""
    walk = gaussian_filter1d(rng.normal(size=(FRAMES, 3)), 8, axis=0)
    turns = rotation_exp(0.5 * walk / walk.std(axis=0))
    shape = np.array([[beside, -0.1, 0.0], [0.0, -0.2, 0.0]])
    own = shape @ np.swapaxes(turns, 1, 2) + NOISE * rng.normal(size=(FRAMES, 2, 3))
    still = np.broadcast_to(np.eye(3), (FRAMES, 3, 3))
    shaky = NOISE * rng.normal(size=(FRAMES, 3))
    places, noise = 0.1 * np.eye(3), np.full(3, NOISE)
    thigh = Body("thigh", None, ("A", "B", "C"), places, noise, rotations=still, shifts=shaky)
    fit = with_expectation(np.zeros(3), 1e6 * np.eye(3), 0.05, NOISE, 20)
    joint = MeasuredJoint(JOINT, fit, np.zeros(3), 0.05, "")
    found = FoundJoint(joint, own, np.full(2, NOISE), None)
    sample = {"D": own[:, 0], "E": own[:, 1]}
    return measure_limb(found, thigh, TREE, sample, SkeletonSettings(), {})


@pytest.mark.parametrize("beside_mm", np.arange(16.0, 18.0, 0.1).round(1))
def test_a_limb_about_as_near_to_a_line_as_can_be_has_a_pose(beside_mm):
    shank = measured(np.random.default_rng(0), 1e-3 * beside_mm)
    assert np.isfinite(shank.rotations).all()
    assert np.isfinite(shank.shifts).all()


def test_on_the_line_its_twist_is_open_and_beside_it_told(rng):
    assert measured(rng, 0.005).twist_open
    assert not measured(rng, 0.03).twist_open


def plated(rng, noise, strays, thigh_noise):
    """Return a shank that tells its own pose, its markers, its joint in the world, its turns."""
    n = 2000
    walk = gaussian_filter1d(rng.normal(size=(n, 3)), 8, axis=0)
    turns = rotation_exp(0.5 * walk / walk.std(axis=0))
    own = PLATE @ np.swapaxes(turns, 1, 2) + noise * rng.normal(size=(n, 4, 3))
    still, knee = np.broadcast_to(np.eye(3), (n, 3, 3)), strays * rng.normal(size=(n, 3))
    seen = np.full(3, thigh_noise)
    thigh = Body("thigh", None, ("A", "B", "C"), 0.1 * np.eye(3), seen, None, 0.0, still, knee)
    fit = with_expectation(np.zeros(3), 1e6 * np.eye(3), 0.05, noise, 20)
    solid = measure_shape(own, 0.003, 0.008)
    joint = MeasuredJoint(JOINT, fit, np.zeros(3), 0.05, "")
    tree = Tree("thigh", (JOINT,), {"thigh": ("A", "B", "C"), "shank": tuple("DEFG")}, ())
    found = FoundJoint(joint, own, solid[1], solid)
    return measure_limb(found, thigh, tree, {}, SkeletonSettings(), {}), own, knee, turns


@pytest.mark.parametrize("noise", [0.0004, 0.001])
def test_a_joint_that_strays_aids_a_limb_as_far_as_it_is_worth(rng, noise):
    """The pose is as near the truth as true weights put it: 3 mm of a joint, less of markers."""
    strays = 0.003
    shank, own, knee, turns = plated(rng, noise, strays, noise)
    points = np.concatenate([own, knee[:, None]], axis=1)
    weights = 1 / np.array([*np.full(4, noise), strays]) ** 2
    best = fit_rigid(np.vstack([PLATE, np.zeros(3)]), points, weights)
    assert off(shank.rotations, turns) < 1.02 * off(best.rotations, turns)


def test_no_joint_is_surer_than_the_pose_of_the_limb_it_hangs_from(rng):
    """Markers 0.1 m out along each axis, 5 mm of noise: what a joint amid them strays at least."""
    shank, *_ = plated(rng, 0.001, 0.0, 0.005)
    thigh = pose_covariance(0.1 * np.eye(3), np.full(3, np.hypot(0.005, 0.001)))
    at_zero = point_covariance(thigh, np.zeros(3))
    assert shank.centre_noise == pytest.approx(np.sqrt(np.trace(at_zero) / 3))


def off(found, turns):
    """Return how far rotations are off, rad rms, but for what is constant."""
    apart = np.swapaxes(turns, 1, 2) @ found
    return np.sqrt(np.mean(rotation_angle(mean_rotation(apart).T @ apart) ** 2))
