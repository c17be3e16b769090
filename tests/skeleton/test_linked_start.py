"""Where to begin with a limb on a line: the joint beyond it tells how it turns."""

import numpy as np
import pytest
from numpy.testing import assert_allclose
from scipy.ndimage import gaussian_filter1d

from kinesphere.geometry.linkage import Linkage
from kinesphere.geometry.rotations import rotation_about, rotation_exp
from kinesphere.skeleton.linked_start import turned_from_beyond

FRAMES = 300
MIDDLE = np.array([[0.0, -0.04, 0.0], [0.0, -0.22, 0.0]])
WRISTS = np.array([[0.03, -0.26, -0.01], [-0.02, -0.2, 0.04]])
HANDS = (
    np.array([[0.03, -0.08, 0.0], [-0.03, -0.09, 0.01], [0.0, -0.12, 0.03]]),
    np.array([[0.05, 0.0, 0.0], [0.02, 0.06, 0.01], [-0.03, 0.0, 0.05], [0.0, 0.1, 0.0]]),
)
UPPER = np.array([[0.03, 0.05, 0.0], [-0.04, 0.0, 0.02], [0.0, 0.1, -0.03]])


def turns(rng, scale):
    walk = gaussian_filter1d(rng.normal(size=(FRAMES, 3)), 12, axis=0)
    return rotation_exp(scale * walk / walk.std(axis=0))


def limbs(rng, hands):
    """Return limbs that hang together, the truth, and their markers."""
    upper = turns(rng, 0.3)
    middle = upper @ turns(rng, 0.6)
    beyond = [middle @ turns(rng, 0.6) for _ in range(hands)]
    truth = Linkage(
        (-1, 0, *[1] * hands),
        (UPPER, MIDDLE, *HANDS[:hands]),
        np.vstack([np.zeros(3), [0.02, -0.1, 0.0], WRISTS[:hands]]),
        np.stack([upper, middle, *beyond], axis=1),
        0.1 * rng.normal(size=(FRAMES, 3)),
    )
    placed = [
        truth.origins[:, i, None] + shape @ np.swapaxes(truth.rotations[:, i], 1, 2)
        for i, shape in enumerate(truth.shapes)
    ]
    return truth, np.concatenate(placed, axis=1)


def mistaken(rng, truth):
    """Return them with the middle turned anyhow about its line, joints beyond elsewhere."""
    about = rotation_about(np.array([0.0, 1.0, 0.0]), rng.uniform(-1.5, 1.5, FRAMES))
    rotations = truth.rotations.copy()
    rotations[:, 1] = rotations[:, 1] @ about
    off = 0.08 * rng.normal(size=(len(truth.shapes) - 2, 3))
    shapes = [shape + one for shape, one in zip(truth.shapes[2:], off, strict=True)]
    centres = truth.centres.copy()
    centres[2:] += 0.05
    return truth._replace(shapes=(*truth.shapes[:2], *shapes), centres=centres, rotations=rotations)


@pytest.mark.parametrize("hands", [1, 2])
def test_joints_beyond_tell_the_turn(rng, hands):
    truth, points = limbs(rng, hands)
    found = turned_from_beyond(mistaken(rng, truth), points)
    assert_allclose(found.origins, truth.origins, atol=2e-4)
    for body in range(1, 2 + hands):
        there = found.origins[:, body, None] + found.shapes[body] @ np.swapaxes(
            found.rotations[:, body], 1, 2
        )
        first = sum(map(len, truth.shapes[:body]))
        assert_allclose(there, points[:, first : first + len(truth.shapes[body])], atol=2e-4)


def test_frames_that_hide_the_limb_stay_as_they_were(rng):
    truth, points = limbs(rng, 1)
    points[40:80, len(UPPER)] = np.nan
    begun = mistaken(rng, truth)
    found = turned_from_beyond(begun, points)
    assert_allclose(found.rotations[40:80, 1], begun.rotations[40:80, 1], rtol=0, atol=0)
    assert_allclose(found.origins[80:], truth.origins[80:], atol=2e-4)


def test_nothing_seen_together_tells_nothing(rng):
    truth, points = limbs(rng, 1)
    points[::2, len(UPPER)] = np.nan
    points[1::2, len(UPPER) + 1] = np.nan
    assert turned_from_beyond(mistaken(rng, truth), points) is None
