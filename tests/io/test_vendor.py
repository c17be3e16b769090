"""What is a marker and what a vendor's software computed."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from kinesphere.io.vendor import kind_of_type, output_kinds

FRAMES = 13


def cross(rng, lengths):
    """Origin and three axis ends of a turning frame, (FRAMES, 4, 3), each axis of its length."""
    turns = Rotation.random(FRAMES, rng=rng).as_matrix()
    origin = rng.normal(size=(FRAMES, 3))
    arms = turns.transpose(0, 2, 1) * lengths
    return np.concatenate([origin[:, None], origin[:, None] + arms], axis=1)


def kinds(labels, points, typed=None):
    return output_kinds(labels, points, typed or {})


@pytest.mark.parametrize("prefix", ["", "Matt:"])
def test_a_segment_frame_is_square_and_its_axes_of_one_length(rng, prefix):
    bone = rng.uniform(0.3, 0.4, size=(FRAMES, 1, 1))  # measured anew in every frame
    points = cross(rng, bone)
    points[3, 2] = np.nan
    labels = [f"{prefix}PEL{end}" for end in "OALP"]
    assert kinds(labels, points) == ("segment_frame",) * 4


def test_four_markers_of_such_names_stay_markers(rng):
    labels = ["THIO", "THIA", "THIL", "THIP"]
    plate = np.array([[0, 0, 0], [0.1, 0, 0], [0.02, 0.1, 0], [0, 0.03, 0.1]])
    turns = Rotation.random(FRAMES, rng=rng).as_matrix()
    assert kinds(labels, plate @ turns) == (None,) * 4
    assert kinds(labels, cross(rng, np.array([[[0.1], [0.1], [0.11]]]))) == (None,) * 4
    assert kinds(labels, np.zeros((FRAMES, 4, 3))) == (None,) * 4
    skew = np.array([[0, 0, 0], [0.1, 0, 0], [0.03, 0.0954, 0], [0, 0, 0.1]])  # 72.5° apart
    assert kinds(labels, skew @ turns) == (None,) * 4


def test_where_nothing_was_seen_the_names_decide():
    points = np.full((FRAMES, 4, 3), np.nan)
    assert kinds(["PELO", "PELA", "PELL", "PELP"], points) == ("segment_frame",) * 4


def test_three_of_four_are_no_frame(rng):
    points = cross(rng, 0.2)[:, :3]
    assert kinds(["PELO", "PELA", "PELL"], points) == (None,) * 3


@pytest.mark.parametrize(
    ("label", "kind"),
    [
        ("LKneeAngles", "angle"),
        ("LAbsAnkleAngle", "angle"),
        ("Ann:RHipPower", "power"),
        ("RNormalisedGRF", "force"),
        ("LGroundReactionForce", "force"),
        ("LWristMoment", "moment"),
        ("CentreOfMass", "centre_of_mass"),
        ("Ann:CentreOfMassFloor", "centre_of_mass"),
        ("CenterOfMass", "centre_of_mass"),
        ("LKNE", None),
        ("RIGHTANGLE", None),
        ("Force", None),
        ("*115", None),
        ("", None),
    ],
)
def test_names(label, kind):
    assert kinds([label], np.zeros((FRAMES, 1, 3))) == (kind,)


def test_the_groups_of_the_file_come_before_its_names():
    points = np.zeros((FRAMES, 2, 3))
    assert kinds(["A", "LKneeAngles"], points, {"A": "moment", "LKneeAngles": "scalar"}) == (
        "moment",
        "scalar",
    )


@pytest.mark.parametrize(
    ("name", "kind"), [("ANGLE", "angle"), ("Powers", "power"), ("MODELED_MARKER", "other")]
)
def test_names_of_types(name, kind):
    assert kind_of_type(name) == kind
