"""A marker near a joint goes where noise says, and stays where only skin could say."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from kinesphere.skeleton.discovery.exchange import to_the_steadiest
from kinesphere.skeleton.discovery.rigidity import measure_rigidity

NOISE = 0.0005  # m
JOINT = 5
"""The marker near the hinge; it rides on the second body."""


@pytest.fixture
def hinged(rng):
    """Return points of two bodies about a hinge, 0–4 and 5–8, the fifth 4 mm from the axis, m."""
    n = 1200
    angles = 0.7 * np.sin(np.linspace(0, 30, n))
    turns = Rotation.from_rotvec(angles[:, None] * [0.0, 0.0, 1.0]).as_matrix()
    still = rng.normal(scale=0.04, size=(5, 3)) - np.array([0.0, 0.1, 0.0])
    swung = rng.normal(scale=0.04, size=(4, 3)) + np.array([0.0, 0.1, 0.0])
    swung[0] = [0.004, 0.0, 0.05]
    bodies = np.concatenate(
        [np.tile(still, (n, 1, 1)), np.einsum("fij,mj->fmi", turns, swung)], axis=1
    )
    return bodies + rng.normal(scale=NOISE, size=bodies.shape)


def told(points, bodies):
    return [body.tolist() for body in to_the_steadiest(measure_rigidity(points), bodies)]


def test_a_marker_near_a_joint_goes_to_the_body_it_rides_on(hinged):
    right = [list(range(JOINT)), list(range(JOINT, 9))]
    assert told(hinged, [np.arange(JOINT + 1), np.arange(JOINT + 1, 9)]) == right
    assert told(hinged, [np.arange(JOINT), np.arange(JOINT, 9)]) == right


def test_where_skin_moves_markers_nothing_is_exchanged(hinged, rng):
    """Each marker of the second body wanders as skin does, far beyond the noise of the first."""
    slow = np.cumsum(rng.normal(size=(len(hinged), 4, 3)), axis=0)
    skin = hinged.copy()
    skin[:, JOINT:] += 0.004 * slow / slow.std(axis=0)
    wrong = [np.arange(JOINT + 1), np.arange(JOINT + 1, 9)]
    assert told(skin, wrong) == [body.tolist() for body in wrong]


def test_noise_on_top_of_skin_moves_no_marker(hinged, rng):
    """Two bodies are rigid to the noise, three wobble as skin does: the recording is a person's."""
    n = len(hinged)
    slow = np.cumsum(rng.normal(size=(n, 12, 3)), axis=0)
    shape = rng.normal(scale=0.06, size=(12, 3)) + np.array([0.5, 0.0, 0.0])
    soft = shape + 0.004 * slow / slow.std(axis=0) + rng.normal(scale=NOISE, size=(n, 12, 3))
    points = np.concatenate([hinged, soft], axis=1)
    wobbling = [np.arange(9, 13), np.arange(13, 17), np.arange(17, 21)]
    wrong = [np.arange(JOINT + 1), np.arange(JOINT + 1, 9), *wobbling]
    noise = replace(measure_rigidity(points), noise=measure_rigidity(hinged).noise)
    kept = [body.tolist() for body in to_the_steadiest(noise, wrong)]
    assert kept == [body.tolist() for body in wrong]
    # the same two bodies by themselves: noise alone decides
    assert told(hinged, wrong[:2]) == [list(range(JOINT)), list(range(JOINT, 9))]


def test_a_body_keeps_the_markers_of_its_pose(hinged):
    three = [np.array([0, 1, JOINT]), np.arange(JOINT + 1, 9)]
    assert told(hinged, three) == [body.tolist() for body in three]
