"""Bodies that have not moved against each other yet are told."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from kinesphere.skeleton import discover
from kinesphere.skeleton.discovery.forest import Edge
from kinesphere.skeleton.discovery.stillness import still_pairs
from kinesphere.synthetic import HAND, make_performance, spoil_with_noise


def test_fingers_that_have_not_bent_yet_are_told_and_bent_ones_are_not():
    """A hand's joints bend one after the other: in the first seconds most have not."""
    performance = make_performance(np.random.default_rng(2), plan=HAND, n_frames=24_000)
    whole = spoil_with_noise(performance.recording, np.random.default_rng(3), deviation=0.0002)
    n = int(15 * whole.rate)
    begun = replace(whole, markers=np.ascontiguousarray(whole.markers[:n]), residuals=None)
    (told,) = (doubt for doubt in discover(begun).step.warnings if "may be one body" in doubt)
    assert "number of bodies is in doubt" in told
    assert not [doubt for doubt in discover(whole).step.warnings if "may be one body" in doubt]


def test_a_person_who_moves_every_joint_has_none(recorded):
    assert not [d for d in discover(recorded).step.warnings if "may be one body" in d]


@pytest.mark.parametrize(("between", "still"), [(1.4, True), (1.6, False), (np.nan, False)])
def test_pairs_wander_less_than_one_and_a_half_times_what_bodies_do(between, still):
    """Two bodies of three and two markers; nothing is known of a pair that is never seen."""
    bodies = (np.arange(3), np.arange(3, 5))
    wander = np.full((5, 5), 0.001 * between)
    wander[:3, :3], wander[3:, 3:] = 0.001, 0.0004  # the less steady one counts
    np.fill_diagonal(wander, 0.0)
    partition = SimpleNamespace(
        rigidity=SimpleNamespace(wander=wander),
        bodies=bodies,
        forest=SimpleNamespace(edges=(Edge(1, 0, 0.001, np.inf),)),
        usual=0.0005,
    )
    assert still_pairs(partition) == ({(1, 0)} if still else set())


def test_limbs_of_two_markers_taken_together_are_told():
    performance = make_performance(np.random.default_rng(1), n_frames=4000)
    recording = spoil_with_noise(performance.recording, np.random.default_rng(1), deviation=0.001)
    kept: list[int] = []
    for limb in performance.skeleton.limbs:
        few = limb.markers if limb.name == "trunk" else limb.markers[:2]
        kept += [recording.labels.index(label) for label in few]
    found = discover(
        replace(
            recording,
            markers=np.ascontiguousarray(recording.markers[:, kept]),
            labels=tuple(recording.labels[c] for c in kept),
        )
    )
    assert len(found.model.segments) < len(performance.skeleton.limbs)
    (told,) = (doubt for doubt in found.step.warnings if "markers move apart within" in doubt)
    within = found.step.findings["bodies"]
    assert {limb for limb in within if limb in told} == {
        limb for limb, body in within.items() if body["within_mm"] > 20
    }
