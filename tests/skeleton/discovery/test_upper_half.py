"""People whose legs have no markers, and what must not be taken for them."""

from dataclasses import replace

import numpy as np
import pytest

from kinesphere.skeleton import discover
from kinesphere.synthetic import HUMAN, QUADRUPED, make_performance, spoil_with_noise

LEGS = ("thigh", "shank", "foot")


def half(seed, plan, without):
    """Return a recording without some limbs' markers, and which limb each label is of."""
    rng = np.random.default_rng(seed)
    made = make_performance(rng, plan=plan, rate=25, calibration_s=20, free_s=10)
    owner = [limb.name for limb in made.skeleton.limbs for _ in limb.markers]
    noisy = spoil_with_noise(made.recording, np.random.default_rng(seed), deviation=0.001)
    keep = [i for i, limb in enumerate(owner) if not any(part in limb for part in without)]
    labels = tuple(f"*{i}" for i in range(len(keep)))
    recording = replace(noisy, markers=np.array(noisy.markers[:, keep]), labels=labels)
    return recording, dict(zip(labels, (owner[i] for i in keep), strict=True))


def limbs(found, owner):
    return {s.name: {owner[label] for label in s.markers} for s in found.model.segments}


@pytest.mark.parametrize("seed", [100, 101, 103, 105])
def test_trunk_head_and_arms_are_named_with_their_sides(seed):
    recording, owner = half(seed, HUMAN, LEGS)
    found = discover(recording)
    assert limbs(found, owner) == {limb: {limb} for limb in set(owner.values())}
    assert found.step.findings["names_confidence"] > 0.7
    assert found.model.root == "trunk"
    assert any("may be an animal's fore half" in said for said in found.step.warnings)


def test_in_a_mirror_left_is_right():
    recording, owner = half(100, HUMAN, LEGS)
    mirrored = replace(recording, markers=recording.markers * [-1.0, 1.0, 1.0])
    other = {"left": "right", "right": "left"}
    for name, true in limbs(discover(mirrored), owner).items():
        side, _, kind = name.partition("_")
        assert true == {f"{other[side]}_{kind}" if side in other else name}


@pytest.mark.parametrize(
    ("seed", "plan", "without"),
    [
        (100, HUMAN, (*LEGS, "head")),  # four bodies in two chains are anybody's
        (101, HUMAN, ("arm", "foot")),  # legs without feet, and a head where the arms would be
        (0, QUADRUPED, ("hind",)),
        (1, QUADRUPED, ("hind",)),
        (0, QUADRUPED, ()),
    ],
)
def test_what_is_no_upper_half_is_numbered(seed, plan, without):
    recording, owner = half(seed, plan, without)
    assert all(name.startswith("limb_") for name in limbs(discover(recording), owner))


@pytest.mark.parametrize("unit", [0.1, 10.0])
def test_another_unit_is_told_by_the_arms(unit):
    recording, _ = half(100, HUMAN, LEGS)
    found = discover(replace(recording, markers=unit * recording.markers))
    assert any("arms of someone of" in doubt for doubt in found.step.warnings)
    assert found.unit == pytest.approx(unit)
