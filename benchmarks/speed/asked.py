"""What is asked for, beside the kernels alone and the stages that hold them."""

import math
from dataclasses import replace
from typing import Any, TypeAlias

from benchmarks.axes.bars import Bar

HELD_BYTES = (1_200, 1_900)
"""A frame, by a recording of 12 marker bodies and by its solution."""

_Row: TypeAlias = tuple[Bar, str, Bar]


def asked(results: dict[str, Any]) -> list[str]:
    """Return the table of what is asked for, as lines of Markdown."""
    rows = [
        f"| {bar.what} | {bar.asked} | {_told(bar)} | {stage} | {_told(whole)} |"
        for bar, stage, whole in _rows(results)
    ]
    return [
        "## What is asked",
        "",
        f"12 marker bodies with {results['paper']['n_joints']} joints, {results['n_frames']:,} "
        "frames, kernels and stages in one run.",
        "What is asked is what those steps take that the paper timed, so the kernels answer to it.",
        "Beside each is the whole stage that a user waits for, against the same number: it holds",
        "the kernel and much more (both are described below).",
        "",
        "| figure | asked | kernels alone | stage | as a whole |",
        "|---|---:|---:|---|---:|",
        *rows,
        "",
        *_growth(results),
        "",
    ]


def _growth(results: dict[str, Any]) -> list[str]:
    """Return how time and memory grow from a tenth of the longest recording to all of it."""
    longest = max(results["growth"], key=lambda row: row["n_frames"])
    tenth = min(results["growth"], key=lambda row: abs(row["n_frames"] - longest["n_frames"] / 10))
    us, before = (1e6 * row["line_s"] / row["n_frames"] for row in (longest, tenth))
    extra, extra_before = (row["extra_bytes"] / row["n_frames"] for row in (longest, tenth))
    return [
        "Growth is asked to be linear up to a million frames, with bounded extra memory. The line",
        f"takes {us:.1f} µs a frame at {longest['n_frames']:,} frames, {before:.1f} at "
        f"{tenth['n_frames']:,}. What it holds besides",
        f"recording and solution is {extra:,.0f} bytes a frame there and {extra_before:,.0f} here, "
        f"{extra / sum(HELD_BYTES):.0%} of what these hold",
        "themselves: bounded by them, not by a number that is the same for any length.",
    ]


def _rows(results: dict[str, Any]) -> list[_Row]:
    """Return what is asked of each kernel, the stage it is in, and the same asked of that."""
    kernels, line = results["paper"], results["layouts"]["bodies"]
    seconds, n_frames = line["seconds"], results["n_frames"]

    def row(what: str, value: float, unit: str, limit: float, stage: str) -> _Row:
        scale = 1e6 / n_frames if unit == "µs" else 1.0
        bar = Bar("speed", what, value, unit, limit)
        return bar, stage, Bar("speed", what, scale * seconds[stage], unit, limit)

    ours, twin = kernels["two_axes_and_twist_us"], kernels["twin_two_axes_and_twist_us"]
    ratio = "two axes and twist, times as fast as the twin"
    stage_us = 1e6 * seconds["parameterization"] / n_frames
    given = Bar(
        "speed",
        "two axes and twist without calibration, a frame",
        kernels.get("given_axes_us", float("nan")),  # pages of before have none
        "µs",
        10.0,
    )
    line_bar = Bar("speed", "the whole line in memory", line["line_s"], "s", 1.5)
    rows = [
        row("two axes and twist, a frame", ours, "µs", 10.0, "parameterization"),
        row("normalization, a frame", kernels["propagation_us"], "µs", 2.0, "normalization"),
        row("rigid fits, a frame", kernels["rigid_fits_us"], "µs", 15.0, "skeleton"),
        row("calibration of all joints", kernels["calibration_s"], "s", 0.5, "parameterization"),
        (
            Bar("speed", ratio, twin / ours, "", 100.0, at_least=True),
            "parameterization",
            Bar("speed", ratio, twin / stage_us, "", 100.0, at_least=True),
        ),
        (Bar("speed", line_bar.what, float("nan"), "s", 1.5), "all of them", line_bar),
    ]
    if not math.isnan(given.value):
        stage_alone = "parameterization without its calibration"
        rows.insert(1, (replace(given, value=float("nan")), stage_alone, given))
    return rows


def _told(bar: Bar) -> str:
    return "–" if math.isnan(bar.value) else f"{bar.measured}, {bar.verdict}"
