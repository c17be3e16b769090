"""Which way is right, seen from a thigh, wherever its markers and those of the shank sit."""

import numpy as np
import pytest

from kinesphere.data import JointModel, Segment, TopologicalModel
from kinesphere.geometry.rotations import rotation_about
from kinesphere.skeleton import SkeletonSettings
from kinesphere.skeleton.body import Body
from kinesphere.skeleton.body_axes import beside, right_from_bending
from kinesphere.skeleton.limb_axes import find_axes
from kinesphere.skeleton.tree import Tree

FRAMES = 60
SIDES = {"left": -1.0, "right": 1.0}
THIGH = np.array([[0.02, -0.2, 0.09], [0.0, -0.42, 0.055], [0.06, -0.3, 0.02]])
TOED_OUT = np.deg2rad(20)
TILT = np.rad2deg(np.arctan2(THIGH[1, 2], -THIGH[1, 1]))
"""deg, of the line from the hip to the farthest marker: all that may tilt the axis, in part."""
SHANK_ASIDE = 15.0
"""deg, by which the line from the thigh's farthest marker to the middle of SHANK leaves the plane
of flexion."""
SHANK = np.array([[0.04, -0.15, -0.01], [0.05, -0.28, -0.01], [0.0, -0.4, -0.03]])
"""m from hip and knee: lateral on the thigh, in front and medial on the shank; a right leg."""


def leg(side, bend, *, gap=slice(0)):
    """Return a thigh's Body after `find_axes`, and the true axis of its knee in its frame.

    The knee bends by ``bend``, (n,) rad, about an axis that is turned out from the body's right.
    """
    mirror = np.array([1.0, 1.0, SIDES[side]])
    names = f"{side}_thigh", f"{side}_shank"
    turn = rotation_about(np.array([0.0, SIDES[side], 0.0]), -TOED_OUT)
    axis = turn @ [0.0, 0.0, 1.0]
    n = len(bend)
    swing = rotation_about(np.array([1.0, 0.0, 0.0]), np.linspace(-0.3, 0.3, n))
    knee = np.array([0.0, -0.42, 0.0])
    shank = rotation_about(-axis, bend) @ turn
    lower = np.einsum("fij,mj->fmi", shank, SHANK * mirror) + knee
    labels = ("T1", "T2", "T3"), ("S1", "S2", "S3")
    sample = {
        label: np.einsum("fij,fj->fi", swing, np.broadcast_to(point, (n, 3)))
        for label, point in zip(labels[0], (THIGH * mirror) @ turn.T, strict=True)
    }
    for i, label in enumerate(labels[1]):
        sample[label] = np.einsum("fij,fj->fi", swing, lower[:, i])
    sample["S2"][gap] = np.nan
    body = Body(names[0], "pelvis", labels[0], (THIGH * mirror) @ turn.T, np.zeros(3), np.zeros(3))
    body.rotations, body.shifts = swing, np.zeros((n, 3))
    pelvis = Body("pelvis", None, (), np.zeros((0, 3)), np.zeros(0))
    pelvis.rotations, pelvis.right = np.tile(np.eye(3), (n, 1, 1)), np.array([0.0, 0.0, 1.0])
    knee_joint = JointModel(f"{side}_knee", *names)
    tree = Tree("pelvis", (knee_joint,), dict(zip(names, labels, strict=True)), ())
    model = TopologicalModel(
        "leg",
        tuple(Segment(name, x) for name, x in zip(names, labels, strict=True)),
        (knee_joint,),
        names[0],
    )
    find_axes(body, pelvis, tree, model, sample, SkeletonSettings())
    return body, axis


def off(body, axis):
    """Return the angle in deg between a thigh's right and its knee's axis, across the thigh."""
    return np.rad2deg(np.arccos(np.clip(body.right @ beside(axis, body.up), -1, 1)))


@pytest.mark.parametrize("side", SIDES)
@pytest.mark.parametrize("degrees", [30.0, 60.0, 120.0])
def test_right_is_the_axis_of_a_knee_wherever_its_markers_sit(side, degrees):
    body, axis = leg(side, np.deg2rad(degrees) * np.sin(np.linspace(0, np.pi, FRAMES)) ** 2)
    assert off(body, axis) < TILT / 3


@pytest.mark.parametrize("side", SIDES)
def test_a_straight_knee_takes_the_right_of_the_body(side):
    """Markers beside the joint make it look bent by 20° and more: that is no flexion."""
    body, _ = leg(side, np.deg2rad(5) * np.sin(np.linspace(0, np.pi, FRAMES)) ** 2)
    assert off(body, np.array([0.0, 0.0, 1.0])) < 1.0


def test_a_marker_that_comes_and_goes_does_not_turn_the_axis():
    bend = np.deg2rad(70) * np.sin(np.linspace(0, np.pi, FRAMES)) ** 2
    body, axis = leg("right", bend, gap=slice(20, 45))
    assert off(body, axis) < TILT / 3


def test_nothing_is_told_without_frames_or_bends():
    down, flexed = np.array([0.0, -1.0, 0.0]), np.deg2rad(20)
    seen = np.array([[[0.0, -0.4, 0.1]]]).repeat(FRAMES, axis=0)
    assert right_from_bending(down, seen, -1.0, flexed) is None
    assert right_from_bending(down, np.full_like(seen, np.nan), -1.0, flexed) is None
    assert right_from_bending(down, seen[:1], -1.0, flexed) is None


@pytest.mark.parametrize("side", SIDES)
@pytest.mark.parametrize(("least", "most"), [(60, 100), (80, 100), (90, 90), (85, 120), (95, 130)])
def test_a_knee_kept_bent_has_its_axis_the_right_way_round(side, least, most):
    """Beyond 90° further bending brings the shank forwards; at 90° it moves along the thigh."""
    body, axis = leg(side, np.deg2rad(np.linspace(least, most, FRAMES)))
    assert off(body, axis) < TILT + SHANK_ASIDE


@pytest.mark.parametrize(
    ("least", "most"), [(0, 60), (30, 80), (85, 120), (95, 130), (100, 150), (120, 150)]
)
def test_bending_tells_right_from_left_by_how_it_turned(least, most):
    right = right_from_bending(*bending(least, most), -1.0, np.deg2rad(20))
    assert np.rad2deg(np.arccos(right[2])) < 2.0


def test_ways_along_the_limb_tell_no_plane():
    """A shank that goes from 80° to 105° moves along the thigh; across it there is noise alone."""
    down, seen = bending(80, 105, noise=0.01)
    assert right_from_bending(down, seen, -1.0, np.deg2rad(20)) is None


def bending(least, most, noise=1e-3):
    """Return a thigh's direction and a shank's markers, whose knee's axis is z."""
    t = np.deg2rad(np.linspace(least, most, 400))
    shank = rotation_about(np.array([0.0, 0.0, -1.0]), t)
    markers = np.array([[0.02, -0.2, 0.03], [0.0, -0.4, 0.04]])
    seen = np.einsum("fij,mj->fmi", shank, markers)
    seen += np.random.default_rng(0).normal(scale=noise, size=seen.shape)
    return np.array([0.0, -1.0, 0.0]), seen
