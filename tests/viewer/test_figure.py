"""Where the parts of a figure are, and the shapes they are drawn by."""

from itertools import pairwise

import numpy as np
import pytest
import trimesh
from numpy.testing import assert_allclose
from scipy.spatial.transform import Rotation

from kinesphere.viewer.figure import NOWHERE, Figure, markers_placed
from kinesphere.viewer.handles import turn_about, within_plane
from kinesphere.viewer.shapes import arrow, ball, bone, ring

EXACT = 1e-9


def turned(placed, point):
    """Return where a point of a shape is in each of its copies."""
    turns = Rotation.from_quat(np.roll(placed.wxyzs, -1, axis=1))
    return placed.positions + turns.apply(placed.scales * point)


def test_bones_reach_from_joint_to_joint(solution):
    motion, frame = solution.motion, 12
    figure = Figure(motion.skeleton)
    placed = figure.sticks(motion.rotations[frame], motion.origins[frame])
    ends = turned(placed, np.array([1.0, 0, 0]))
    for j, joint in enumerate(motion.skeleton.joints):
        limb = motion.skeleton.limb_names.index(joint.parent)
        centre = motion.joint_centres(np.array([frame]))[0, j]
        off = np.linalg.norm(ends[figure.stick_limbs == limb] - centre, axis=1)
        assert off.min() < EXACT
        assert_allclose(
            figure.joint_centres(motion.rotations[frame], motion.origins[frame])[j],
            centre,
            atol=EXACT,
        )


def test_arrows_lie_along_the_movement_axes(solution):
    motion, frame = solution.motion, 12
    figure = Figure(solution.skeleton)
    placed = figure.axes(motion.rotations[frame], motion.origins[frame], size=1.0)
    ways = turned(placed, np.array([1.0, 0, 0])) - placed.positions
    row = 0
    for joint in solution.skeleton.joints:
        parent = motion.rotations[frame, motion.skeleton.limb_names.index(joint.parent)]
        for axis in joint.axes:
            assert_allclose(ways[row], parent @ axis, atol=EXACT)
            row += 1
    assert row == len(ways)


def test_what_has_no_pose_has_no_size_and_no_nan(gappy):
    motion = gappy.motion
    figure = Figure(gappy.skeleton)
    for placed in (
        figure.sticks(motion.rotations[7], motion.origins[7]),
        figure.frames(motion.rotations[7], motion.origins[7]),
        figure.axes(motion.rotations[7], motion.origins[7]),
        markers_placed(gappy.recording.markers[7], 0.01),
    ):
        for values in (placed.positions, placed.wxyzs, placed.scales):
            assert np.isfinite(values).all()
        assert (placed.scales == NOWHERE).any()
        assert (placed.scales > NOWHERE).any()


@pytest.mark.parametrize(
    ("mesh", "volume"),
    [
        (bone(), 1.0 / 3.0 * 1.0),  # two pyramids on a square of side 1, together 1 high
        (ball(24, 48), 4 / 3 * np.pi),
        (ring(0.1, 96, 24), 2 * np.pi**2 * 0.1**2),
        (arrow(), None),
    ],
)
def test_shapes_are_closed_and_face_outwards(mesh, volume):
    vertices, faces = mesh
    body = trimesh.Trimesh(vertices, faces, process=True)
    assert body.is_winding_consistent
    assert body.is_watertight
    assert body.volume > 0
    if volume is not None:
        assert body.volume == pytest.approx(volume, rel=0.03)


def test_a_ring_turns_as_the_hand_goes_round_it(rng):
    way = np.array([0.0, 0.6, 0.8])
    centre, eye = np.array([0.2, 1.0, -0.1]), np.array([1.5, 1.6, 2.0])
    first = np.cross(way, (1.0, 0, 0))
    first /= np.linalg.norm(first)
    points = [
        centre + 0.2 * Rotation.from_rotvec(a * way).apply(first) for a in (0.0, 0.5, 1.2, 3.0)
    ]
    # what the page tells is somewhere on the line from the eye through the ring
    seen = [eye + t * (p - eye) for p, t in zip(points, (1.0, 0.7, 1.3, 0.9), strict=True)]
    flat = [within_plane(eye, at, centre, way) for at in seen]
    steps = [turn_about(way, a, b) for a, b in pairwise(flat)]
    assert_allclose(steps, [0.5, 0.7, 1.8], atol=EXACT)


def test_a_ring_seen_edge_on_is_still_dragged(rng):
    way, centre = np.array([0.0, 1.0, 0.0]), np.zeros(3)
    eye = np.array([3.0, 0.0, 0.0])
    at = np.array([0.5, 0.02, 0.3])
    assert_allclose(within_plane(eye, at, centre, way), (0.5, 0.0, 0.3), atol=EXACT)
