"""Trees of bodies: which edges, what their rivals are, what moves by itself, and the root."""

from itertools import pairwise

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from kinesphere.skeleton.discovery.forest import Edge, contracted, rerooted
from kinesphere.skeleton.discovery.joint_costs import JointCosts
from kinesphere.skeleton.discovery.joint_doubts import doubts_of_joints, is_told
from kinesphere.skeleton.discovery.joint_tree import find_forest
from kinesphere.skeleton.discovery.rival_trees import similar_forests

FRAMES = 300
NOISE = 0.001  # m


@pytest.fixture(scope="module")
def true_bodies(owner):
    """Return the columns of every true limb."""
    limbs = list(dict.fromkeys(owner))
    return limbs, [np.flatnonzero(np.array(owner) == limb) for limb in limbs]


@pytest.fixture(scope="module")
def forest(recorded, true_bodies):
    """Return the forest of the true bodies."""
    return find_forest(JointCosts(recorded.markers[::3]), true_bodies[1])


def edges_of(forest):
    return {frozenset((edge.a, edge.b)) for edge in forest.edges}


def test_the_tree_of_an_actor_is_found_from_its_bodies(actor, true_bodies, forest):
    at = {limb: i for i, limb in enumerate(true_bodies[0])}
    truth = {frozenset((at[j.parent], at[j.child])) for j in actor.skeleton.joints}
    assert edges_of(forest) == truth
    assert len(forest.trees) == 1
    assert true_bodies[0][forest.trees[0][0]] == "trunk"


def test_parents_come_before_children_and_only_roots_have_none(forest):
    (tree,) = forest.trees
    for body in tree[1:]:
        assert tree.index(forest.parent(body)) < tree.index(body)
        assert body in forest.children(forest.parent(body))
    assert forest.parent(tree[0]) is None


def test_a_rival_is_the_cheapest_other_way_to_hold_the_tree_together(forest):
    for edge in forest.edges:
        side = {edge.b}
        while (
            more := {
                b
                for other in forest.edges
                if other is not edge and ({other.a, other.b} & side)
                for b in (other.a, other.b)
            }
            - side
        ):
            side |= more
        across = [
            cost
            for pair, cost in forest.costs.items()
            if len(set(pair) & side) == 1 and set(pair) != {edge.a, edge.b}
        ]
        assert edge.next_best == min(across)
        assert edge.next_best >= edge.cost


def test_confidence_goes_from_a_tie_to_certainty():
    assert Edge(0, 1, 0.01, 0.01).confidence == 0
    assert Edge(0, 1, 0.01, 0.04).confidence == pytest.approx(0.75)
    assert Edge(0, 1, 0.01, np.inf).confidence == 1
    assert Edge(0, 1, 0.02, 0.01).confidence == 0


def test_what_moves_by_itself_is_a_tree_of_its_own(
    recorded, owner, true_bodies, rng, moving_bodies
):
    stranger, _ = moving_bodies(rng, (4,), n_frames=recorded.n_frames)
    away = stranger + np.array([2.0, 0.0, 0.0])
    points = np.concatenate([recorded.markers, away], axis=1)
    bodies = [*true_bodies[1], np.arange(len(owner), len(owner) + 4)]
    forest = find_forest(JointCosts(points[::3]), bodies)
    assert [len(tree) for tree in forest.trees] == [len(true_bodies[1]), 1]
    assert forest.trees[1] == (len(bodies) - 1,)


@pytest.mark.parametrize("sizes", [(4, 5), (4, 3, 5)])
def test_bodies_that_have_nothing_to_do_with_each_other_are_as_many_trees(
    rng, moving_bodies, sizes
):
    points, of = moving_bodies(rng, sizes, apart=1.0, noise=0.0005)
    bodies = [np.flatnonzero(of == k) for k in range(len(sizes))]
    forest = find_forest(JointCosts(points), bodies)
    assert len(forest.trees) == len(sizes)
    assert forest.edges == ()


def test_another_root_turns_edges_and_nothing_else(forest):
    foot = forest.trees[0][-1]
    turned = rerooted(forest, foot)
    assert turned.trees[0][0] == foot
    assert turned.parent(foot) is None
    assert edges_of(turned) == edges_of(forest)
    for body in turned.trees[0][1:]:
        assert turned.trees[0].index(turned.parent(body)) < turned.trees[0].index(body)


def test_similar_forests_swap_doubtful_edges_only_and_stay_trees(forest):
    found = list(similar_forests(forest, 0))
    assert found[0] == (forest, 0.0)
    own = edges_of(forest)
    doubtful = {frozenset((e.a, e.b)) for e in forest.edges if e.confidence < 0.3}
    for other, unlikely in found[1:]:
        assert 1 <= len(own - edges_of(other)) <= 2
        assert own - edges_of(other) <= doubtful
        assert len(other.trees) == 1
        assert unlikely > 0


def test_swaps_that_would_make_a_ring_are_left_out(forest, monkeypatch):
    monkeypatch.setattr("kinesphere.skeleton.discovery.rival_trees.SWAPPED", 0.99)
    found = [other for other, _ in similar_forests(forest, 0)]
    assert len(found) > 50
    assert all(len(other.trees) == 1 for other in found)


def test_two_bodies_made_one_leave_the_rest_of_the_tree(forest):
    edge = forest.edges[-1]
    one = contracted(forest, edge.a, edge.b, forest.sizes)
    assert edge.b not in one.trees[0]
    assert len(one.trees) == 1
    assert len(one.trees[0]) == len(forest.trees[0]) - 1
    kept = {frozenset({edge.a if b == edge.b else b for b in pair}) for pair in edges_of(forest)}
    assert edges_of(one) == {pair for pair in kept if len(pair) == 2}
    for pair, cost in one.costs.items():
        assert edge.b not in pair
        assert cost <= forest.costs[pair]


def test_costs_do_not_depend_on_who_is_asked_first(recorded, true_bodies):
    points = recorded.markers[::3]
    one, other = JointCosts(points), JointCosts(points)
    for a, b in pairwise(true_bodies[1]):
        assert one.between(a, b) == pytest.approx(other.between(b, a), rel=0.05)


def swinging(rng, place, still):
    """Return a shank swinging about an ankle, and a body at ``place`` that stands still, m."""
    angles = 0.5 * np.sin(np.linspace(0, 12, FRAMES))
    turns = Rotation.from_rotvec(angles[:, None] * [0.0, 0.3, 1.0]).as_matrix()
    shank = np.array([[0.03, 0.1, 0], [-0.03, 0.15, 0.02], [0, 0.2, -0.03], [0.02, 0.3, 0.03]])
    points = np.concatenate(
        [np.einsum("fij,mj->fmi", turns, shank), np.tile(still + np.array(place), (FRAMES, 1, 1))],
        axis=1,
    )
    return points + rng.normal(scale=NOISE, size=points.shape)


STILL = np.array(
    [[0.0, -0.04, 0.0], [0.08, -0.06, 0.02], [0.02, -0.05, -0.06], [0.05, -0.03, 0.04]]
)


def test_a_foot_that_stands_still_meets_its_shank_and_a_thing_beside_does_not(rng):
    bodies = [np.arange(4), np.arange(4, 8)]
    foot = swinging(rng, (0.0, 0.0, 0.0), STILL)
    assert len(find_forest(JointCosts(foot), bodies).trees) == 1
    thing = swinging(rng, (0.5, 0.0, 0.0), STILL)
    assert len(find_forest(JointCosts(thing), bodies).trees) == 2


def test_two_that_stand_about_are_not_joined_by_standing(rng):
    """Each sways by centimetres for itself: no point goes about with both."""
    sway = np.cumsum(rng.normal(scale=0.002, size=(2, FRAMES, 1, 3)), axis=1)
    sway *= 0.015 / sway.std(axis=1, keepdims=True)
    one, other = sway + STILL
    points = np.concatenate([one, other + np.array([0.6, 0.0, 0.0])], axis=1)
    points += rng.normal(scale=NOISE, size=points.shape)
    forest = find_forest(JointCosts(points), [np.arange(4), np.arange(4, 8)])
    assert len(forest.trees) == 2


class Told:
    """Joint costs that are given."""

    def __init__(self, costs):
        self.costs = costs

    def between(self, a, b):
        return self.costs.get((int(a[0]), int(b[0])), np.inf)


@pytest.mark.parametrize(
    ("usual", "last", "trees"),
    [(0.01, 0.05, 1), (0.01, 0.07, 2), (0.04, 0.11, 1), (0.04, 0.13, 2)],  # m
)
def test_a_joint_that_costs_far_more_than_joints_do_is_none(usual, last, trees):
    """More than 60 mm, and more than three times what the cheaper ones cost: noisy data."""
    costs = Told({(0, 1): usual, (1, 2): usual, (2, 3): last})
    assert len(find_forest(costs, [np.array([i]) for i in range(4)]).trees) == trees


def test_two_that_go_the_same_way_are_not_one(rng, moving_bodies):
    """Each turns and sways by a decimetre for itself while both walk three metres."""
    points, of = moving_bodies(rng, (4, 4), apart=0.0, noise=NOISE, n_frames=FRAMES)
    for k in range(2):
        points[:, of == k] -= points[:, of == k].mean(axis=1, keepdims=True)
    times = np.linspace(0, 1, FRAMES)[:, None]
    for k in range(2):
        sway = 0.1 * np.sin(20 * times + rng.uniform(0, 6, size=3) + 3 * k * times)
        points[:, of == k] += (3.0 * times * [1, 0, 0] + sway + 0.5 * k)[:, None]
    forest = find_forest(JointCosts(points), [np.arange(4), np.arange(4, 8)])
    assert len(forest.trees) == 2


def test_joints_are_doubted_by_their_rivals_or_by_what_they_cost():
    assert Edge(0, 1, 0.009, 0.010).doubtful
    assert not Edge(0, 1, 0.006, 0.010).doubtful
    assert Edge(0, 1, 0.009, np.inf).doubtful  # no rival speaks for it if it hardly fits itself
    assert not Edge(0, 1, 0.002, np.inf).doubtful


def test_of_a_joint_without_a_rival_no_other_tree_is_said_to_be_likely():
    rivalled, alone = doubts_of_joints(
        [
            ("elbow", Edge(0, 1, 0.009, 0.010)),
            ("knee", Edge(0, 1, 0.009, np.inf)),
            ("hip", Edge(0, 1, 0.002, np.inf)),
        ],
        np.nan,
    )
    assert "another tree" in rivalled
    assert rivalled.endswith("at elbow (0.10)")
    assert "another tree" not in alone
    assert alone.endswith(": knee may be wrong")


@pytest.mark.parametrize(("named", "least"), [(0.8, 0.1), (0.5, 0.3), (np.nan, 0.45)])
def test_joints_of_a_person_are_doubted_less_than_others(named, least):
    """Confidence is 1 − cost / cost of the rival; the surer the names, the surer the tree."""
    assert is_told(Edge(0, 1, 0.01 * (1.01 - least), 0.01), named)
    assert not is_told(Edge(0, 1, 0.01 * (0.99 - least), 0.01), named)
    assert is_told(Edge(0, 1, 0.009, np.inf), named)
    assert not is_told(Edge(0, 1, 0.002, np.inf), named)
