"""Markers beside a person's torso that the clustering took for a body."""

from dataclasses import replace

import numpy as np
import pytest

from kinesphere.skeleton import DiscoverySettings, SkeletonSettings
from kinesphere.skeleton.discovery.joint_costs import JointCosts
from kinesphere.skeleton.discovery.names import Names
from kinesphere.skeleton.discovery.partition import find_partition
from kinesphere.skeleton.discovery.twigs import without_twigs

LIMITS = SkeletonSettings()


@pytest.fixture(scope="module", params=[2, 3])
def with_twig(request, recorded, owner):
    """Return bodies of which some of the trunk's markers are cut off, and what limbs are called."""
    points = np.ascontiguousarray(recorded.markers[::3])
    trunk = [i for i, limb in enumerate(owner) if limb == "trunk"]
    slipping = np.array(points)
    rng = np.random.default_rng(1)
    slipping[:, trunk[: request.param]] += rng.normal(scale=0.001, size=(len(points), 1, 3))
    limbs = [limb for limb in dict.fromkeys(owner) if limb != "trunk"]
    bodies = [np.array(trunk[request.param :]), np.array(trunk[: request.param])]
    bodies += [np.flatnonzero(np.array(owner) == limb) for limb in limbs]
    return slipping, bodies, ["trunk", "limb_01", *limbs]


def partition_of(points, bodies, monkeypatch):
    """Return a partition of exactly these bodies."""
    labels = np.full(points.shape[1], -1)
    for b, members in enumerate(bodies):
        labels[members] = b
    settings = DiscoverySettings(bodies=len(bodies))
    from kinesphere.skeleton.discovery import partition as module
    from kinesphere.skeleton.discovery.clustering import Clustering

    monkeypatch.setattr(module, "_clustered", lambda *_: Clustering(labels, {len(bodies): 1.0}))
    return find_partition(points, settings, LIMITS, JointCosts(points))


def told(partition, called, unnamed=frozenset()):
    tree = partition.forest.trees[0]
    return tree, Names({b: called[b] for b in tree}, 0.9, {}, unnamed=unnamed)


def test_a_limb_in_doubt_stays(with_twig, monkeypatch):
    points, bodies, called = with_twig
    partition = partition_of(points, bodies, monkeypatch)
    tree, names = told(partition, called, frozenset({1}))
    found, kept, _ = without_twigs(partition, tree, names, DiscoverySettings(), LIMITS)
    assert kept == tree
    assert found.bodies == partition.bodies


def test_what_is_no_limb_goes_back_to_the_trunk(with_twig, monkeypatch):
    points, bodies, called = with_twig
    partition = partition_of(points, bodies, monkeypatch)
    tree, names = told(partition, called)
    doubt = "limb_01 could not be named though the rest is a person: a part of an arm"
    names = replace(names, doubt=doubt)
    found, kept, renamed = without_twigs(partition, tree, names, DiscoverySettings(), LIMITS)
    assert set(found.bodies[0]) == {*bodies[0], *bodies[1]}
    assert len(found.bodies[1]) == 0
    assert 1 not in kept
    assert len(kept) == len(tree) - 1
    assert set(renamed.limbs.values()) == set(called) - {"limb_01"}
    assert renamed.doubt == ""
    assert {edge.b for edge in found.forest.edges} == set(kept) - {found.forest.trees[0][0]}


def test_doubts_speak_of_limbs_by_what_they_are_called_now(with_twig, monkeypatch):
    """The twig was limb_01; an arm that does not bend and a hand had the numbers after it."""
    points, bodies, called = with_twig
    arm, hand = called.index("left_upper_arm"), called.index("left_forearm")
    called = [
        "limb_02" if b == arm else "limb_03" if b == hand else n for b, n in enumerate(called)
    ]
    partition = partition_of(points, bodies, monkeypatch)
    tree, names = told(partition, called, frozenset({arm, hand}))
    names = replace(names, straight={arm: "left"}, doubt="limb_02 is the whole left arm; …")
    _, kept, renamed = without_twigs(partition, tree, names, DiscoverySettings(), LIMITS)
    assert 1 not in kept
    numbers = {renamed.limbs[arm], renamed.limbs[hand]}
    assert numbers == {"limb_01", "limb_02"}
    assert f"{renamed.limbs[arm]} is the whole left arm: no bend shows" in renamed.doubt
    assert f"; {renamed.limbs[hand]} could not be named though the rest" in renamed.doubt


@pytest.mark.parametrize("name", ["head", "left_upper_arm"])
def test_a_limb_that_has_a_name_stays(with_twig, monkeypatch, name):
    points, bodies, called = with_twig
    partition = partition_of(points, bodies, monkeypatch)
    tree, names = told(partition, ["trunk", name, *called[2:]])
    found, kept, _ = without_twigs(partition, tree, names, DiscoverySettings(), LIMITS)
    assert kept == tree
    assert found.bodies == partition.bodies


def test_what_swings_beside_the_trunk_stays(with_twig, monkeypatch):
    points, bodies, called = with_twig
    swung = np.array(points)
    swing = 0.1 * np.sin(np.linspace(0, 60, len(points)))
    swung[:, bodies[1]] += swing[:, None, None] * np.array([1.0, 0.0, 0.0])
    partition = partition_of(swung, bodies, monkeypatch)
    tree, names = told(partition, called)
    _, kept, _ = without_twigs(partition, tree, names, DiscoverySettings(), LIMITS)
    assert kept == tree
