"""Which of several trees is taken where one of them is a person."""

from dataclasses import dataclass
from types import SimpleNamespace

import numpy as np
import pytest

from kinesphere.skeleton.discovery import tree_names
from kinesphere.skeleton.discovery.forest import Forest, forest_of
from kinesphere.skeleton.discovery.names import Names, no_names
from kinesphere.skeleton.discovery.rival_trees import similar_forests
from kinesphere.skeleton.discovery.settings import DiscoverySettings

CHEAP = 0.01  # m


def chain(rival):
    """Return three bodies in a row; the joint of the outer two costs ``rival`` times as much."""
    costs = {(0, 1): CHEAP, (1, 2): CHEAP, (0, 2): rival * CHEAP}
    return forest_of([(0, 1), (1, 2)], costs, (3, 4, 3))


@pytest.mark.parametrize(("rival", "tried"), [(1.25, 2), (1.5, 0)])
def test_a_rival_counts_while_it_costs_little_more(rival, tried):
    others = list(similar_forests(chain(rival), 0))[1:]
    assert len(others) == tried
    for other, unlikely in others:
        assert (0, 2) in {(edge.a, edge.b) for edge in other.edges} | {
            (edge.b, edge.a) for edge in other.edges
        }
        assert unlikely == pytest.approx(np.log(rival))


@dataclass(frozen=True)
class Partitioned:
    """As much of a partition as naming asks for."""

    forest: Forest
    bodies = ()
    shared = ()
    rigidity = SimpleNamespace(mean=())
    belonging = SimpleNamespace()


@pytest.fixture(autouse=True)
def no_animal(monkeypatch):
    monkeypatch.setattr(tree_names, "make_figure", lambda _c, _b, pairs, *_: pairs)
    monkeypatch.setattr(tree_names, "cost_of_animal", lambda *_: np.inf)


@pytest.mark.parametrize(("gain", "taken"), [(3.0, False), (6.0, True)])
def test_another_tree_is_taken_where_it_is_a_likelier_person(monkeypatch, gain, taken):
    """A rival that costs a quarter more has to be a person by 20 log 1.25 = 4.5 the likelier."""

    def names(pairs, tree, _animal):
        apart = (0, 2) in pairs or (2, 0) in pairs
        return Names(dict.fromkeys(tree, "trunk"), 0.9, {}, cost=10.0 - gain * apart)

    monkeypatch.setattr(tree_names, "find_names", names)
    partition, tree, found = tree_names.named_tree(
        Partitioned(chain(1.25)), None, DiscoverySettings()
    )
    assert (found.cost < 10) == taken
    assert (partition.forest.neighbours(1) == [0, 2]) != taken
    assert set(tree) == {0, 1, 2}


def test_where_nobody_is_seen_the_likeliest_tree_stays(monkeypatch):
    monkeypatch.setattr(tree_names, "find_names", lambda _f, tree, _a: no_names(tree))
    partition, _, found = tree_names.named_tree(Partitioned(chain(1.25)), None, DiscoverySettings())
    assert partition.forest.neighbours(1) == [0, 2]
    assert not found.given


def test_an_animal_seen_in_any_likely_tree_is_a_rival_in_all_of_them(monkeypatch):
    """Seen where a joint costs a quarter more it costs 4.5 more; from there, 4.5 less."""
    seen = []

    def animal(pairs, _tree):
        return 7.0 if (0, 2) in pairs or (2, 0) in pairs else np.inf

    def names(pairs, tree, rival):
        seen.append(rival)
        return no_names(tree)

    monkeypatch.setattr(tree_names, "cost_of_animal", animal)
    monkeypatch.setattr(tree_names, "find_names", names)
    tree_names.named_tree(Partitioned(chain(1.25)), None, DiscoverySettings())
    assert seen == pytest.approx([7 + 20 * np.log(1.25), 7.0, 7.0])
