"""reach_for: two bones and a hinge, against lengths, a search, and mirrors."""

import numpy as np
from numpy.testing import assert_allclose
from scipy.spatial.transform import Rotation

from kinesphere.geometry.two_bone import longest_reach, reach_for

FRAMES = 40
EXACT = 1e-9


def chain(rng, varus=0.0):
    """Hip, knee, ankle and hinge of a leg that is bent a little; knees bend about −z."""
    bend = rng.uniform(0.05, 1.5, FRAMES)
    thigh = np.tile([0.0, -0.42, 0.0], (FRAMES, 1))
    shank = 0.4 * np.stack([-np.sin(bend), -np.cos(bend), np.full(FRAMES, varus)], axis=1)
    turn = Rotation.random(FRAMES, rng=rng)
    hip = rng.normal(size=(FRAMES, 3))
    knee = hip + turn.apply(thigh)
    return hip, knee, knee + turn.apply(shank), turn.apply([0.0, 0.0, 1.0])


def moved(hip, knee, ankle, reach):
    knee_after = hip + (reach.upper @ (knee - hip)[..., None])[..., 0]
    return knee_after, knee_after + (reach.lower @ (ankle - knee)[..., None])[..., 0]


def test_the_end_comes_to_the_goal_and_bones_keep_their_length(rng):
    hip, knee, ankle, hinge = chain(rng, varus=0.1)
    far = longest_reach(hip, knee, ankle, hinge)
    goal = (
        hip
        + Rotation.random(FRAMES, rng=rng).apply([1, 0, 0])
        * (far * rng.uniform(0.3, 0.999, FRAMES))[:, None]
    )
    reach = reach_for(hip, knee, ankle, hinge, goal)
    knee_after, end = moved(hip, knee, ankle, reach)
    assert_allclose(end, goal, atol=EXACT)
    assert_allclose(reach.missed, 0, atol=EXACT)
    for before, after in ((knee - hip, knee_after - hip), (ankle - knee, end - knee_after)):
        assert_allclose(np.linalg.norm(after, axis=1), np.linalg.norm(before, axis=1))
    assert_allclose(np.linalg.det(reach.lower), 1)


def test_a_goal_where_the_end_is_changes_nothing(rng):
    hip, knee, ankle, hinge = chain(rng, varus=0.05)
    reach = reach_for(hip, knee, ankle, hinge, ankle)
    assert_allclose(reach.upper, np.tile(np.eye(3), (FRAMES, 1, 1)), atol=1e-7)
    assert_allclose(reach.lower, np.tile(np.eye(3), (FRAMES, 1, 1)), atol=1e-7)


def test_knees_bend_backward_even_from_overstretched(rng):
    hip = np.zeros((3, 3))
    knee = np.tile([0.0, -0.42, 0.0], (3, 1))
    over = np.array([-0.1, 0.0, 0.1])  # bent backward, straight, overstretched
    ankle = knee + 0.4 * np.stack([np.sin(over), -np.cos(over), 0 * over], axis=1)
    hinge = np.tile([0.0, 0.0, 1.0], (3, 1))
    goal = np.tile([0.0, -0.7, 0.0], (3, 1))
    knee_after, end = moved(hip, knee, ankle, reach_for(hip, knee, ankle, hinge, goal))
    assert_allclose(end, goal, atol=EXACT)
    assert (knee_after[:, 0] > 0.1).all(), "the knee points forward"
    assert_allclose(knee_after, np.broadcast_to(knee_after[0], (3, 3)), atol=EXACT)


def test_out_of_reach_is_pointed_at_and_told(rng):
    hip, knee, ankle, hinge = chain(rng, varus=0.1)
    far = longest_reach(hip, knee, ankle, hinge)
    bones = np.linalg.norm(knee - hip, axis=1) + np.linalg.norm(ankle - knee, axis=1)
    assert (far < bones - 1e-4).all(), "a leg that is not plane is shorter than its bones"
    way = Rotation.random(FRAMES, rng=rng).apply([1, 0, 0])
    reach = reach_for(hip, knee, ankle, hinge, hip + 2 * way)
    _, end = moved(hip, knee, ankle, reach)
    assert_allclose(end, hip + far[:, None] * way, atol=1e-7)
    assert_allclose(reach.missed, 2 - far, atol=1e-7)


def test_no_turn_of_the_hinge_reaches_farther(rng):
    hip, knee, ankle, hinge = chain(rng, varus=0.2)
    far = longest_reach(hip, knee, ankle, hinge)
    for angle in np.linspace(-np.pi, np.pi, 181):
        turned = Rotation.from_rotvec(angle * hinge).apply(ankle - knee)
        assert (np.linalg.norm(knee + turned - hip, axis=1) <= far + EXACT).all()


def test_the_leg_moves_with_the_world(rng):
    hip, knee, ankle, hinge = chain(rng)
    goal = hip + 0.9 * (ankle - hip) + 0.02
    reach = reach_for(hip, knee, ankle, hinge, goal)
    turn, shift = Rotation.random(rng=rng), rng.normal(size=3)
    other = reach_for(
        *(turn.apply(p) + shift for p in (hip, knee, ankle)),
        turn.apply(hinge),
        turn.apply(goal) + shift,
    )
    matrix = turn.as_matrix()
    assert_allclose(other.lower, matrix @ reach.lower @ matrix.T, atol=1e-8)


def test_a_goal_at_the_hip_is_survived(rng):
    hip, knee, ankle, hinge = chain(rng)
    reach = reach_for(hip, knee, ankle, hinge, hip)
    assert np.isfinite(reach.lower).all()
    assert_allclose(reach.missed, 0.02, atol=1e-6)  # thigh and shank differ by so much
