"""Surfaces: what they refuse, and what the bundled body is."""

from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal
from scipy.spatial import cKDTree

from kinesphere.data import Surface, bundled_body
from kinesphere.errors import BadSurface

MIRROR = np.array([1.0, 1.0, -1.0])
FLOAT32 = 1e-6  # m
ROUNDED = 1.001 / 255  # a tie between left and right in the mid-plane goes to one of them


def volume(vertices, faces):
    a, b, c = (vertices[faces[:, k]] for k in range(3))
    return float((np.cross(a, b) * c).sum() / 6)


@pytest.fixture
def tetrahedron():
    """One corner of a cube on two limbs."""
    return Surface(
        vertices=[[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]],
        faces=[[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]],
        limbs=("trunk", "head"),
        parents=[-1, 0],
        joint_centres=np.zeros((2, 3)),
        ends=np.ones((2, 3)),
        weights=[[1, 0], [0.25, 0.75], [0, 1], [0.5, 0.5]],
    )


def test_normals_point_outwards(tetrahedron):
    assert_allclose(tetrahedron.normals()[0], -np.ones(3) / np.sqrt(3))
    shifted = np.stack([tetrahedron.vertices, tetrahedron.vertices + 5.0])
    assert_allclose(tetrahedron.normals(shifted)[1], tetrahedron.normals())


def test_weights_are_gathered_heaviest_first(tetrahedron):
    assert_array_equal(tetrahedron.weight_limbs[1], [1, 0, 0, 0])
    assert_array_equal(tetrahedron.weight_shares[1], [0.75, 0.25, 0, 0])
    assert_array_equal(tetrahedron.weight_limbs[2], [1, 0, 0, 0])


@pytest.mark.parametrize(
    ("wrong", "message"),
    [
        ({"vertices": np.full((4, 3), np.nan)}, "vertices holds NaN"),
        ({"faces": [[0, 1, 4]]}, "names vertex 4; there are 4, from 0"),
        ({"faces": [[0, 1]]}, r"faces have shape \(1, 2\)"),
        ({"weights": np.full((4, 2), 0.4)}, "vertex 0 has 0.8"),
        ({"weights": np.tile([1.5, -0.5], (4, 1))}, "must not be negative"),
        ({"parents": [-1, 1]}, "come after its parent"),
        ({"parents": [-1, -1]}, "come after its parent"),
        ({"limbs": ("trunk", "trunk")}, "a name of its own"),
    ],
)
def test_contradictions_are_refused(tetrahedron, wrong, message):
    with pytest.raises(BadSurface, match=message):
        replace(tetrahedron, **wrong)


def test_five_limbs_at_a_vertex_are_too_many():
    with pytest.raises(BadSurface, match="rides on 5 limbs; 4"):
        Surface(
            vertices=np.zeros((1, 3)),
            faces=np.zeros((0, 3)),
            limbs=tuple("abcde"),
            parents=[-1, 0, 1, 2, 3],
            joint_centres=np.zeros((5, 3)),
            ends=np.zeros((5, 3)),
            weights=np.full((1, 5), 0.2),
        )


def test_the_bundled_body_is_closed_and_outside_out():
    body = bundled_body()
    edges = np.concatenate([body.faces[:, [k, (k + 1) % 3]] for k in range(3)])
    forward = set(map(tuple, edges))
    assert len(forward) == len(edges)  # no edge twice in the same sense
    assert forward == {(b, a) for a, b in forward}  # each once in either
    assert body.n_vertices - len(edges) // 2 + len(body.faces) == 2  # a sphere, bent
    assert 0.04 < volume(body.vertices, body.faces) < 0.09  # m³


def test_the_bundled_body_mirrors_itself():
    body = bundled_body()
    apart, twin = cKDTree(body.vertices).query(body.vertices * MIRROR)
    assert apart.max() < FLOAT32
    swap = [
        body.limbs.index(name.replace("left", "R").replace("right", "left").replace("R", "right"))
        for name in body.limbs
    ]
    assert_allclose(body.weights[twin], body.weights[:, swap], atol=ROUNDED)
    assert_allclose(body.joint_centres[swap], body.joint_centres * MIRROR, atol=FLOAT32)
    assert_allclose(body.ends[swap], body.ends * MIRROR, atol=FLOAT32)
    assert_allclose(body.shape_vertices[:, twin], body.shape_vertices * MIRROR, atol=2e-5)


def test_the_bundled_body_stands_and_looks_along_x():
    body = bundled_body()
    at = dict(zip(body.limbs, body.joint_centres, strict=True))
    end = dict(zip(body.limbs, body.ends, strict=True))
    assert abs(body.vertices[:, 1].min()) < 5e-3
    assert at["right_thigh"][2] > 0 > at["left_thigh"][2]
    assert end["left_foot"][0] > at["left_foot"][0] + 0.1
    assert at["head"][1] > at["trunk"][1] > at["left_shank"][1]


def test_shapes_are_steps_from_the_mean():
    body = bundled_body()
    assert_array_equal(body.shaped({}).vertices, body.vertices)
    tall, taller = body.shaped({"height": 0.2}), body.shaped({"height": 0.4})
    assert_allclose(taller.vertices - tall.vertices, tall.vertices - body.vertices, atol=1e-12)
    assert np.ptp(tall.vertices[:, 1]) > np.ptp(body.vertices[:, 1]) + 0.05
    assert abs(tall.vertices[:, 1].min()) < 0.01  # still on the ground
    grown = tall.ends - tall.joint_centres
    assert np.linalg.norm(grown, axis=1).mean() > 0.25
    heavy = body.shaped({"weight": 1.0})
    assert volume(heavy.vertices, body.faces) > 1.2 * volume(body.vertices, body.faces)
    with pytest.raises(BadSurface, match="no shape is called girth; there are height, weight"):
        body.shaped({"girth": 1.0})
