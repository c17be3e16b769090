"""Doubts about a default position are told in lengths that a person can place."""

import pytest

from kinesphere.normalization.doubts import doubts
from kinesphere.normalization.settings import NormalizationSettings

SPAN = 1.7  # m
TERMS = {"plane_distance_mm": 500.0, "speed_mm_per_s": 1418.0}


@pytest.mark.parametrize(
    ("times", "told"),
    [
        (1.0, ("the joints are 500 mm off their plane", "the body moves at 1418 mm/s")),
        (0.1, ("the joints are 50 mm off their plane", "the body moves at 142 mm/s")),
        *(
            (
                times,
                (
                    "the joints are 0.29 body spans off their plane",
                    "the body moves at 0.83 body spans/s",
                ),
            )
            for times in (1e-3, 1e3)
        ),
    ],
)
def test_lengths_of_no_body_are_told_in_body_spans(times, told):
    terms = {name: times * value for name, value in TERMS.items()}
    assert doubts(terms, NormalizationSettings(), times * SPAN) == told
