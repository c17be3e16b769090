"""A centre where no joint can be is told."""

import numpy as np
import pytest

from kinesphere.data import JointModel
from kinesphere.geometry.centres import CentreFit
from kinesphere.skeleton.body import Body
from kinesphere.skeleton.far_centres import far_centres
from kinesphere.skeleton.landmarks import BETWEEN
from kinesphere.skeleton.measured import MeasuredJoint

THIGH = np.array([[0.02, -0.2, 0.09], [0.0, -0.42, 0.055]])
SHANK = np.array([[0.04, -0.55, 0.0], [0.0, -0.80, 0.05]])
MIDDLE = (THIGH.mean(axis=0) + SHANK.mean(axis=0)) / 2
SPREAD = 0.25 * float(np.linalg.norm(SHANK.mean(axis=0) - THIGH.mean(axis=0)))


def warned(centre, source):
    """Return the warnings for a knee at a place, in a leg that hangs from the origin."""
    names, none = ("left_thigh", "left_shank"), np.zeros(3)
    eye = np.eye(3)
    fit = CentreFit(np.asarray(centre), 1e-3, eye, eye, eye, 9)
    joint = JointModel("left_knee", *names)
    measured = MeasuredJoint(joint, fit, MIDDLE, SPREAD, source)
    thigh = Body(names[0], "pelvis", ("A", "B"), THIGH, np.zeros(2), none)
    shank = Body(names[1], names[0], ("C", "D"), SHANK, np.zeros(2), np.asarray(centre))
    return far_centres({names[1]: measured}, {names[0]: thigh, names[1]: shank})


@pytest.mark.parametrize("source", [BETWEEN, "a landmark"])
def test_a_knee_is_near_both_limbs(source):
    assert warned([0.0, -0.45, 0.0], source) == ()


@pytest.mark.parametrize("source", [BETWEEN, "a landmark"])
@pytest.mark.parametrize("centre", [[0.6, -0.5, 0.0], [0.0, -1.5, 0.0], [0.0, -0.4, -0.7]])
def test_a_centre_away_from_both_limbs_is_told(source, centre):
    told = warned(centre, source)
    assert len(told) == 1
    assert "no joint can be" in told[0]
    assert "left_knee" in told[0]


def test_a_centre_beyond_the_far_limb_is_told():
    """Mirrored through the shank: near its markers, and yet no knee."""
    mirrored = 2 * SHANK.mean(axis=0) - [0.0, -0.42, 0.0]
    assert "left_knee" in warned(mirrored, BETWEEN)[0]


def test_a_centre_that_is_not_known_is_not_far():
    assert warned([np.nan] * 3, "a landmark") == ()
