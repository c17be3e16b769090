"""Proportions: laws of the factors."""

from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose

from kinesphere.data import bundled_body
from kinesphere.errors import BadSetting
from kinesphere.markerless.shape import FACTORS, found_shape, shaped

S = bundled_body()


def length(surface, limb, to):
    at = surface.limbs.index
    return np.linalg.norm(surface.joint_centres[at(to)] - surface.joint_centres[at(limb)])


def test_no_factor_changes_nothing():
    same = shaped(S, {})
    assert_allclose(same.vertices, S.vertices, atol=1e-12)
    assert_allclose(same.joint_centres, S.joint_centres, atol=1e-12)
    assert_allclose(same.ends, S.ends, atol=1e-12)


def test_size_is_a_similarity_about_the_pelvis():
    big = shaped(S, {"size": 0.1})
    centre = S.joint_centres[0]
    assert_allclose(big.vertices, centre + np.exp(0.1) * (S.vertices - centre), atol=1e-12)


@pytest.mark.parametrize(
    ("factor", "limb", "to"),
    [
        ("upper_arm_length", "left_upper_arm", "left_forearm"),
        ("forearm_length", "right_forearm", "right_hand"),
        ("thigh_length", "left_thigh", "left_shank"),
        ("shank_length", "right_shank", "right_foot"),
    ],
)
def test_a_length_changes_its_bone_and_no_other(factor, limb, to):
    longer = shaped(S, {factor: 0.07})
    assert length(longer, limb, to) == pytest.approx(np.exp(0.07) * length(S, limb, to))
    for other, end in (("left_upper_arm", "left_forearm"), ("left_thigh", "left_shank")):
        if not factor.startswith(other.removeprefix("left_")):
            assert length(longer, other, end) == pytest.approx(length(S, other, end))


def test_directions_of_shape_are_the_surfaces_own(rng):
    logs = {"sex": -0.1, "weight": 0.05, "size": 0.03}
    expected = shaped(S.shaped({"sex": -1.0, "weight": 0.5}), {"size": 0.03})
    found = shaped(S, logs)
    assert_allclose(found.vertices, expected.vertices, atol=1e-12)
    assert_allclose(found.joint_centres, expected.joint_centres, atol=1e-12)
    bare = replace(S, shapes=())
    assert_allclose(shaped(bare, logs).vertices, shaped(S, {"size": 0.03}).vertices, atol=1e-12)
    told = found_shape(np.array([logs.get(name, 0.0) for name in FACTORS]))
    assert told["factors"]["size"] == np.exp(0.03)
    assert told["shape_steps"] == {"sex": -1.0, "proportions": 0.0, "weight": 0.5, "muscle": 0.0}


def test_girth_changes_no_bone():
    thick = shaped(S, {"arm_girth": 0.2, "leg_girth": 0.1})
    assert_allclose(thick.joint_centres, S.joint_centres, atol=1e-12)
    arm = S.weights[:, S.limbs.index("left_upper_arm")] > 0.99
    axis = (
        S.joint_centres[S.limbs.index("left_forearm")]
        - S.joint_centres[S.limbs.index("left_upper_arm")]
    )
    axis /= np.linalg.norm(axis)
    along = (thick.vertices - S.vertices)[arm] @ axis
    assert_allclose(along, 0, atol=1e-9)
    assert np.abs(thick.vertices - S.vertices)[arm].max() > 1e-3


def test_both_sides_change_alike(rng):
    logs = dict(zip(FACTORS, rng.uniform(-0.1, 0.1, len(FACTORS)), strict=True))
    body = shaped(S, logs)
    for limb, to in (("upper_arm", "forearm"), ("thigh", "shank")):
        left, right = (length(body, f"{s}_{limb}", f"{s}_{to}") for s in ("left", "right"))
        assert left == pytest.approx(right, rel=1e-6)


def test_by_name_and_in_order_are_the_same(rng):
    logs = rng.uniform(-0.1, 0.1, len(FACTORS))
    named = dict(zip(FACTORS, logs, strict=True))
    assert_allclose(shaped(S, logs).vertices, shaped(S, named).vertices)


def test_an_unknown_factor_is_named():
    with pytest.raises(BadSetting, match="nose"):
        shaped(S, {"nose": 0.1})
