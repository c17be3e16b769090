"""Chains, poses and how points move, against finite differences and naive twins."""

import numpy as np
import pytest
from numpy.testing import assert_allclose
from scipy.linalg import expm
from scipy.spatial.transform import Rotation

from kinesphere.errors import BadModel
from kinesphere.geometry.rotations import hat
from kinesphere.geometry.twists import incidence, joint_twists, twist_exp
from kinesphere.markerless.chain import Chain
from kinesphere.markerless.pose import bind_pose, difference, limited, moved, posed
from kinesphere.markerless.rim import derivatives

EXACT = 1e-12


def matrix_of(twist):
    m = np.zeros((4, 4))
    m[:3, :3], m[:3, 3] = hat(twist[3:]), twist[:3]
    return m


@pytest.mark.parametrize("size", [0.0, 1e-9, 1e-4, 0.3, 3.0, 6.0])
def test_a_twist_exponential_is_the_matrix_exponential(rng, size):
    twists = rng.normal(size=(4, 6))
    twists[:, 3:] *= size / np.linalg.norm(twists[:, 3:], axis=1, keepdims=True)
    for twist, motion in zip(twists, twist_exp(twists), strict=True):
        assert_allclose(motion, expm(matrix_of(twist)), atol=1e-11)


def test_a_joints_twist_leaves_its_axis_in_place(rng):
    axis = rng.normal(size=3)
    axis /= np.linalg.norm(axis)
    point = rng.normal(size=3)
    motion = twist_exp(1.3 * joint_twists(axis, point))
    for along in (-0.4, 0.0, 2.0):
        on = point + along * axis
        assert_allclose(motion[:3, :3] @ on + motion[:3, 3], on, atol=EXACT)


def test_incidence_is_the_distance_from_a_line(rng):
    direction = rng.normal(size=3)
    direction /= np.linalg.norm(direction)
    point, across = rng.normal(size=3), np.cross(direction, rng.normal(size=3))
    moment = np.cross(point, direction)
    on = point + 0.7 * direction
    assert_allclose(incidence(on, direction, moment), 0, atol=EXACT)
    off = incidence(on + across, direction, moment)
    assert np.linalg.norm(off) == pytest.approx(np.linalg.norm(across))


def test_the_papers_model_has_21_degrees_of_freedom_and_the_whole_body_42(whole, upper):
    assert upper.chain.n_dofs == 21
    assert whole.chain.n_dofs == 42
    arm = [n for n in upper.parameter_names if n.startswith("left_")]
    assert len(arm) == 7
    assert sum(n.startswith("trunk") for n in upper.parameter_names) == 1


def test_the_bind_pose_is_the_surface_as_it_was_made(whole):
    assert_allclose(
        whole.skinned(posed(whole.chain, bind_pose(whole.chain))), whole.bind, atol=1e-14
    )


def test_steps_and_differences_are_inverse(whole, rng):
    chain = whole.chain
    start = moved(chain, bind_pose(chain), rng.normal(scale=0.5, size=chain.n_dofs))
    step = rng.normal(scale=0.4, size=chain.n_dofs)
    assert_allclose(difference(chain, start, moved(chain, start, step)), step, atol=EXACT)


def test_parameters_carry_a_pose_there_and_back(whole, rng):
    chain = whole.chain
    pose = moved(chain, bind_pose(chain), rng.normal(scale=0.5, size=chain.n_dofs))
    values = whole.parameters(pose)
    assert len(values) == len(set(whole.parameter_names)) == chain.n_dofs
    assert_allclose(difference(chain, pose, whole.pose(values)), 0, atol=EXACT)


@pytest.mark.parametrize("model", ["whole", "upper"])
def test_derivatives_are_those_of_finite_differences(model, rng, request):
    body = request.getfixturevalue(model)
    chain = body.chain
    pose = moved(chain, bind_pose(chain), rng.normal(scale=0.4, size=chain.n_dofs))
    pairs = body.edges[rng.integers(0, len(body.edges), 50)]
    shares = rng.random(50)
    directions = np.tile(np.eye(3), (50, 1, 1))
    points, rows = derivatives(body, posed(chain, pose), pairs, shares, directions)

    def at(step):
        v = body.skinned(posed(chain, moved(chain, pose, step)))
        return v[pairs[:, 0]] * (1 - shares)[:, None] + v[pairs[:, 1]] * shares[:, None]

    assert_allclose(points, at(np.zeros(chain.n_dofs)), atol=EXACT)
    small = 1e-6
    for k in range(chain.n_dofs):
        step = np.zeros(chain.n_dofs)
        step[k] = small
        numeric = (at(step) - at(-step)) / (2 * small)
        assert_allclose(rows[:, :, k], numeric, atol=1e-9)  # of lever arms of about 1 m


def test_limits_hold_and_leave_alone_what_is_within_them(whole, rng):
    chain = whole.chain
    bind = bind_pose(chain)
    assert_allclose(difference(chain, bind, limited(chain, bind)), 0, atol=EXACT)
    wild = moved(chain, bind, rng.normal(scale=2.0, size=chain.n_dofs))
    kept = limited(chain, wild)
    low, high = chain.limits
    assert (kept.angles >= low).all()
    assert (kept.angles <= high).all()
    for i, link in enumerate(chain.links):
        if link.kind == "ball":
            angle = np.arccos(np.clip((kept.balls[i] @ link.long_axis) @ link.towards, -1, 1))
            assert angle <= link.swing + 1e-6
    # what is within the limits once stays put
    assert_allclose(difference(chain, kept, limited(chain, kept)), 0, atol=1e-6)


def test_limits_and_turns_are_those_of_matrices_in_the_textbook(whole, rng):
    # a naive twin by scipy: swing brought back along the great circle, then twist about the limb
    chain = whole.chain
    for _ in range(20):
        step = rng.normal(scale=1.5, size=chain.n_dofs)
        start = moved(chain, bind_pose(chain), rng.normal(scale=1.0, size=chain.n_dofs))
        wild = moved(chain, start, step)
        turns = step[chain.turns].reshape(-1, 3)
        for limb, turn in zip(chain.turned, turns, strict=True):
            wanted = Rotation.from_rotvec(turn).as_matrix() @ start.balls[limb]
            assert_allclose(wild.balls[limb], wanted, atol=EXACT)
        kept = limited(chain, wild)
        for i, link in enumerate(chain.links):
            if link.kind != "ball":
                continue
            turn = Rotation.from_matrix(wild.balls[i])
            pointing = turn.apply(link.long_axis)
            angle = np.arccos(np.clip(pointing @ link.towards, -1, 1))
            if angle > link.swing:
                axis = np.cross(link.towards, pointing)
                axis *= (link.swing - angle) / np.linalg.norm(axis)
                turn = Rotation.from_rotvec(axis) * turn
                pointing = turn.apply(link.long_axis)
            across = np.cross(link.long_axis, pointing)
            bent = np.arctan2(np.linalg.norm(across), link.long_axis @ pointing)
            least = Rotation.from_rotvec(across * bent / np.linalg.norm(across))
            twist = (least.inv() * turn).as_rotvec() @ link.long_axis
            about = np.clip(twist, -link.twist, link.twist)
            wanted = least * Rotation.from_rotvec(about * link.long_axis)
            assert_allclose(kept.balls[i], wanted.as_matrix(), atol=1e-7)


def test_a_turned_world_turns_the_body(whole, rng):
    chain = whole.chain
    pose = moved(chain, bind_pose(chain), rng.normal(scale=0.3, size=chain.n_dofs))
    turn = Rotation.random(rng=rng).as_matrix()
    balls = pose.balls.copy()
    balls[0] = turn @ balls[0]
    turned = type(pose)(turn @ pose.position, balls, pose.angles)
    there = whole.skinned(posed(chain, pose)) @ turn.T
    assert_allclose(whole.skinned(posed(chain, turned)), there, atol=EXACT)


def test_a_child_before_its_parent_is_refused(whole):
    links = whole.chain.links
    with pytest.raises(BadModel, match="comes before its parent"):
        Chain((links[0], links[2], links[1]))
