"""Laws of the parameterization: whatever the numbers, these must hold."""

from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.testing import assert_allclose, assert_array_equal
from scipy.spatial.transform import Rotation

from kinesphere.data import JointFlag, Motion, Parameters, Skeleton, motion_from_parameters
from kinesphere.parameterization import parameterize
from kinesphere.synthetic import make_performance

ROUND_TRIP = 1e-9  # rad, away from singular poses
SAME = 1e-7  # rad; iterations stop at steps of 1e-4 rad, from starts that differ by rounding
MIRROR = np.diag([1.0, 1.0, -1.0])
SEEDS = st.integers(0, 2**32 - 1)


@cache
def performed():
    """Return one performance; 20 Hz and no more than the movements need."""
    return make_performance(np.random.default_rng(11), rate=20.0, calibration_s=36.0, free_s=4.0)


@cache
def solved() -> Parameters:
    return parameterize(performed().motion)


def wrapped(angles):
    return np.angle(np.exp(1j * angles))


def assert_same_angles(found: Parameters, wanted: Parameters, atol=SAME):
    assert_allclose(wrapped(found.angles - wanted.angles), 0 * wanted.angles, atol=atol)
    assert_allclose(wrapped(found.twists - wanted.twists), 0 * wanted.twists, atol=atol)


@settings(deadline=None, max_examples=10)
@given(seed=SEEDS)
def test_parameters_to_poses_and_back(seed):
    rng = np.random.default_rng(seed)
    skeleton = performed().skeleton
    n, n_joints = 40, len(skeleton.joints)
    smooth = np.sin(np.linspace(0, 3, n)[:, None, None] + rng.uniform(0, 6, (1, n_joints, 3)))
    angles = rng.uniform(0.1, 1.2, (1, n_joints, 3)) * smooth
    for j, joint in enumerate(skeleton.joints):
        angles[:, j, joint.n_axes :] = np.nan
    told = Parameters(
        skeleton=skeleton,
        root_positions=rng.normal(size=(n, 3)),
        root_rotations=Rotation.random(n, rng=rng).as_matrix(),
        angles=angles,
        twists=rng.uniform(-0.6, 0.6, (1, n_joints)) * smooth[..., 0],
        residuals=np.zeros((n, n_joints)),
        flags=np.zeros((n, n_joints)),
        moving=np.zeros((n, n_joints)),
        rate=50.0,
    )
    motion = motion_from_parameters(told)
    back = parameterize(motion, reuse=skeleton)
    sound = (back.flags & JointFlag.SINGULAR) == 0
    assert np.nanmax(np.abs(wrapped(back.angles - told.angles)[sound])) < ROUND_TRIP
    assert np.abs(wrapped(back.twists - told.twists)[sound]).max() < ROUND_TRIP
    again = motion_from_parameters(back)
    assert_allclose(again.rotations, motion.rotations, atol=1e-7)
    assert_allclose(again.origins, motion.origins, atol=1e-7)


@settings(deadline=None, max_examples=2)
@given(seed=SEEDS)
def test_where_the_world_is_does_not_matter(seed):
    rng = np.random.default_rng(seed)
    motion = performed().motion
    turn, shift = Rotation.random(rng=rng).as_matrix(), rng.normal(size=3)
    moved = replace(
        motion, rotations=turn @ motion.rotations, origins=motion.origins @ turn.T + shift
    )
    found = parameterize(moved)
    assert_same_angles(found, solved())
    assert_allclose(found.root_rotations, turn @ solved().root_rotations, atol=1e-12)


def test_how_large_the_body_is_does_not_matter():
    factor = 1.7
    motion = performed().motion
    limbs = tuple(
        replace(limb, marker_positions=factor * limb.marker_positions, length=factor * limb.length)
        for limb in motion.skeleton.limbs
    )
    joints = tuple(
        replace(
            joint,
            centre_in_parent=factor * joint.centre_in_parent,
            centre_in_child=factor * joint.centre_in_child,
        )
        for joint in motion.skeleton.joints
    )
    large = replace(
        motion, skeleton=Skeleton(limbs, joints), origins=factor * np.asarray(motion.origins)
    )
    found = parameterize(large)
    assert_same_angles(found, solved(), atol=1e-12)
    assert_allclose(found.residuals, factor * solved().residuals, atol=1e-9)


def test_a_mirrored_person_has_mirrored_axes_and_the_same_angles():
    found = parameterize(mirrored(performed().motion))
    for j, joint in enumerate(solved().skeleton.joints):
        at = found.skeleton.joint_names.index(other_side(joint.name))
        image = found.skeleton.joints[at]
        # a joint in the middle keeps the body's own signs: bending right becomes bending left
        signs = np.sign((-joint.axes @ MIRROR * image.axes).sum(axis=1))
        if joint.name != image.name:
            assert (signs == 1).all()
        assert_allclose(image.axes * signs[:, None], -joint.axes @ MIRROR, atol=SAME)
        assert_allclose(image.rest, MIRROR @ joint.rest @ MIRROR, atol=SAME)
        angles = found.angles[:, at, : joint.n_axes] * signs
        assert_allclose(wrapped(angles - solved().angles[:, j, : joint.n_axes]), 0, atol=SAME)
        assert_allclose(wrapped(found.twists[:, at] + solved().twists[:, j]), 0, atol=SAME)


@pytest.mark.parametrize("left_out", [0, 1, 7])
def test_time_reversed_gives_the_same_axes_rest_and_angles(left_out):
    """Whatever grid samples lie on, it is the same from either end of an odd or even number."""
    motion = performed().motion
    kept = slice(0, motion.n_frames - left_out)
    motion = shown(motion, np.arange(motion.n_frames)[kept])
    found, other = (
        parameterize(motion),
        parameterize(shown(motion, np.arange(motion.n_frames)[::-1])),
    )
    for joint, same in zip(found.skeleton.joints, other.skeleton.joints, strict=True):
        assert_allclose(same.axes, joint.axes, atol=SAME)
        assert_allclose(same.rest, joint.rest, atol=SAME)
        assert_allclose(same.axes_uncertainty, joint.axes_uncertainty, atol=SAME)
        assert same.axes_source == joint.axes_source
    sound = (found.flags & JointFlag.SINGULAR) == 0
    for there, back in ((found.angles, other.angles), (found.twists, other.twists)):
        assert np.nanmax(np.abs(wrapped(back[::-1] - there)[sound])) < 10 * SAME
        assert_array_equal(np.isnan(back[::-1]), np.isnan(there))


def test_standing_still_for_longer_changes_no_axis():
    motion = performed().motion
    longer = np.concatenate([np.zeros(60, dtype=int), np.arange(motion.n_frames)])
    found = parameterize(shown(motion, longer))
    for joint, other in zip(solved().skeleton.joints, found.skeleton.joints, strict=True):
        # the threshold may move by one of 100 bins, and with it the ends of a phase
        assert_allclose(other.axes, joint.axes, atol=5e-3)


def shown(motion: Motion, frames) -> Motion:
    """Return some frames of a motion, in the order given."""
    return replace(
        motion,
        rotations=motion.rotations[frames],
        origins=motion.origins[frames],
        residuals=motion.residuals[frames],
        flags=motion.flags[frames],
    )


def other_side(name: str) -> str:
    for side, other in (("left_", "right_"), ("right_", "left_")):
        if name.startswith(side):
            return other + name.removeprefix(side)
    return name


def mirrored(motion: Motion) -> Motion:
    limbs = tuple(
        replace(
            limb,
            name=other_side(limb.name),
            parent=limb.parent and other_side(limb.parent),
            marker_positions=limb.marker_positions @ MIRROR,
            long_axis=limb.long_axis @ MIRROR,
        )
        for limb in motion.skeleton.limbs
    )
    joints = tuple(
        replace(
            joint,
            name=other_side(joint.name),
            parent=other_side(joint.parent),
            child=other_side(joint.child),
            centre_in_parent=joint.centre_in_parent @ MIRROR,
            centre_in_child=joint.centre_in_child @ MIRROR,
            axes=None,
            rest=None,
            axes_uncertainty=None,
        )
        for joint in motion.skeleton.joints
    )
    return replace(
        motion,
        skeleton=Skeleton(limbs, joints),
        rotations=MIRROR @ motion.rotations @ MIRROR,
        origins=motion.origins @ MIRROR,
    )
