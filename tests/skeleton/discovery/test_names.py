"""When a tree is called a person, and how sure its names are."""

from dataclasses import replace

import numpy as np
import pytest

from kinesphere.skeleton import discover
from kinesphere.skeleton.discovery.forest import Edge, Forest
from kinesphere.skeleton.discovery.names import Names, shaken
from kinesphere.skeleton.discovery.person import LIKELY, SHARPNESS, STATURE, Person
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
    doubted = shaken(names(), forest(*edges), count)
    assert doubted.confidence == pytest.approx(0.45)
    assert doubted.limbs == LIMBS
    assert "as likely wrong as right (confidence 0.45)" in doubted.doubt


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
    from kinesphere.skeleton.discovery import person as module

    only = Person(0, None, ((1, 2), (3, 4)), (), None, lengths=10, stature=STATURE)
    monkeypatch.setattr(module, "_readings", lambda *_: iter([only]))
    for margin in (0.0, 2.0, 10.0):
        cost = LIKELY * 10 - margin
        monkeypatch.setattr(module, "_judged", lambda _f, p, _n, cost=cost: replace(p, cost=cost))
        _, sure = module.find_person(None, (0, 1, 2, 3, 4))
        assert sure == pytest.approx(1 / (1 + np.exp(-margin / SHARPNESS)))
