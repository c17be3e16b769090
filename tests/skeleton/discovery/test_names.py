"""When a tree is called a person, and how sure its names are."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from kinesphere.geometry.length_units import STATURE
from kinesphere.skeleton import discover
from kinesphere.skeleton.discovery.figure import Figure
from kinesphere.skeleton.discovery.forest import Edge, Forest
from kinesphere.skeleton.discovery.likeliest import SHARPNESS
from kinesphere.skeleton.discovery.names import Names, _torso
from kinesphere.skeleton.discovery.person import LIKELY, Person
from kinesphere.skeleton.discovery.trust import shaken
from kinesphere.synthetic import HAND, make_performance, spoil_with_noise

LIMBS = {0: "trunk", 1: "head", 2: "limb_01", 3: "limb_02"}


def names(confidence=0.9):
    return Names(dict(LIMBS), confidence, {"person": True})


def forest(*confidences):
    """Return the forest of a trunk, a head on it, and two bodies beyond the head."""
    ends = ((0, 1), (1, 2), (2, 3))
    edges = tuple(
        Edge(a, b, 0.01 * (1 - sure), 0.01) for (a, b), sure in zip(ends, confidences, strict=True)
    )
    return Forest(((0, 1, 2, 3),), edges, {}, (5, 4, 3, 3))


def test_names_are_as_sure_as_proportions_say_where_nothing_else_is_in_doubt():
    sure = shaken(names(), forest(0.5, 0.5, 0.0), 0.9)  # the last edge holds no named limb
    assert sure.confidence == pytest.approx(0.9)
    assert sure.doubt == ""


@pytest.mark.parametrize(
    ("edges", "count"), [((0.0, 0.5, 0.5), 0.9), ((0.5, 0.0, 0.5), 0.9), ((0.5, 0.5, 0.5), 0.0)]
)
def test_half_is_left_where_another_tree_or_number_would_do_as_well(edges, count):
    doubted = shaken(names(0.95), forest(*edges), count)
    assert doubted.confidence == pytest.approx(0.475)
    assert doubted.limbs == LIMBS
    assert "unsure and may be wrong (confidence 0.47)" in doubted.doubt


def test_names_too_unsure_are_told_but_not_given():
    doubted = shaken(names(0.8), forest(0.0, 0.5, 0.5), 0.9)
    assert not doubted.given
    assert doubted.limbs == {0: "limb_01", 1: "limb_02", 2: "limb_03", 3: "limb_04"}
    assert doubted.doubt.endswith("(confidence 0.40): limbs are numbered; likely were limb_01 "
                                  "trunk, limb_02 head")  # fmt: skip
    assert doubted.account["likely_names"] == {"limb_01": "trunk", "limb_02": "head"}
    assert doubted.account["person"] is False


def test_where_no_name_is_given_nothing_is_shaken():
    none = names(np.nan)
    assert shaken(none, forest(0.0, 0.0, 0.0), 0.0) is none


def test_stature_counts_and_a_child_is_a_person():
    sizes = {
        s: Person(0, None, ((1, 2), (3, 4)), (), None, stature=s).size for s in (0.9, 2.0, 0.2)
    }
    assert sizes[0.9] < 6  # squared standard deviations
    assert sizes[2.0] < 1
    assert sizes[0.2] > 60
    assert Person(0, None, ((1, 2), (3, 4)), (), None, stature=STATURE).size == 0


def test_a_person_of_a_hand_s_size_is_numbered_and_the_size_told(recorded):
    found = discover(replace(recorded, markers=0.2 * recorded.markers))
    assert all(segment.name.startswith("limb_") for segment in found.model.segments)
    (told,) = (warning for warning in found.step.warnings if "the size is not" in warning)
    assert "unit of length" in told


def test_a_hand_of_a_person_s_proportions_is_no_person():
    """Fingers of two bodies beside two of three: legs, arms and a thumb for a head."""
    rng = np.random.default_rng(10)
    performance = make_performance(rng, plan=HAND, n_frames=8000)
    found = discover(spoil_with_noise(performance.recording, rng, deviation=0.0002))
    assert all(segment.name.startswith("limb_") for segment in found.model.segments)


def test_nobody_is_a_reading_too(monkeypatch):
    """A cost at the limit leaves even odds, however bad every other reading is."""
    from kinesphere.skeleton.discovery import likeliest as module

    only = Person(0, None, ((1, 2), (3, 4)), (), None, lengths=10, stature=STATURE)
    monkeypatch.setattr(module, "readings", lambda *_: iter([only]))
    for margin in (0.0, 2.0, 10.0):
        cost = LIKELY * 10 - margin
        monkeypatch.setattr(module, "judged", lambda _f, p, _n, cost=cost: replace(p, cost=cost))
        _, sure = module.find_person(None, (0, 1, 2, 3, 4))
        assert sure == pytest.approx(1 / (1 + np.exp(-margin / SHARPNESS)))


@pytest.fixture
def read_as(monkeypatch):
    """Return costs of a leg pair on a trunk with arms, as a function of other bodies' places."""
    from kinesphere.skeleton.discovery import proportions as module

    monkeypatch.setattr(Figure, "length", lambda *_: 0.4)
    monkeypatch.setattr(module, "off", lambda *_: 0.0)

    def cost(*extra, arms=2, feet=True, head=True):
        """``extra`` bodies hang from the body given; the trunk is 0."""
        edges = [(0, 1), (1, 2), (0, 3), (3, 4)]  # two legs: thigh, shank
        edges += [(2, 5), (4, 6)] if feet else []
        hands = [(0, 7), (7, 8), (0, 9), (9, 10)][: 2 * arms]
        edges += hands + ([(0, 11)] if head else [])
        edges += [(at, 12 + k) for k, at in enumerate(extra)]
        bodies = sorted({b for edge in edges for b in edge})
        beside = tuple(
            tuple(sorted(b for edge in edges if a in edge for b in edge if b != a))
            for a in range(max(bodies) + 1)
        )
        figure = Figure(
            beside, np.zeros((1, 20, 3)), tuple(np.zeros((1, 2, 3)) for _ in beside), {}
        )
        legs = ((1, 2, 5), (3, 4, 6)) if feet else ((1, 2), (3, 4))
        reading = Person(
            0, None, legs, tuple([(0, (7, 8)), (0, (9, 10))][:arms]), 11 if head else None
        )
        return module.judged(figure, reading, len(bodies)).cost

    return cost


def test_what_is_missing_costs_more_than_what_is_held_and_less_than_what_is_left_over(read_as):
    whole = read_as()
    assert whole == 0
    held, left_over = read_as(8), read_as(0)
    for less in (read_as(arms=1), read_as(head=False), read_as(feet=False) / 2):
        assert held < less < left_over
    assert read_as(8, 12) == 2 * held  # what hangs from a thing that is held is held
    assert read_as(8, 0) == held + left_over


def test_a_body_left_over_costs_what_one_person_in_twenty_has(read_as):
    """−2 log of its share, as every squared deviation is: a person with five such is nobody."""
    assert read_as(0) == pytest.approx(2 * np.log(20), rel=0.01)
    assert read_as(0, 0) == pytest.approx(4 * np.log(20), rel=0.01)


def test_what_legs_hang_from_is_the_pelvis_where_nothing_is_above_it():
    legs = ((1, 2, 3), (4, 5, 6))
    assert _torso(Person(0, None, legs, (), None)) == {0: "pelvis"}
    assert _torso(Person(0, None, legs, ((0, (7, 8)),), None)) == {0: "trunk"}
    assert _torso(Person(0, None, legs, (), 7)) == {0: "trunk", 7: "head"}


@pytest.mark.parametrize(
    ("other", "rather"), [(0.40, False), (0.48, True), (0.70, False)]
)  # of stature; heads are at .42, a thing held high is no head
def test_what_is_farther_from_the_hips_as_heads_are_is_rather_the_head(other, rather):
    from kinesphere.skeleton.discovery.proportions import _rather_the_head

    ways = {11: 0.41, 12: other}
    figure = SimpleNamespace(beside=((1, 3, 11, 12),), length=lambda _, b: ways[b[1]])
    person = Person(0, None, ((1, 2), (3, 4)), (), 11)
    assert _rather_the_head(figure, person, ("joint", 0, 1), 1.0) is rather


def test_another_headcontradicts():
    from kinesphere.skeleton.discovery.likeliest import contradicts

    legs = ((1, 2), (3, 4))
    one, other, none = (Person(0, None, legs, (), head) for head in (11, 12, None))
    assert contradicts(other, one)
    assert not contradicts(none, one)
    assert not contradicts(one, one)
