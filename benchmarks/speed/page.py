"""The results as a page."""

from typing import Any

from benchmarks.speed.asked import HELD_BYTES, asked
from benchmarks.speed.paper import PAPER_US

_TITLES = {"bodies": "12 marker bodies", "cmu41": "CMU layout, built-in model"}


def page(results: dict[str, Any]) -> str:
    """Return the results as Markdown."""
    parts = (_head, asked, _paper, _line, _growth)
    return "\n".join(line for part in parts for line in part(results)) + "\n"


def _head(results: dict[str, Any]) -> list[str]:
    return [
        "# Speed",
        "",
        "Written by `make bench` (`python -m benchmarks.speed`) into",
        "`benchmarks/results/speed.json`. Synthetic performances with 1 mm noise;",
        f"Python {results['python']}, NumPy {results['numpy']}, kernels compiled before.",
        "Processor time of a process with one thread, which other work on the machine disturbs",
        "least; medians of several runs. `import kinesphere` with everything `solve` needs takes",
        f"{results['import_s']:.1f} s.",
        "",
    ]


def _paper(results: dict[str, Any]) -> list[str]:
    found = results["paper"]
    ours, twin = found["two_axes_and_twist_us"], found["twin_two_axes_and_twist_us"]
    moved = found["propagation_us"]
    return [
        "## Against the paper",
        "",
        "Sar Dessai, Hornung & Kobbelt (2006, section 5) timed 24,000 frames on a computer of its",
        "day. So that methods and not computers are compared, the per-frame part of the paper is",
        "written down once more as it stands, in `benchmarks/speed/twin.py`: frame by frame, two",
        "circles intersected by solving for their common line, the candidate nearest to the frame",
        "before, the twist by 360 samples, these at least in one NumPy call.",
        f"It runs on {found['twin_frames']:,} of the frames in the same run.",
        f"Poses rebuilt from its parameters are {found['twin_differs_deg']:.2f}° from the measured",
        f"ones (95th percentile), from ours {found['differs_deg']:.2f}°.",
        f"All times are of {found['n_joints']} joints together.",
        "",
        "| step | Kinesphere | twin | paper, 2006 |",
        "|---|---:|---:|---:|",
        f"| two axes and twist, µs a frame | {ours:.1f} | {twin:,.0f} ({twin / ours:,.0f} ×) | "
        f"{PAPER_US['two axes and twist']:,.0f} ({PAPER_US['two axes and twist'] / ours:,.0f} ×) |",
        f"| normalized frames carried to all frames, µs a frame | {moved:.2f} | – | "
        f"{PAPER_US['normalization']} ({PAPER_US['normalization'] / moved:,.0f} ×) |",
        f"| rigid fits of all limbs, µs a frame | {found['rigid_fits_us']:.1f} | – | – |",
        f"| calibration: axes and rest of all joints, s | {found['calibration_s']:.2f} | – | – |",
        "",
        "These are kernels alone, on arrays in memory: relative rotations, angles and twists; a",
        "turn of every frame; a rigid fit a limb and frame; movement phases, axes, their halves",
        "and rest positions. Nothing is read or written, and nothing is judged but the axes.",
        "",
    ]


def _line(results: dict[str, Any]) -> list[str]:
    n_frames, layouts = results["n_frames"], results["layouts"]
    steps = list(next(iter(layouts.values()))["seconds"])
    heads = " | ".join(f"{_TITLES[name]}, s | µs a frame" for name in layouts)
    lines = [
        f"## The whole line on {n_frames:,} frames",
        "",
        "Stages as `kinesphere.solve` runs them: they also judge what they found, fill gaps, aid",
        "limbs by their joints, tell uncertainty, and build the containers. `parameterization` is",
        "calibration and all frames; section 7 of `docs/results/parameterization.md` times it and",
        "`normalization` on the true motion, without noise. The whole line is what happens in",
        "memory, from labelling to surface: no reading, no writing, no parameters back to motion.",
        "",
        f"| step | {heads} |",
        "|---|" + "---:|---:|" * len(layouts),
    ]
    for step in [*steps, "whole line"]:
        cells = []
        for layout in layouts.values():
            seconds = layout["line_s"] if step == "whole line" else layout["seconds"][step]
            cells.append(f"{seconds:.3f} | {1e6 * seconds / n_frames:.1f}")
        lines.append(f"| {step} | " + " | ".join(cells) + " |")
    return [*lines, ""]


def _growth(results: dict[str, Any]) -> list[str]:
    rows = results["growth"]
    stages = list(rows[0]["seconds"])
    recording, solution = HELD_BYTES
    lines = [
        "## Growth with the recording",
        "",
        "12 marker bodies at 50 Hz, the first 20 s calibration. Microseconds a frame that stay",
        "the same, or fall, mean that time grows no faster than the recording. Memory is the peak",
        "of what is allocated besides the recording and the solution, which hold "
        f"{recording:,} and",
        f"{solution:,} bytes a frame; most of it is the poses before normalization, beside those "
        "after it.",
        "",
        f"| frames | whole line, s | µs a frame | {' | '.join(stages)} | memory besides, MB |",
        "|---:|---:|---:|" + "---:|" * (len(stages) + 1),
    ]
    for row in rows:
        n = row["n_frames"]
        cells = " | ".join(f"{1e6 * row['seconds'][stage] / n:.1f}" for stage in stages)
        line, extra = row["line_s"], 1e-6 * row["extra_bytes"]
        lines.append(f"| {n:,} | {line:.2f} | {1e6 * line / n:.1f} | {cells} | {extra:,.0f} |")
    return lines
