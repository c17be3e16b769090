"""Rigs bound in any pose stand like the bundled body afterwards, and are otherwise the same."""

from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose
from scipy.spatial.transform import Rotation

from kinesphere.data import bundled_body
from kinesphere.markerless.rig import standing_as_bundled


def bent(surface, turns):
    """Return a surface bound with some limbs turned about their joints, skin blended."""
    world = np.tile(np.eye(3), (len(surface.limbs), 1, 1))
    centres = surface.joint_centres.copy()
    for limb, (name, parent) in enumerate(zip(surface.limbs, surface.parents, strict=True)):
        if parent >= 0:
            arm = surface.joint_centres[limb] - surface.joint_centres[parent]
            centres[limb] = centres[parent] + world[parent] @ arm
            turn = Rotation.from_rotvec(turns.get(name, (0, 0, 0))).as_matrix()
            world[limb] = turn @ world[parent]
    carried = np.einsum("lij,vlj->vli", world, surface.vertices[:, None] - surface.joint_centres)
    vertices = np.einsum("vl,vli->vi", surface.weights, carried + centres)
    ends = np.einsum("lij,lj->li", world, surface.ends - surface.joint_centres) + centres
    return replace(surface, vertices=vertices, joint_centres=centres, ends=ends, shapes=())


def lengths(surface):
    return np.linalg.norm(surface.ends - surface.joint_centres, axis=1)


def directions(surface):
    return (surface.ends - surface.joint_centres) / lengths(surface)[:, None]


T_POSE = {"left_upper_arm": (-0.7, 0, 0), "right_upper_arm": (0.7, 0, 0)}
HANGING = {
    "left_upper_arm": (0.6, 0, 0),
    "right_upper_arm": (-0.6, 0, 0),
    "left_forearm": (0.2, 0.1, -0.6),
    "right_shank": (0, 0, -0.5),
}


def test_the_bundled_body_stays_as_it_is():
    body = bundled_body()
    found = standing_as_bundled(body)
    assert_allclose(found.vertices, body.vertices, atol=1e-12)
    assert_allclose(found.joint_centres, body.joint_centres, atol=1e-12)


@pytest.mark.parametrize("pose", [T_POSE, HANGING])
def test_arms_and_legs_point_as_the_bundled_body_s_do(pose):
    body = bundled_body()
    rig = bent(body, pose)
    assert np.abs(directions(rig) - directions(body)).max() > 0.3
    found = standing_as_bundled(rig)
    moved = [i for i, n in enumerate(body.limbs) if n not in ("pelvis", "trunk", "head")]
    assert_allclose(directions(found)[moved], directions(body)[moved], atol=1e-9)
    assert_allclose(lengths(found), lengths(body), atol=1e-9)
    # skin that rides on one limb alone keeps its distance from that limb's joint
    for limb in range(len(body.limbs)):
        own = body.weights[:, limb] == 1
        before = np.linalg.norm(body.vertices[own] - body.joint_centres[limb], axis=1)
        after = np.linalg.norm(found.vertices[own] - found.joint_centres[limb], axis=1)
        assert_allclose(after, before, atol=1e-9)


def test_joints_come_back_to_where_they_were():
    body = bundled_body()
    found = standing_as_bundled(bent(body, HANGING))
    assert_allclose(found.joint_centres, body.joint_centres, atol=1e-9)
