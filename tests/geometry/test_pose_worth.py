"""What poses are worth, and who shares what lasts."""

import numpy as np
from numpy.testing import assert_allclose

from kinesphere.geometry.joint_turns import crowds, joint_turns
from kinesphere.geometry.pose_worth import COHERENT, crowding, noise_share, overrated
from kinesphere.geometry.rotations import rotation_exp


def turns(rng, n, widest):
    """Return a joint that rests in half of its frames and turns about all axes in the others."""
    vectors = rng.normal(size=(n, 3)) * widest * np.sqrt(2)
    vectors[: n // 2] *= 0.01
    return rotation_exp(vectors)


def shared_by(rotations):
    return crowding(joint_turns(rotations), crowds(rotations))


def test_a_joint_that_turns_far_has_every_frame_count_as_one(rng):
    assert_allclose(shared_by(turns(rng, 200, np.deg2rad(60))), 1.0, rtol=0.02)


def test_frames_at_rest_share_what_lasts_where_a_joint_turns_little(rng):
    rotations = turns(rng, 200, np.deg2rad(4))
    shared = shared_by(rotations)
    assert_allclose(shared, crowds(rotations), rtol=0.2)
    assert shared[:100].min() > 1.5 * np.median(shared[100:])


def test_sharing_fades_with_the_rotation(rng):
    rests = [shared_by(turns(rng, 200, np.deg2rad(d)))[:100].mean() for d in (4, 8, 16, 32)]
    assert (np.diff(rests) < 0).all()


def test_noise_is_all_that_differs_between_poses_most_alike(rng):
    n = 4000
    near = np.arange(n) ^ 1  # pairs of poses alike
    pairs = np.repeat(rng.normal(size=(n // 2, 3)), 2, axis=0)
    noise = rng.normal(size=(n, 3))
    assert noise_share(pairs, near) == 0.0
    assert_allclose(noise_share(noise, near), 1.0, atol=0.1)
    assert_allclose(noise_share(pairs + noise, near), 0.5, atol=0.05)


def test_noise_averages_out_over_what_is_seen_and_what_lasts_does_not():
    """A centre's variance is `overrated` over the looks."""
    poses, hidden = 50, 3.0
    assert_allclose(overrated(1.0, 600, poses, hidden) * hidden**2 / poses, 1 / 600)
    assert_allclose(overrated(1.0, 300, poses, hidden), 2 * overrated(1.0, 600, poses, hidden))
    variances = [overrated(0.0, 10**7, n, hidden) / n for n in (50, 500, 50_000)]
    assert_allclose(variances, [COHERENT + 1 / n for n in (50, 500, 50_000)])
