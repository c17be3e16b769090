"""A front for what has none."""

import numpy as np
from tests.skeleton.test_linked import arm, solved

from kinesphere.normalization import NormalizationSettings
from kinesphere.pipeline.motion_alone import normalized_somehow


def test_a_front_that_was_assumed_is_told_of_no_user():
    """An arm that leaves backward: two joints have no front, so +x is taken."""
    markers, _ = arm(np.random.default_rng(3), 0.02)  # which side its bodies face is chance
    markers[..., 0] -= 2.0 * np.arange(len(markers))[:, None] / 120
    motion = normalized_somehow(solved(markers), NormalizationSettings(), None)
    told = [text for step in motion.history for text in step.warnings]
    assert any("front that was assumed (+x) contradicts the body (walking" in text for text in told)
    assert not any("user" in text for text in told)
