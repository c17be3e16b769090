"""Bodies that are one are joined again; what stands still or moves by itself is not."""

import numpy as np
import pytest

from kinesphere.skeleton.discovery.joint_costs import JointCosts
from kinesphere.skeleton.discovery.pieces import rejoined
from kinesphere.skeleton.discovery.rigidity import measure_rigidity

NOISE, RATIO = 0.001, 2.0  # m


def told(points, bodies):
    rigidity = measure_rigidity(points)
    found = rejoined(bodies, rigidity.wander, rigidity.noise, JointCosts(points), RATIO)
    return [body.tolist() for body in found]


@pytest.fixture
def two_bodies(rng, moving_bodies):
    """Return points of bodies of six and of four markers that move by themselves."""
    points, _ = moving_bodies(rng, (6, 4), apart=0.2)
    return points


def test_pieces_of_one_body_are_joined(rng, two_bodies):
    points = two_bodies + rng.normal(scale=NOISE, size=two_bodies.shape)
    pieces = [np.array([0, 3]), np.arange(6, 10), np.array([1, 2]), np.array([4, 5])]
    assert told(points, pieces) == [[0, 1, 2, 3, 4, 5], [6, 7, 8, 9]]


@pytest.mark.parametrize(("wobble", "joined"), [(1.0, True), (6.0, False)])
def test_a_wobble_up_to_the_usual_is_no_joint(rng, two_bodies, wobble, joined):
    """The second half of a body comes and goes, by so many times what distances wander."""
    points = two_bodies + rng.normal(scale=NOISE, size=two_bodies.shape)
    points[:, 3:6] += wobble * NOISE * rng.normal(size=(len(points), 1, 3))
    pieces = [np.arange(3), np.arange(3, 6), np.arange(6, 10)]
    assert len(told(points, pieces)) == (2 if joined else 3)


def test_two_that_stand_still_are_not_one(rng, two_bodies):
    points = two_bodies.copy()
    points[:, :6] = points[0, :6]
    points += rng.normal(scale=NOISE, size=points.shape)
    pieces = [np.arange(3), np.arange(3, 6), np.arange(6, 10)]
    assert told(points, pieces) == [piece.tolist() for piece in pieces]
