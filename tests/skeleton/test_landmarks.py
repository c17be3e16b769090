"""Where a joint is expected that no landmark is known of, and how firmly."""

import numpy as np
import pytest

from kinesphere.data import JointModel
from kinesphere.skeleton.body import Body
from kinesphere.skeleton.landmarks import BETWEEN, expected_centre

FRAMES = 5


def limb(n, at):
    """Return the places of n markers about a point, (n, 3) m."""
    around = np.array([[0.05, 0, 0], [-0.05, 0, 0], [0, 0, 0.05], [0, 0, -0.05]])[:n]
    return around - around.mean(axis=0) + [0.0, at, 0.0]


@pytest.mark.parametrize(
    ("parents", "children", "n_axes", "share"),
    [(4, 3, None, 0.5), (4, 3, 3, 0.5), (4, 3, 1, 0.25), (2, 3, None, 0.25), (4, 2, None, 0.25)],
)
def test_hinges_and_limbs_of_two_markers_hold_their_joint_twice_as_firmly(
    parents, children, n_axes, share
):
    shape = limb(parents, 0.0)
    labels = tuple(f"p{i}" for i in range(parents))
    body = Body("shank", None, labels, shape, np.full(parents, 1e-3))
    body.rotations, body.shifts = np.tile(np.eye(3), (FRAMES, 1, 1)), np.zeros((FRAMES, 3))
    own = {f"c{i}": np.tile(p, (FRAMES, 1)) for i, p in enumerate(limb(children, -0.4))}
    joint = JointModel("ankle", "shank", "foot", n_axes)
    centre, spread, source, anatomy = expected_centre(joint, body, own, tuple(own))
    np.testing.assert_allclose(centre, [0, -0.2, 0], atol=1e-12)
    assert spread == pytest.approx(share * 0.4)
    assert source == BETWEEN
    assert not anatomy
