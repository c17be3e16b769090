"""A limb's body, measured from its markers and the joint that it hangs from."""

import numpy as np
import pytest
from scipy.ndimage import gaussian_filter1d

from kinesphere.data import JointModel
from kinesphere.geometry.centres import with_expectation
from kinesphere.geometry.rotations import rotation_exp
from kinesphere.skeleton.body import Body
from kinesphere.skeleton.limb_body import measure_limb
from kinesphere.skeleton.limb_joint import FoundJoint
from kinesphere.skeleton.measured import MeasuredJoint
from kinesphere.skeleton.settings import SkeletonSettings
from kinesphere.skeleton.tree import Tree

FRAMES, NOISE = 200, 0.001
JOINT = JointModel("knee", "thigh", "shank")
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
