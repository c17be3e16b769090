"""A person some of whose limbs have no markers: what is there is named, and rightly."""

from dataclasses import replace

import numpy as np
import pytest

from kinesphere.skeleton import discover
from kinesphere.synthetic import make_performance, spoil_with_noise


@pytest.mark.slow
@pytest.mark.parametrize("seed", [1, 2])
@pytest.mark.parametrize("left_out", [("foot",), ("foot", "head")])
def test_without_feet_a_shank_ends_at_a_marker_and_all_limbs_are_named(seed, left_out):
    """A third of a shank's length is missing there, and nobody was seen at all."""
    made = make_performance(np.random.default_rng(seed), calibration_s=40, free_s=20)
    limbs = [limb.name for limb in made.skeleton.limbs for _ in limb.markers]
    keep = [i for i, limb in enumerate(limbs) if not limb.endswith(left_out)]
    rng = np.random.default_rng(3)
    noisy = spoil_with_noise(made.recording, rng, deviation=0.001)
    recording = replace(
        noisy,
        markers=np.ascontiguousarray(noisy.markers[:, keep]),
        labels=tuple(noisy.labels[i] for i in keep),
    )
    owner = dict(zip(noisy.labels, limbs, strict=True))
    found = discover(recording)
    for segment in found.model.segments:
        assert {owner[label] for label in segment.markers} == {segment.name}
