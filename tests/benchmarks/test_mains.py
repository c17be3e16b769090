"""Importing a benchmark measures nothing; pages say what their figures say."""

import ast
import json
from pathlib import Path

import numpy as np
import pytest
from benchmarks.speed.asked import asked
from benchmarks.speed.given_axes import given_axes
from benchmarks.speed.page import page

from kinesphere.parameterization import stage
from kinesphere.synthetic import make_performance

ROOT = Path(__file__).parents[2]
MODULES = sorted((ROOT / "benchmarks").rglob("*.py"))
SPEED = json.loads((ROOT / "benchmarks" / "results" / "speed.json").read_text(encoding="utf-8"))


@pytest.mark.parametrize("module", MODULES, ids=lambda path: str(path.relative_to(ROOT)))
def test_nothing_is_called_but_by_who_runs_it(module):
    """A bare call at the top of a module runs on import, in worker processes and tests, too."""
    tree = ast.parse(module.read_text(encoding="utf-8"))
    bare = [n for n in tree.body if isinstance(n, ast.Expr) and isinstance(n.value, ast.Call)]
    assert [ast.unparse(node) for node in bare] == []
    if module.name == "__main__.py":
        last = tree.body[-1]
        assert ast.unparse(last).startswith("if __name__ == '__main__':")


def test_the_speed_page_is_what_was_measured():
    written = (ROOT / "docs" / "results" / "speed.md").read_text(encoding="utf-8")
    assert written == page(SPEED)


@pytest.mark.parametrize(
    ("figure", "what", "at"),
    [
        ("two_axes_and_twist_us", "two axes and twist, a frame", 10.0),
        ("propagation_us", "normalization, a frame", 2.0),
        ("rigid_fits_us", "rigid fits, a frame", 15.0),
        ("calibration_s", "calibration of all joints", 0.5),
    ],
)
def test_a_figure_is_met_up_to_what_is_asked_and_missed_beyond(figure, what, at):
    for value, verdict in ((at, "met"), (1.01 * at, "**missed**")):
        slower = {**SPEED, "paper": {**SPEED["paper"], figure: value}}
        (row,) = (line for line in asked(slower) if line.startswith(f"| {what} |"))
        kernels = row.split("|")[3]
        assert kernels.strip().endswith(f", {verdict}")


def test_stages_are_held_against_the_same_numbers():
    n_frames = SPEED["n_frames"]
    bodies = SPEED["layouts"]["bodies"]
    seconds = dict.fromkeys(bodies["seconds"], 1e-6 * n_frames)  # 1 µs a frame
    fast = {**bodies, "line_s": 1.6, "seconds": seconds}
    rows = asked({**SPEED, "layouts": {**SPEED["layouts"], "bodies": fast}})
    last = {r.split("|")[1].strip(): r.split("|")[5].strip() for r in rows if r.count("|") == 6}
    assert last["two axes and twist, a frame"] == "1.00 µs, met"
    assert last["normalization, a frame"] == "1.00 µs, met"
    assert last["calibration of all joints"].endswith("s, met")
    assert last["the whole line in memory"] == "1.60 s, **missed**"
    twin = SPEED["paper"]["twin_two_axes_and_twist_us"]
    assert last["two axes and twist, times as fast as the twin"].startswith(f"{twin:.3g}, met")


def test_growth_is_told_by_the_longest_recording_and_a_tenth_of_it():
    rows = [
        {"n_frames": n, "line_s": 30e-6 * n + 1e-12 * n**2, "extra_bytes": 310 * n, "seconds": {}}
        for n in (1_000, 100_000, 1_000_000)
    ]
    told = " ".join(asked({**SPEED, "growth": rows}))
    assert "31.0 µs a frame at 1,000,000 frames, 30.1 at 100,000" in told
    assert "310 bytes a frame there and 310 here, 10% of what these hold" in told


@pytest.mark.parametrize(("value", "verdict"), [(10.0, "met"), (10.1, "**missed**")])
def test_parameterization_is_told_without_its_calibration_too(value, verdict):
    """Beside the whole stage, where it was measured; no kernel alone answers to it."""
    measured = {**SPEED, "paper": {**SPEED["paper"], "given_axes_us": value}}
    rows = [line for line in asked(measured) if "without its calibration" in line]
    assert [row.split("|")[3].strip() for row in rows] == ["–"]
    assert rows[0].split("|")[5].strip().endswith(f", {verdict}")
    unmeasured = {k: v for k, v in SPEED["paper"].items() if k != "given_axes_us"}
    assert not any("without its" in line for line in asked({**SPEED, "paper": unmeasured}))


def test_axes_that_are_given_are_found_once(monkeypatch):
    performance = make_performance(np.random.default_rng(3), calibration_s=12, free_s=2)
    motion, calibration = performance.motion, performance.calibration
    looked_for = []
    find = stage.own_or_reused

    def watched(view, *others, **options):
        looked_for.append(view.name)
        return find(view, *others, **options)

    monkeypatch.setattr(stage, "own_or_reused", watched)
    run = given_axes(motion, calibration)
    run()
    assert sorted(looked_for) == sorted(motion.skeleton.joint_names)
    assert stage.own_or_reused is watched
