"""The demo: truth against estimate, and everything on disk."""

import json

import pytest

from kinesphere.cli.demo import show_truth
from kinesphere.synthetic import TruthRow

NEAR = {
    "joint centre": 0.1,  # mm
    "axis": 0.5,  # deg
    "angle, same conventions": 0.5,  # deg
    "twist, same conventions": 0.5,  # deg
    "markers": 0.1,  # mm
}
"""What the line promises without noise."""
NARROW = 110  # columns of a terminal that is not wide


@pytest.mark.slow
def test_demo_comes_near_the_truth(call, tmp_path):
    called = call("demo", "-o", tmp_path / "demo", "--json")
    assert called.code == 0, called.err
    truth = json.loads(called.out)["truth"]
    for measure, limit in NEAR.items():
        errors = [row["error"] for row in truth if row["measure"] == measure]
        assert errors
        assert max(errors) < limit, measure
    assert (tmp_path / "demo" / "report.html").is_file()


@pytest.mark.slow
def test_demo_in_words(call, tmp_path):
    called = call("demo", "-o", tmp_path / "demo", "--seed", 2)
    assert called.code == 0, called.err
    for words in ("Truth against estimate", "joint centre", "reconstruction", "Report:"):
        assert words in called.out
    joints = called.out.partition("Joints\n")[2].partition("\n\n")[0].splitlines()
    rows = [line for line in joints if " from movement" in line]
    assert len(rows) == 11  # none is broken into two lines
    assert max(map(len, rows)) <= NARROW


def test_truth_names_the_worst_and_counts_what_was_not_estimated(capsys):
    rows = [
        TruthRow("axes", "axis", "left_knee axis 1", 0.2, 0.2, "deg"),
        TruthRow("axes", "axis", "left_hip axis 1", 1.5, 1.5, "deg"),
        TruthRow("axes", "axis", "neck", float("nan"), float("nan"), "deg"),
        TruthRow("skeleton", "joint centre", "neck", float("nan"), float("nan"), "mm"),
    ]
    show_truth(rows)
    out = capsys.readouterr().out
    line = next(line for line in out.splitlines() if line.startswith("axes"))
    for words in ("2 of 3", "0.85°", "1.5°", "left_hip axis 1"):
        assert words in line
    assert "0 of 1" in out
