"""Lengths in words."""

import pytest

from kinesphere.geometry.in_words import in_millimetres


@pytest.mark.parametrize(
    ("metres", "told"),
    [
        (0.0, "0 mm"),
        (0.0214, "21 mm"),
        (0.001, "1 mm"),
        (0.00042, "0.42 mm"),
        (-0.00042, "-0.42 mm"),
        (3e-6, "0.003 mm"),
        (9.999, "9999 mm"),
        (1418.134, "1.42e+06 mm"),
    ],
)
def test_small_and_large_lengths_keep_their_digits(metres, told):
    assert in_millimetres(metres) == told
