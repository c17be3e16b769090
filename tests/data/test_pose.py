"""Skeleton, Motion and Parameters of one small body, and the way from parameters to poses."""

import dataclasses

import numpy as np
import pytest
from numpy.testing import assert_allclose
from scipy.spatial.transform import Rotation

from kinesphere.data import (
    Joint,
    JointFlag,
    Limb,
    Motion,
    Parameters,
    PoseFlag,
    Skeleton,
    motion_from_parameters,
)
from kinesphere.errors import BadModel

FRAMES = 11
EXACT = 1e-12  # m and rotation entries; only rounding is left


def limb(rng, name, parent, n_markers):
    return Limb(
        name=name,
        parent=parent,
        markers=tuple(f"{name}{m}" for m in range(n_markers)),
        marker_positions=rng.normal(scale=0.1, size=(n_markers, 3)),
        length=0.4,
        long_axis=np.array([0.0, -1.0, 0.0]),
    )


def joint(rng, name, parent, child, n_axes):
    return Joint(
        name=name,
        parent=parent,
        child=child,
        centre_in_parent=rng.normal(scale=0.2, size=3),
        centre_in_child=rng.normal(scale=0.2, size=3),
        residual=0.0,
        range_of_motion=1.0,
        covariance=np.zeros((3, 3)),
        observability="given",
        axes=Rotation.random(n_axes, rng=rng).apply([1.0, 0.0, 0.0]),
        rest=Rotation.random(rng=rng).as_matrix(),
    )


@pytest.fixture
def parameters(rng):
    """Move a trunk with a two-axis thigh and, on it, a one-axis shank at random."""
    skeleton = Skeleton(
        limbs=(
            limb(rng, "trunk", None, 4),
            limb(rng, "left_thigh", "trunk", 2),
            limb(rng, "left_shank", "left_thigh", 5),
        ),
        joints=(
            joint(rng, "left_hip", "trunk", "left_thigh", 2),
            joint(rng, "left_knee", "left_thigh", "left_shank", 1),
        ),
    )
    angles = rng.uniform(-2, 2, (FRAMES, 2, 3))
    angles[:, 0, 2] = angles[:, 1, 1:] = np.nan
    return Parameters(
        skeleton=skeleton,
        root_positions=rng.normal(size=(FRAMES, 3)),
        root_rotations=Rotation.random(FRAMES, rng=rng).as_matrix(),
        angles=angles,
        twists=rng.uniform(-1, 1, (FRAMES, 2)),
        residuals=np.zeros((FRAMES, 2)),
        flags=np.zeros((FRAMES, 2)),
        moving=np.ones((FRAMES, 2)),
        rate=50.0,
    )


def test_a_pose_is_the_product_the_conventions_state(parameters):
    motion = motion_from_parameters(parameters)
    hip, thigh = parameters.skeleton.joint("left_hip"), parameters.skeleton.limb("left_thigh")
    for frame in range(FRAMES):
        a1, a2, _ = parameters.angles[frame, 0]
        about = hip.rest @ thigh.long_axis * parameters.twists[frame, 0]
        expected = (
            Rotation.from_rotvec(hip.axes[1] * a2)
            * Rotation.from_rotvec(hip.axes[0] * a1)
            * Rotation.from_rotvec(about)
        ).as_matrix() @ hip.rest
        assert_allclose(motion.relative_rotations()[frame, 0], expected, atol=EXACT)
        assert_allclose(motion.rotations[frame, 0], parameters.root_rotations[frame], atol=EXACT)


def test_joints_never_come_apart(parameters):
    motion = motion_from_parameters(parameters)
    for j, held in enumerate(parameters.skeleton.joints):
        parent, child = parameters.skeleton.parents[j + 1], j + 1
        by_parent = motion.rotations[:, parent] @ held.centre_in_parent + motion.origins[:, parent]
        by_child = motion.rotations[:, child] @ held.centre_in_child + motion.origins[:, child]
        assert_allclose(by_parent, by_child, atol=EXACT)
        assert_allclose(motion.joint_centres()[:, j], by_parent, atol=EXACT)


def test_markers_ride_on_their_limb(parameters):
    motion = motion_from_parameters(parameters)
    placed = motion.marker_positions()
    shank = parameters.skeleton.limb("left_shank")
    assert len(placed) == 4 + 2 + 5
    expected = motion.rotations[6, 2] @ shank.marker_positions[3] + motion.origins[6, 2]
    assert_allclose(placed["left_shank3"][6], expected, atol=EXACT)


def test_what_is_unknown_is_unseen_from_there_outward(parameters):
    angles, twists = parameters.angles.copy(), parameters.twists.copy()
    angles[4, 0, 1] = np.nan
    twists[5, 1] = np.nan
    flags = parameters.flags.copy()
    flags[5, 1] = JointFlag.TWIST_UNKNOWN | JointFlag.FILLED
    flags[6, 0] = JointFlag.FILLED | JointFlag.SINGULAR
    flags[7, 0] = JointFlag.SINGULAR
    motion = motion_from_parameters(
        dataclasses.replace(parameters, angles=angles, twists=twists, flags=flags)
    )
    assert motion.flags[4].tolist() == [PoseFlag.MEASURED, PoseFlag.UNSEEN, PoseFlag.UNSEEN]
    assert motion.flags[5].tolist() == [
        PoseFlag.MEASURED,
        PoseFlag.MEASURED,
        PoseFlag.TWIST_UNKNOWN,
    ]
    assert motion.flags[6].tolist() == [PoseFlag.MEASURED, PoseFlag.FILLED, PoseFlag.MEASURED]
    assert motion.flags[7].tolist() == [PoseFlag.MEASURED] * 3
    whole = motion_from_parameters(parameters)
    others = np.arange(FRAMES) != 4
    others[5] = False
    assert_allclose(motion.rotations[others], whole.rotations[others], rtol=0, atol=0)


def test_a_child_stands_in_where_the_parent_is_unseen(parameters):
    whole = motion_from_parameters(parameters)
    rotations, origins, flags = (a.copy() for a in (whole.rotations, whole.origins, whole.flags))
    rotations[3, 1], origins[3, 1], flags[3, 1] = np.nan, np.nan, PoseFlag.UNSEEN
    holed = dataclasses.replace(whole, rotations=rotations, origins=origins, flags=flags)
    assert_allclose(holed.joint_centres(), whole.joint_centres(), atol=EXACT)
    assert not holed.seen[3, 1]


def test_without_axes_there_is_no_way_back(parameters):
    bare = dataclasses.replace(parameters.skeleton.joints[0], axes=None)
    skeleton = dataclasses.replace(
        parameters.skeleton, joints=(bare, *parameters.skeleton.joints[1:])
    )
    with pytest.raises(BadModel, match="left_hip has no movement axes yet"):
        motion_from_parameters(dataclasses.replace(parameters, skeleton=skeleton))


def test_a_skeleton_is_a_tree_in_order(rng):
    trunk, thigh = limb(rng, "trunk", None, 3), limb(rng, "left_thigh", "trunk", 3)
    hip = joint(rng, "left_hip", "trunk", "left_thigh", 2)
    with pytest.raises(BadModel, match="2 limbs need 1 joints, got 0"):
        Skeleton(limbs=(trunk, thigh), joints=())
    with pytest.raises(BadModel, match="first limb must be the root"):
        Skeleton(limbs=(thigh, trunk), joints=(hip,))
    stray = dataclasses.replace(thigh, parent="pelvis")
    with pytest.raises(BadModel, match="does not join left_thigh to pelvis"):
        Skeleton(limbs=(trunk, stray), joints=(hip,))
    shank, knee = (
        limb(rng, "left_shank", "left_thigh", 2),
        joint(rng, "k", "left_thigh", "left_shank", 1),
    )
    with pytest.raises(BadModel, match="left_shank comes before its parent left_thigh"):
        Skeleton(limbs=(trunk, shank, thigh), joints=(knee, hip))
    with pytest.raises(BadModel, match="limb left_thigh is there twice"):
        Skeleton(limbs=(trunk, thigh, thigh), joints=(hip, dataclasses.replace(hip, name="h")))
    twice = dataclasses.replace(knee, name="left_hip")
    with pytest.raises(BadModel, match="joint left_hip is there twice"):
        Skeleton(limbs=(trunk, thigh, shank), joints=(hip, twice))


def test_motion_checks_its_shapes(parameters):
    whole = motion_from_parameters(parameters)
    with pytest.raises(ValueError, match=r"origins must have shape \(11, 3, 3\), got \(10, 3, 3\)"):
        Motion(
            skeleton=whole.skeleton,
            rotations=whole.rotations,
            origins=whole.origins[1:],
            residuals=whole.residuals,
            flags=whole.flags,
            rate=50.0,
        )
