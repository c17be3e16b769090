"""Skinning: laws that every blend obeys, and a naive twin."""

import numpy as np
import pytest
from numpy.testing import assert_allclose
from scipy.spatial.transform import Rotation

from kinesphere.geometry.skinning import dual_quaternion_blend, linear_blend

FRAMES, VERTICES, LIMBS, SHARES = 5, 17, 6, 4
EXACT = 1e-12
BLENDS = (linear_blend, dual_quaternion_blend)


@pytest.fixture
def scene(rng):
    """Vertices on limbs that move anyhow: vertices, limbs, shares, rotations, shifts."""
    shares = -np.sort(-rng.dirichlet(np.ones(SHARES), VERTICES), axis=1)
    shares[: VERTICES // 2, 2:] = 0.0
    shares /= shares.sum(axis=1, keepdims=True)
    return (
        rng.normal(size=(VERTICES, 3)),
        rng.integers(0, LIMBS, (VERTICES, SHARES)),
        shares,
        Rotation.random(FRAMES * LIMBS, rng=rng).as_matrix().reshape(FRAMES, LIMBS, 3, 3),
        rng.normal(size=(FRAMES, LIMBS, 3)),
    )


def test_linear_blend_is_the_mean_of_where_limbs_take_a_vertex(scene):
    vertices, limbs, shares, rotations, shifts = scene
    moved = linear_blend(*scene)
    for f in range(FRAMES):
        for v in range(VERTICES):
            places = [rotations[f, i] @ vertices[v] + shifts[f, i] for i in limbs[v]]
            assert_allclose(moved[f, v], shares[v] @ np.array(places), atol=EXACT)


def test_dual_quaternions_as_kavan_writes_them(scene):
    """A naive twin with 8-vectors: quaternions wxyz multiplied as Hamilton does."""

    def times(p, q):
        w = p[0] * q[0] - p[1:] @ q[1:]
        return np.array([w, *(p[0] * q[1:] + q[0] * p[1:] + np.cross(p[1:], q[1:]))])

    vertices, limbs, shares, rotations, shifts = scene
    moved = dual_quaternion_blend(*scene)
    for f in range(FRAMES):
        real = np.roll(Rotation.from_matrix(rotations[f]).as_quat(), 1, axis=1)
        pairs = zip(shifts[f], real, strict=True)
        dual = np.array([0.5 * times(np.array([0, *t]), q) for t, q in pairs])
        for v in range(VERTICES):
            sign = np.where(real[limbs[v]] @ real[limbs[v, 0]] < 0, -1.0, 1.0) * shares[v]
            b0, b1 = sign @ real[limbs[v]], sign @ dual[limbs[v]]
            b0, b1 = b0 / np.linalg.norm(b0), b1 / np.linalg.norm(b0)
            shift = 2 * times(b1, b0 * [1, -1, -1, -1])[1:]
            place = Rotation.from_quat(np.roll(b0, -1)).apply(vertices[v]) + shift
            assert_allclose(moved[f, v], place, atol=1e-9)


@pytest.mark.parametrize("blend", BLENDS)
def test_limbs_that_move_as_one_move_vertices_rigidly(scene, rng, blend):
    vertices, limbs, shares, _, _ = scene
    turn, shift = Rotation.random(rng=rng).as_matrix(), rng.normal(size=3)
    rotations = np.tile(turn, (FRAMES, LIMBS, 1, 1))
    moved = blend(vertices, limbs, shares, rotations, np.tile(shift, (FRAMES, LIMBS, 1)))
    assert_allclose(moved[2], vertices @ turn.T + shift, atol=EXACT)


@pytest.mark.parametrize("blend", BLENDS)
def test_the_world_may_be_turned_before_or_after(scene, rng, blend):
    vertices, limbs, shares, rotations, shifts = scene
    turn, shift = Rotation.random(rng=rng).as_matrix(), rng.normal(size=3)
    after = blend(*scene) @ turn.T + shift
    before = blend(vertices, limbs, shares, turn @ rotations, shifts @ turn.T + shift)
    assert_allclose(before, after, atol=1e-10)


@pytest.mark.parametrize("blend", BLENDS)
def test_limbs_may_be_numbered_otherwise(scene, rng, blend):
    vertices, limbs, shares, rotations, shifts = scene
    order = rng.permutation(LIMBS)
    numbered = np.argsort(order)[limbs]
    assert_allclose(
        blend(vertices, numbered, shares, rotations[:, order], shifts[:, order]), blend(*scene)
    )


def test_vertices_on_one_limb_know_no_difference(scene):
    vertices, limbs, _, rotations, shifts = scene
    alone = np.zeros((VERTICES, SHARES))
    alone[:, 0] = 1.0
    given = vertices, limbs, alone, rotations, shifts
    assert_allclose(dual_quaternion_blend(*given), linear_blend(*given), atol=EXACT)


def test_half_a_twist_keeps_its_radius_only_with_dual_quaternions():
    twist = Rotation.from_euler("y", [[0], [120]], degrees=True).as_matrix()[None]
    given = np.array([[0.04, 0.3, 0.0]]), np.array([[0, 1]]), np.array([[0.5, 0.5]])
    shifts = np.zeros((1, 2, 3))
    radius = [np.hypot(*blend(*given, twist, shifts)[0, 0, ::2]) for blend in BLENDS]
    assert_allclose(radius, [0.02, 0.04], atol=EXACT)


@pytest.mark.parametrize("blend", BLENDS)
def test_what_rides_on_an_unseen_limb_is_unseen(scene, blend):
    vertices, limbs, shares, rotations, shifts = scene
    rotations[3, 2] = np.nan
    lost = np.isnan(blend(vertices, limbs, shares, rotations, shifts)).all(axis=2)
    on_it = ((limbs == 2) & (shares > 0)).any(axis=1)
    assert (lost[3] == on_it).all()
    assert not lost[:3].any()
