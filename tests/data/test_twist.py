"""Joints that spread twist: what they turn by, what they carry, and that nothing leaps."""

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal
from scipy.spatial.transform import Rotation

from kinesphere.data import TwistJoints, bundled_body
from kinesphere.geometry.skinning import linear_blend

EXACT = 1e-12
HANGING = "left_forearm"


@pytest.fixture
def joints():
    return TwistJoints(bundled_body())


def posed(surface, limb, turns):
    """Return rotations (n, n_limbs, 3, 3) of a body of which one limb is turned."""
    rotations = np.tile(np.eye(3), (len(turns), len(surface.limbs), 1, 1))
    rotations[:, surface.limbs.index(limb)] = turns
    return rotations


def about(axis, degrees):
    axis = np.asarray(axis) / np.linalg.norm(axis)
    return Rotation.from_rotvec(np.radians(np.atleast_1d(degrees))[:, None] * axis).as_matrix()


def of_limb(joints, limb):
    return np.flatnonzero(joints.limbs == joints.surface.limbs.index(limb))


def axis_of(joints, limb):
    return joints.axes[of_limb(joints, limb)[0]]


def middle_of(joints, limb):
    """Return where a limb points in the middle of its range."""
    return joints._middle(joints.surface.limbs.index(limb))


@pytest.mark.parametrize("degrees", [-100.0, 30.0, 90.0])
def test_a_twisted_limb_is_untwisted_towards_its_beginning(joints, degrees):
    axis, own = axis_of(joints, HANGING), of_limb(joints, HANGING)
    turns = joints.turns(posed(joints.surface, HANGING, about(axis, degrees)))[0]
    assert_allclose(joints.shares[own], [0, 0.25, 0.5, 0.75])
    for k, share in zip(own, joints.shares[own], strict=True):
        assert_allclose(turns[k], about(axis, -(1 - share) * degrees)[0], atol=EXACT)
    others = np.setdiff1d(np.arange(len(turns)), own)
    assert_allclose(turns[others], np.tile(np.eye(3), (len(others), 1, 1)), atol=EXACT)


def test_bending_is_no_twist(joints):
    """Along the way from rest to the middle of the range and on."""
    axis, middle = axis_of(joints, "right_thigh"), middle_of(joints, "right_thigh")
    bent = about(np.cross(axis, middle), np.linspace(0, 110, 7))
    turns = joints.turns(posed(joints.surface, "right_thigh", bent))
    assert_allclose(turns, np.broadcast_to(np.eye(3), turns.shape), atol=1e-9)


def test_twist_is_told_wherever_the_limb_points(joints, rng):
    """Bent after it was twisted, within the range: the same twist."""
    axis, middle = axis_of(joints, HANGING), middle_of(joints, HANGING)
    plain = about(np.cross(axis, middle), [20.0, 60.0, 90.0])
    turns = joints.turns(posed(joints.surface, HANGING, plain @ about(axis, 50.0)))
    own = of_limb(joints, HANGING)
    expected = np.broadcast_to(about(axis, -50.0), (3, 3, 3))
    assert_allclose(turns[:, own[0]], expected, atol=1e-9)


def test_the_world_makes_no_difference(joints, rng):
    n = len(joints.surface.limbs)
    rotations = Rotation.random(5 * n, rng=rng).as_matrix().reshape(5, n, 3, 3)
    world = Rotation.random(rng=rng).as_matrix()
    assert_allclose(joints.turns(world @ rotations), joints.turns(rotations), atol=1e-9)


def test_nothing_leaps(joints):
    """Round and round about its axis, over the head and through the opposite of its middle."""
    for limb in ("left_upper_arm", HANGING, "right_thigh"):
        axis, middle = axis_of(joints, limb), middle_of(joints, limb)
        step = 0.5
        angles = np.arange(0, 720, step)
        across = np.cross(axis, middle)
        paths = [
            about(axis, angles),
            about(across, angles),
            about([1, 0, 0], angles) @ about(axis, 70.0),
            about([0, 0, 1], angles) @ about(axis, -110.0),
            about(across, 178.0) @ about(axis, angles),
        ]
        for path in paths:
            turns = joints.turns(posed(joints.surface, limb, path))
            change = np.swapaxes(turns[1:], -1, -2) @ turns[:-1]
            cosine = (np.trace(change, axis1=2, axis2=3) - 1) / 2
            leap = np.degrees(np.arccos(np.clip(cosine, -1, 1)))
            assert leap.max() < 12 * step


def test_weights_are_spread_along_the_limb(joints):
    surface = joints.surface
    carriers, shares = joints.weights
    assert carriers.shape == shares.shape == (surface.n_vertices, 4)
    assert_allclose(shares.sum(axis=1), 1)
    assert (shares >= 0).all()
    n = len(surface.limbs)
    limb = surface.limbs.index("right_forearm")
    own = of_limb(joints, "right_forearm") + n
    way = surface.ends[limb] - surface.joint_centres[limb]
    place = (surface.vertices - surface.joint_centres[limb]) @ way / (way @ way)
    alone = surface.weights[:, limb] == 1.0
    assert alone.sum() > 50
    heaviest = carriers[alone, 0]
    assert np.isin(heaviest, [limb, *own]).all()
    order = [*own, limb]
    step = np.array([order.index(k) for k in heaviest])
    assert_array_equal(step, np.rint(4 * np.clip(place[alone], 0, 1)))
    still = surface.weights[:, surface.limbs.index("head")] == 1.0
    assert_array_equal(carriers[still, 0], np.full(still.sum(), surface.limbs.index("head")))


def test_untwisted_the_surface_blends_as_without(joints, rng):
    """Knees bend and heads turn as linear blending has them; the weights of a limb stay its own."""
    surface = joints.surface
    n = len(surface.limbs)
    rotations, shifts = np.tile(np.eye(3), (1, n, 1, 1)), np.zeros((1, n, 3))
    for name in ("head", "left_shank", "right_hand"):
        limb = surface.limbs.index(name)
        rotations[0, limb] = Rotation.random(rng=rng).as_matrix()
        shifts[0, limb] = rng.normal(size=3)
    plain = linear_blend(
        surface.vertices, surface.weight_limbs, surface.weight_shares, rotations, shifts
    )
    spread = linear_blend(surface.vertices, *joints.weights, *joints.maps(rotations, shifts))
    three = (surface.weights > 0).sum(axis=1) <= 2  # a fourth carrier may be left out of others
    assert_allclose(spread[0, three], plain[0, three], atol=1e-9)
