"""A body on a skeleton: fitted, bound, skinned."""

from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal
from scipy.spatial.transform import Rotation

from kinesphere.data import (
    Motion,
    PoseFlag,
    bundled_body,
    default_origins,
    motion_from_parameters,
    pivots,
    poses_without_gaps,
)
from kinesphere.editing import SurfaceSettings, attach_surface, skin
from kinesphere.editing.mesh.girths import fit_girths
from kinesphere.editing.mesh.merging import on_limbs_of
from kinesphere.editing.mesh.proportions import begins_of, fit_limbs
from kinesphere.editing.mesh.standing import ankle_heights, ups_while_standing
from kinesphere.editing.mesh.untangle import softened
from kinesphere.errors import BadSetting, BadSurface
from kinesphere.synthetic import make_performance

EXACT = 1e-9  # m


@pytest.fixture
def motion(rng):
    """Return how an actor of 12 limbs, a trunk and no hands, moves for three seconds."""
    made = make_performance(rng, rate=25.0, calibration_s=2.0, free_s=1.0)
    return motion_from_parameters(made.parameters)


def posed(motion, rotations, origins):
    flags = np.full(rotations.shape[:2], PoseFlag.MEASURED, dtype=np.uint8)
    return Motion(
        motion.skeleton, rotations, origins, np.zeros(flags.shape), flags, rate=motion.rate
    )


def in_default_position(motion):
    origins = default_origins(motion.skeleton)[None]
    return posed(motion, np.tile(np.eye(3), (*origins.shape[:2], 1, 1)), origins)


def renamed(motion, names):
    """Return the motion with limbs called otherwise."""
    to = dict(zip(motion.skeleton.limb_names, names, strict=True))
    limbs = [
        replace(limb, name=to[limb.name], parent=limb.parent and to[limb.parent])
        for limb in motion.skeleton.limbs
    ]
    joints = [
        replace(joint, parent=to[joint.parent], child=to[joint.child])
        for joint in motion.skeleton.joints
    ]
    skeleton = replace(motion.skeleton, limbs=tuple(limbs), joints=tuple(joints))
    return replace(motion, skeleton=skeleton)


@pytest.mark.parametrize("blend", ["linear", "dual-quaternion"])
def test_in_the_default_position_the_surface_lies_as_bound(motion, blend):
    surface = attach_surface(motion)
    assert_allclose(skin(surface, in_default_position(motion), blend=blend)[0], surface.vertices)


@pytest.mark.parametrize("blend", ["linear", "dual-quaternion"])
def test_the_surface_moves_with_the_world(motion, rng, blend):
    surface, frames = attach_surface(motion), np.array([3, 50])
    turn, shift = Rotation.random(rng=rng).as_matrix(), rng.normal(size=3)
    moved = posed(motion, turn @ motion.rotations, motion.origins @ turn.T + shift)
    assert_allclose(
        skin(surface, moved, frames, blend),
        skin(surface, motion, frames, blend) @ turn.T + shift,
        atol=EXACT,
    )


def test_what_rides_on_one_limb_keeps_its_place_in_it(motion):
    surface = attach_surface(motion)
    limb = surface.limbs.index("left_shank")
    own = surface.weights[:, limb] == 1.0
    assert own.sum() > 20
    frame = 60
    back = motion.rotations[frame, limb].T
    placed = skin(surface, motion, np.array([frame]))[0, own] - motion.origins[frame, limb]
    bound = surface.vertices[own] - default_origins(motion.skeleton)[limb]
    assert_allclose(placed @ back.T, bound, atol=EXACT)


def test_the_skeleton_lies_inside(motion):
    surface = attach_surface(motion)
    for limb, name in enumerate(surface.limbs):
        if name.endswith(("forearm", "shank", "thigh")):
            along = surface.vertices[surface.weights[:, limb] > 0.9] - surface.joint_centres[limb]
            assert abs(along[:, 0].mean()) < 0.03
            assert abs(along[:, 2].mean()) < 0.03
    ankle, knee = (surface.limbs.index(f"left_{name}") for name in ("foot", "shank"))
    assert_array_equal(surface.joint_centres, begins_of(motion.skeleton))
    long = surface.ends[knee] - surface.joint_centres[knee]
    assert_allclose(long, surface.joint_centres[ankle] - surface.joint_centres[knee], atol=2e-3)


def test_no_triangle_turns_over(motion):
    findings = attach_surface(motion).history[-1].findings
    assert findings["inverted_triangles"] == 0


def test_what_a_skeleton_lacks_rides_on_what_carries_it(motion):
    body = on_limbs_of(bundled_body(), motion.skeleton)
    assert body.limbs == motion.skeleton.limb_names
    at = {name: i for i, name in enumerate(body.limbs)}
    whole = {name: i for i, name in enumerate(bundled_body().limbs)}
    given = bundled_body().weights
    assert "left_hand" not in at
    assert_allclose(
        body.weights[:, at["left_forearm"]],
        given[:, whole["left_forearm"]] + given[:, whole["left_hand"]],
    )
    assert_allclose(
        body.weights[:, at["trunk"]], given[:, whole["trunk"]] + given[:, whole["pelvis"]]
    )


def test_limbs_nobody_can_name_carry_no_body(motion):
    unnamed = renamed(motion, [f"limb_{i:02}" for i in range(len(motion.skeleton.limbs))])
    with pytest.raises(BadSurface, match="root is called limb_00; a body needs pelvis or trunk"):
        attach_surface(unnamed)
    headless = renamed(motion, ["trunk", *(f"limb_{i}" for i in range(1, 12))])
    with pytest.raises(BadSurface, match="both thighs or both upper arms by name"):
        attach_surface(headless)


def test_a_surface_fits_one_skeleton_only(motion):
    surface = attach_surface(motion)
    other = renamed(motion, ["trunk", *(f"limb_{i}" for i in range(1, len(surface.limbs)))])
    with pytest.raises(BadSurface, match="attach it first"):
        skin(surface, other)
    with pytest.raises(
        BadSetting, match="blend is 'cubic'; known are linear, dual-quaternion, twist-joints"
    ):
        skin(surface, motion, blend="cubic")


def test_markers_on_a_thicker_skin_make_a_thicker_body(motion):
    """Markers are put where a body twice as far from its axes as likely would have its skin."""
    body = on_limbs_of(bundled_body(), motion.skeleton)
    maps = fit_limbs(body, motion.skeleton, ups_while_standing(motion))
    limb = body.limbs.index("left_thigh")
    limbs = list(motion.skeleton.limbs)
    pivot = pivots(motion.skeleton)[limb]
    turn = np.linspace(0, 2 * np.pi, 7)[:-1]

    def girth(radius):
        ring = np.stack([radius * np.cos(turn), np.full(6, -0.15), radius * np.sin(turn)], 1)
        limbs[limb] = replace(limbs[limb], markers=tuple("abcdef"), marker_positions=pivot + ring)
        skeleton = replace(motion.skeleton, limbs=tuple(limbs))
        return fit_girths(body, skeleton, maps, 0.0).scales[limb, [0, 2]]

    thin, thick = girth(0.06), girth(0.11)
    assert (thin < thick - 0.2).all()
    assert_allclose(girth(0.11), thick)  # and nothing is remembered


def test_feet_stand_level(motion, rng):
    """A foot whose frame leans while it stands tells by how much."""
    n = 40
    lean = Rotation.from_euler("z", -20, degrees=True).as_matrix()
    rotations = np.tile(np.eye(3), (n, len(motion.skeleton.limbs), 1, 1))
    limb = motion.skeleton.limb_names.index("left_foot")
    rotations[:, limb] = lean
    origins = np.tile(default_origins(motion.skeleton), (n, 1, 1))
    origins += rng.normal(scale=1e-4, size=(n, 1, 3))
    ups = ups_while_standing(posed(motion, rotations, origins))
    assert_allclose(lean @ ups[limb], [0, 1, 0], atol=1e-9)


def standing(motion, rng, ankle):
    """Return forty frames of standing with the left ankle so high above y = 0, m."""
    n = 40
    rotations = np.tile(np.eye(3), (n, len(motion.skeleton.limbs), 1, 1))
    limb = motion.skeleton.limb_names.index("left_foot")
    origins = np.tile(default_origins(motion.skeleton), (n, 1, 1))
    at = default_origins(motion.skeleton)[limb] + pivots(motion.skeleton)[limb]
    origins[..., 1] += ankle - at[1]
    origins += rng.normal(scale=1e-5, size=(n, 1, 3))
    return posed(motion, rotations, origins)


@pytest.mark.parametrize("ankle", [0.065, 0.085])
def test_soles_stand_on_the_floor(motion, rng, ankle):
    still = standing(motion, rng, ankle)
    limb = motion.skeleton.limb_names.index("left_foot")
    assert ankle_heights(still)[limb] == pytest.approx(ankle, abs=1e-4)
    surface = attach_surface(still)
    foot = surface.weights[:, limb] > 0.9
    sole = skin(surface, still, np.array([20]))[0, foot, 1].min()
    assert abs(sole) < 6e-3  # weights are softened on the way into the default position


def test_a_floor_elsewhere_moves_no_foot(motion, rng):
    assert np.isnan(ankle_heights(standing(motion, rng, 0.4))).all()
    assert np.isnan(ankle_heights(standing(motion, rng, -0.1))).all()


def test_the_measured_shape_is_not_asked_of_a_given_body(motion):
    """A body without shapes is as large as the skeleton before its limbs are fitted."""
    small = replace(bundled_body(), shapes=())
    small = replace(
        small,
        vertices=small.vertices / 4,
        joint_centres=small.joint_centres / 4,
        ends=small.ends / 4,
    )
    surface = attach_surface(motion, small)
    tall = np.ptp(attach_surface(motion).vertices[:, 1])
    assert np.ptp(surface.vertices[:, 1]) == pytest.approx(tall, rel=0.05)
    thickness = np.array(list(surface.history[-1].findings["thickness"].values()))
    assert (thickness > 0.65).all()
    assert (thickness < 1.5).all()


def test_twist_joints_are_a_blend(motion):
    surface, still = attach_surface(motion), in_default_position(motion)
    assert_allclose(skin(surface, still, blend="twist-joints")[0], surface.vertices)


def test_gaps_are_bridged_by_what_carries_the_limb(motion):
    rotations, origins, flags = (
        np.array(a) for a in (motion.rotations, motion.origins, motion.flags)
    )
    limb = motion.skeleton.limb_names.index("left_forearm")
    parent = motion.skeleton.parents[limb]
    rotations[10:20, limb], origins[10:20, limb] = np.nan, np.nan
    flags[10:20, limb] = PoseFlag.UNSEEN
    gappy = replace(motion, rotations=rotations, origins=origins, flags=flags)
    filled, _ = poses_without_gaps(gappy)
    seen = motion.flags[:, limb] != PoseFlag.UNSEEN
    seen[10:20] = False
    assert_array_equal(filled[seen], motion.rotations[seen])
    kept = filled[9, parent].T @ filled[9, limb]
    assert_allclose(filled[15, parent].T @ filled[15, limb], kept, atol=EXACT)
    assert np.isfinite(skin(attach_surface(motion), gappy, np.arange(8, 22))).all()


def test_thickness_may_be_left_to_the_size(motion):
    plain = attach_surface(motion, settings=SurfaceSettings(fit_girths=False))
    scales = np.array(list(plain.history[-1].findings["thickness"].values()))
    limb = plain.limbs.index("left_shank")
    assert scales[limb, 0] == scales[limb, 2]


def test_implicit_softening_is_the_limit_of_rounds():
    body = bundled_body()
    explicit = softened(body.weights, body.faces, 256)
    implicit = softened(body.weights, body.faces, 257)
    changed = np.abs(explicit - body.weights).mean()
    assert np.abs(explicit - implicit).mean() < 0.12 * changed
    assert_allclose(implicit.sum(axis=1), 1)
