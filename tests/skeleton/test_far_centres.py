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


def warned(centre, source, unsure_mm=100.0, noise_mm=1.0, expected=MIDDLE):
    """Return the warnings for a knee at a place, in a leg that hangs from the origin."""
    names, none = ("left_thigh", "left_shank"), np.zeros(3)
    eye = np.eye(3)
    known = (unsure_mm * 1e-3) ** 2 * eye
    fit = CentreFit(np.asarray(centre), noise_mm * 1e-3, known, eye, known, 9)
    joint = JointModel("left_knee", *names)
    measured = MeasuredJoint(joint, fit, expected, SPREAD, source)
    thigh = Body(names[0], "pelvis", ("A", "B"), THIGH, np.zeros(2), none)
    shank = Body(names[1], names[0], ("C", "D"), SHANK, np.zeros(2), np.asarray(centre))
    return far_centres({names[1]: measured}, {names[0]: thigh, names[1]: shank}).warnings


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


MIRRORED = 2 * SHANK.mean(axis=0) - [0.0, -0.42, 0.0]
"""Through the shank: near its markers, and yet no knee."""


def test_a_centre_beyond_the_far_limb_may_be_wrong():
    told = warned(MIRRORED, BETWEEN)
    assert len(told) == 1
    assert "left_knee" in told[0]
    assert "may be wrong" in told[0]
    assert "no joint can be" not in told[0]


@pytest.mark.parametrize("centre", [MIRRORED, [0.6, -0.5, 0.0]])
def test_what_the_motion_tells_well_is_believed_where_no_landmark_speaks_against_it(centre):
    assert warned(centre, BETWEEN, unsure_mm=5.0) == ()
    assert warned(centre, BETWEEN, unsure_mm=15.0) != ()
    assert warned(centre, BETWEEN, unsure_mm=5.0, noise_mm=50.0) != ()
    assert (warned(centre, "a landmark", unsure_mm=5.0) == ()) == (centre is MIRRORED)


def test_midway_between_limbs_whose_markers_are_far_is_no_place_to_doubt():
    out = [0.6, -0.5, 0.0]
    assert warned(out, BETWEEN, expected=np.add(out, [0.0, 0.9 * SPREAD, 0.0])) == ()
    assert warned(out, BETWEEN, expected=np.add(out, [0.0, 1.1 * SPREAD, 0.0])) != ()


def test_a_centre_that_is_not_known_is_not_far():
    assert warned([np.nan] * 3, "a landmark") == ()
