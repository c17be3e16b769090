"""Numbers and findings as people read them."""

import numpy as np
import pytest

from kinesphere.report import counted, finding_in_words, number_in_words, rms, unique


@pytest.mark.parametrize(
    ("value", "unit", "text"),
    [
        (1.25, "mm", "1.25 mm"),
        (12.34, "mm", "12.3 mm"),
        (123.4, "mm", "123 mm"),
        (12345.6, "mm", "12346 mm"),
        (0.5, "°", "0.5°"),
        (0.0123, "s", "0.012 s"),
        (1e-9, "mm", "< 0.001 mm"),
        (-1e-9, "mm", "< 0.001 mm"),
        (0.0, "mm", "0 mm"),
        (-2.5, "°", "-2.5°"),
        (7, "", "7"),
        (2.0, "", "2"),
        (float("nan"), "mm", "–"),
        (None, "mm", "–"),
    ],
)
def test_numbers(value, unit, text):
    assert number_in_words(value, unit) == text


@pytest.mark.parametrize(
    ("name", "value", "words"),
    [
        ("residual_rms_mm", 1.25, ("residual rms", "1.25 mm")),
        ("spread_max_deg", 4.0, ("spread max", "4°")),
        ("n_frames", 12, ("n frames", "12")),
        ("mirrored", False, ("mirrored", "no")),
        ("up_from", "body", ("up from", "body")),
        ("missing", [], ("missing", "none")),
        ("times_s", [1.0, 2.5], ("times", "1 s, 2.5 s")),
        ("scores", {"left_knee": 0.5}, ("scores", "left knee 0.5")),
        ("default_time_s", None, ("default time", "–")),
        ("labels", [str(i) for i in range(9)], ("labels", "0, 1, 2, 3, 4, 5 and 3 more")),
    ],
)
def test_findings(name, value, words):
    assert finding_in_words(name, value) == words


def test_rms_leaves_out_what_is_not_known():
    assert rms(np.array([3.0, np.nan, 4.0])) == pytest.approx(np.sqrt(12.5))
    assert np.isnan(rms(np.array([np.nan])))


def test_unique_keeps_the_order():
    assert unique(["b", "a", "b"]) == ["b", "a"]


@pytest.mark.parametrize(("n", "text"), [(0, "0 frames"), (1, "1 frame"), (1854, "1,854 frames")])
def test_one_is_not_many(n, text):
    assert counted(n, "frame") == text
