"""People whose elbows never bend, or whose forearms have no markers."""

from dataclasses import replace

import numpy as np
import pytest

from kinesphere.skeleton import discover
from kinesphere.synthetic import make_performance, spoil_with_noise

SIDES = ("left", "right")


@pytest.fixture(scope="module")
def performance():
    return make_performance(np.random.default_rng(4), rate=25, calibration_s=40, free_s=20)


def found_of(recording):
    return discover(spoil_with_noise(recording, np.random.default_rng(4), deviation=0.001))


def with_straight_elbows(performance, sides):
    """Let forearms ride on their upper arms, as they lie where the elbow is straightest."""
    names, recording = performance.skeleton.limb_names, performance.recording
    markers, motion = recording.markers.copy(), performance.motion
    for side in sides:
        above, below = names.index(f"{side}_upper_arm"), names.index(f"{side}_forearm")
        turns, origins = motion.rotations[:, above], motion.origins[:, above]
        bend = np.einsum("fij,fij->f", turns, motion.rotations[:, below])
        straight = int(bend.argmax())
        for label in performance.skeleton.limbs[below].markers:
            column = recording.labels.index(label)
            local = turns[straight].T @ (markers[straight, column] - origins[straight])
            markers[:, column] = origins + turns @ local
    return replace(recording, markers=markers)


def limbs(found, performance):
    owner = {label: limb.name for limb in performance.skeleton.limbs for label in limb.markers}
    return {s.name: {owner[label] for label in s.markers} for s in found.model.segments}


@pytest.mark.parametrize("sides", [SIDES, ("left",), ("right",)])
def test_an_arm_whose_elbow_stays_straight_keeps_a_number_and_is_told(performance, sides):
    """It is neither an upper arm nor a forearm; everything else has its name."""
    found = found_of(with_straight_elbows(performance, sides))
    named = limbs(found, performance)
    arms = {frozenset((f"{side}_upper_arm", f"{side}_forearm")): side for side in sides}
    gone = set().union(*arms)
    whole = {limb.name: {limb.name} for limb in performance.skeleton.limbs}
    stiff = {limb: own for limb, own in named.items() if limb.startswith("limb_")}
    assert named == {limb: own for limb, own in whole.items() if limb not in gone} | stiff
    assert {frozenset(own) for own in stiff.values()} == set(arms)
    said = "; ".join(found.step.warnings)
    for limb, own in stiff.items():
        assert f"{limb} is the whole {arms[frozenset(own)]} arm: no bend shows" in said
    assert "could not be named" not in said


def without_forearms(performance):
    recording = performance.recording
    owner = {label: limb.name for limb in performance.skeleton.limbs for label in limb.markers}
    kept = [c for c, label in enumerate(recording.labels) if "forearm" not in owner[label]]
    return replace(
        recording,
        markers=np.ascontiguousarray(recording.markers[:, kept]),
        labels=tuple(recording.labels[c] for c in kept),
    )


def test_an_upper_arm_without_a_forearm_is_one_and_nothing_is_said(performance):
    found = found_of(without_forearms(performance))
    named = limbs(found, performance)
    assert all(own == {limb} for limb, own in named.items())
    assert {f"{side}_upper_arm" for side in SIDES} <= set(named)
    assert not [doubt for doubt in found.step.warnings if "no bend shows" in doubt]
    assert not [doubt for doubt in found.step.warnings if "could not be named" in doubt]


@pytest.mark.parametrize("seed", [621, 623])
def test_an_arm_that_cannot_be_named_is_told(seed):
    """Upper arms of a length between; 623 has one that is not even taken for an arm."""
    rng = np.random.default_rng(seed)
    performance = make_performance(rng, rate=25, calibration_s=40, free_s=20)
    found = found_of(without_forearms(performance))
    numbers = [limb for limb in limbs(found, performance) if limb.startswith("limb_")]
    assert numbers
    (told,) = (doubt for doubt in found.step.warnings if "could not be named" in doubt)
    assert ", ".join(numbers) in told
