"""What is asked for, beside the kernels alone and the stages that hold them."""

import math
from dataclasses import replace
from typing import Any, TypeAlias

from benchmarks.axes.bars import Bar

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
