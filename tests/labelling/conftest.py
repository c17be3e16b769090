"""Two people who wear the lower half of a layout: small enough to label in no time."""

from dataclasses import replace

import numpy as np
import pytest

from kinesphere.data import TopologicalModel
from kinesphere.labelling import built_in_model
from kinesphere.skeleton.statistics import marker_statistics
from kinesphere.synthetic import make_performance

LIMBS = ("pelvis", *(f"{s}_{x}" for s in ("left", "right") for x in ("thigh", "shank", "foot")))


def lower_body(model):
    """Return the model of pelvis and legs, without statistics."""
    segments = tuple(s for s in model.segments if s.name in LIMBS)
    labels = {x for s in segments for x in s.markers}
    return TopologicalModel(
        name="legs",
        segments=segments,
        joints=tuple(
            replace(j, landmarks=()) for j in model.joints if {j.parent, j.child} <= set(LIMBS)
        ),
        root="pelvis",
        required=tuple(x for s in segments for x in s.markers),
        mirror=tuple(pair for pair in model.mirror if set(pair) <= labels),
    )


def actor(seed, labels):
    """Return the recording of an actor who moves freely, markers in this order."""
    made = make_performance(
        np.random.default_rng(seed), layout="cmu41", calibration_s=20.0, free_s=12.0, rate=50.0
    ).recording
    return replace(made, markers=made.markers[:, made.columns(labels)], labels=labels)


@pytest.fixture(scope="session")
def legs():
    """Return (model learnt from two people, a recording of a third)."""
    plain = lower_body(built_in_model("cmu41"))
    others = [actor(seed, plain.labels) for seed in (11, 12)]
    learnt = tuple(
        marker_statistics(one, plain.labels, f"actor {i}") for i, one in enumerate(others)
    )
    return replace(plain, statistics=learnt), actor(13, plain.labels)
