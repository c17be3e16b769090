"""Hips as a published regression has them, in the plane of the pelvis and nowhere else."""

from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose
from scipy.spatial.transform import Rotation

from kinesphere.data import JointModel, Landmark
from kinesphere.labelling import built_in_model
from kinesphere.skeleton.anatomy import in_plane, plane_axes
from kinesphere.skeleton.body import Body
from kinesphere.skeleton.landmarks import expected_centre

FRAMES = 4
SIGNS = {"left_hip": 1.0, "right_hip": -1.0}
HIPS = {joint.name: joint for joint in built_in_model("plugin-gait").joints if "hip" in joint.name}


def spines(width, depth):
    """Return a pelvis in its own axes, forward, up and right, label → (3,) m."""
    return {
        "LASI": np.array([0, 0, -width / 2]),
        "RASI": np.array([0, 0, width / 2]),
        "LPSI": np.array([-depth, 0, -0.2 * width]),
        "RPSI": np.array([-depth, 0, 0.2 * width]),
        "SACR": np.array([-depth, 0, 0]),
    }


def published(width, depth, sign):
    """Return x = −0.24 PD − 9.9, y = −0.30 PW − 10.9, z = 0.33 PW + 7.3 mm, right hip."""
    right = 0.33 * width + 0.0073
    return np.array([-0.24 * depth - 0.0099, -0.30 * width - 0.0109, -sign * right])


def body(turn=None, up=None):
    """Return a pelvis whose frame is turned against the world."""
    pelvis = Body("pelvis", None, (), np.empty((0, 3)), np.empty(0))
    turn = np.eye(3) if turn is None else turn
    pelvis.rotations, pelvis.shifts = np.tile(turn, (FRAMES, 1, 1)), np.full((FRAMES, 3), 0.3)
    pelvis.up = up
    return pelvis


def seen(points, pelvis):
    return {
        label: np.einsum("nij,j->ni", pelvis.rotations, at) + pelvis.shifts
        for label, at in points.items()
    }


@pytest.mark.parametrize(("width", "depth"), [(0.238, 0.155), (0.150, 0.100), (0.290, 0.180)])
@pytest.mark.parametrize("name", SIGNS)
@pytest.mark.parametrize("which", [0, 1])
def test_hips_are_where_harrington_puts_them_children_too(name, which, width, depth):
    pelvis = body(Rotation.from_rotvec([0.3, -1.0, 2.0]).as_matrix())
    sample = seen(spines(width, depth), pelvis)
    landmark = HIPS[name].landmarks[which]
    found = in_plane(landmark, pelvis, sample, SIGNS[name])
    assert_allclose(found, published(width, depth, SIGNS[name]), atol=1e-12)
    # and without a name of a side, for the hip is beside the middle
    assert_allclose(in_plane(landmark, pelvis, sample, 0.0), found, atol=1e-12)


@pytest.mark.parametrize("up", [None, np.array([0.0, 1, 0]), np.array([0.6, 0.8, 0])])
def test_how_somebody_stands_does_not_move_them(up):
    pelvis = body(up=up)
    at = expected_centre(HIPS["left_hip"], pelvis, seen(spines(0.24, 0.15), pelvis), ())
    assert_allclose(at.centre, published(0.24, 0.15, 1.0), atol=1e-12)
    assert at.anatomy
    assert at.spread == HIPS["left_hip"].landmarks[0].spread
    assert "Harrington" in at.source


def test_left_and_right_mirror_each_other():
    rng = np.random.default_rng(5)
    pelvis = spines(0.24, 0.15)
    points = {label: at + rng.normal(scale=0.01, size=3) for label, at in pelvis.items()}
    other = {"L": "R", "R": "L"}
    mirrored = {
        other.get(label[0], "") + label[1:] if label != "SACR" else label: at * (1, 1, -1)
        for label, at in points.items()
    }
    pelvis = body()
    left = in_plane(HIPS["left_hip"].landmarks[0], pelvis, seen(points, pelvis), 1.0)
    right = in_plane(HIPS["right_hip"].landmarks[0], pelvis, seen(mirrored, pelvis), -1.0)
    assert_allclose(right, left * (1, 1, -1), atol=1e-12)


def test_frames_that_hide_a_marker_do_not_matter_but_one_that_never_shows_does():
    pelvis = body()
    sample = seen(spines(0.24, 0.15), pelvis)
    for i, label in enumerate(("LASI", "RASI", "LPSI", "RPSI")):
        sample[label][i] = np.nan  # no frame shows all four
    landmark = HIPS["left_hip"].landmarks[0]
    assert_allclose(in_plane(landmark, pelvis, sample, 1.0), published(0.24, 0.15, 1.0), atol=1e-12)
    sample["RPSI"][:] = np.nan
    assert in_plane(landmark, pelvis, sample, 1.0) is None


def test_a_missing_label_or_a_flat_pelvis_leaves_it_to_the_next_landmark():
    pelvis = body(up=np.array([0.0, 1, 0]))
    pelvis.right = np.array([0.0, 0, 1])
    flat = spines(0.24, 0.0)
    assert plane_axes(("LASI", "RASI", "SACR"), flat) is None
    at = expected_centre(HIPS["left_hip"], pelvis, seen(flat, pelvis), ())
    assert "Bell" in at.source
    assert not at.anatomy
    few = {label: flat[label] for label in ("LASI", "RASI")}
    assert expected_centre(HIPS["left_hip"], pelvis, seen(few, pelvis), ()).source == at.source
    sacral = {k: v for k, v in spines(0.24, 0.15).items() if "PSI" not in k}
    assert "SACR" in expected_centre(HIPS["left_hip"], pelvis, seen(sacral, pelvis), ()).source


def test_a_landmark_without_a_plane_is_no_anatomy():
    pelvis = body()
    joint = JointModel("left_hip", "pelvis", "left_thigh", landmarks=(Landmark({"SACR": 1.0}),))
    assert not expected_centre(joint, pelvis, seen(spines(0.24, 0.15), pelvis), ()).anatomy


def test_shares_need_no_offset():
    landmark = replace(HIPS["left_hip"].landmarks[0], offset=(0.0, 0.0, 0.0))
    small, large = (
        in_plane(landmark, body(), seen(spines(size, 0.6 * size), body()), 1.0) for size in (0.1, 1)
    )
    assert_allclose(10 * small, large, atol=1e-12)
