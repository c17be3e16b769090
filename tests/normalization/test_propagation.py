"""New frames in every frame, against a twin that is slow and plain."""

import numpy as np
from numpy.testing import assert_allclose
from scipy.spatial.transform import Rotation

from kinesphere.normalization.kernels import move_frames
from kinesphere.normalization.propagation import propagate

EXACT = 1e-12


def naive(rotations, origins, turns, shifts):
    turned, moved = np.empty_like(rotations), np.empty_like(origins)
    for f in range(len(rotations)):
        for i in range(rotations.shape[1]):
            turned[f, i] = rotations[f, i] @ turns[i]
            moved[f, i] = origins[f, i] + rotations[f, i] @ shifts[i]
    return turned, moved


def test_the_kernel_is_its_naive_twin(rng):
    n_frames, n_limbs = 11, 4
    rotations = Rotation.random(n_frames * n_limbs, rng=rng).as_matrix()
    rotations = rotations.reshape(n_frames, n_limbs, 3, 3)
    origins = rng.normal(size=(n_frames, n_limbs, 3))
    rotations[2, 1], origins[2, 1] = np.nan, np.nan
    turns = Rotation.random(n_limbs, rng=rng).as_matrix()
    shifts = rng.normal(size=(n_limbs, 3))
    for found, wanted in zip(
        move_frames(rotations, origins, turns, shifts),
        naive(rotations, origins, turns, shifts),
        strict=True,
    ):
        assert_allclose(found, wanted, atol=EXACT)


def test_axes_and_rest_move_with_their_limbs(doll, rng):
    """A skeleton that is parameterized already keeps its meaning."""
    from dataclasses import replace

    motion = doll().motion
    joints = tuple(
        replace(j, axes=Rotation.random(rng=rng).as_matrix()[:2], rest=np.eye(3))
        for j in motion.skeleton.joints
    )
    motion = replace(motion, skeleton=replace(motion.skeleton, joints=joints))
    n = len(motion.skeleton.limbs)
    turns = Rotation.random(n, rng=rng).as_matrix()
    result = propagate(
        motion, turns, rng.normal(size=(n, 3)), np.tile([0, 1.0, 0], (n, 1)), np.ones(n)
    )
    for j, (old, new) in enumerate(zip(joints, result.skeleton.joints, strict=True)):
        parent = motion.skeleton.parents[j + 1]
        a, b = motion.rotations[0, parent], result.rotations[0, parent]
        assert_allclose(new.axes @ b.T, old.axes @ a.T, atol=EXACT)
        child = motion.rotations[0, j + 1], result.rotations[0, j + 1]
        assert_allclose(b @ new.rest @ child[1].T, a @ old.rest @ child[0].T, atol=EXACT)


def test_a_length_is_kept_or_filled_in(doll):
    from dataclasses import replace

    motion = doll().motion
    limbs = list(motion.skeleton.limbs)
    limbs[3] = replace(limbs[3], length=np.nan)
    motion = replace(motion, skeleton=replace(motion.skeleton, limbs=tuple(limbs)))
    n = len(limbs)
    result = propagate(
        motion, np.tile(np.eye(3), (n, 1, 1)), np.zeros((n, 3)), np.zeros((n, 3)), np.full(n, 7.0)
    )
    assert result.skeleton.limbs[3].length == 7.0
    assert result.skeleton.limbs[4].length == limbs[4].length
