"""``python -m benchmarks.speed``: seconds and microseconds a frame, stage by stage."""

import argparse
import json
import platform
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np

from kinesphere import __version__
from kinesphere.data import Solution, motion_from_parameters
from kinesphere.io import read, write, write_solution
from kinesphere.pipeline import solve
from kinesphere.synthetic import Performance, make_performance, spoil_with_noise
from kinesphere.synthetic.layout import Layout

ROOT = Path(__file__).parents[2]
LAYOUTS: tuple[Layout, ...] = ("bodies", "cmu41")
_TITLES = {"bodies": "12 marker bodies", "cmu41": "CMU layout, built-in model"}


def main() -> int:
    """Time the line and write ``speed.json`` and ``speed.md``."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--frames", type=int, default=24_000)
    parser.add_argument("--repeats", type=int, default=3, help="the fastest counts")
    arguments = parser.parse_args()
    results = {
        "version": __version__,
        "python": platform.python_version(),
        "numpy": np.__version__,
        "n_frames": arguments.frames,
        "import_s": _import_seconds(),
        "layouts": {
            layout: _layout_seconds(layout, arguments.frames, arguments.repeats)
            for layout in LAYOUTS
        },
    }
    text = page(results)
    print(text)
    for folder in ("benchmarks/results", "docs/results"):
        (ROOT / folder).mkdir(parents=True, exist_ok=True)
    (ROOT / "docs/results/speed.md").write_text(text, encoding="utf-8")
    (ROOT / "benchmarks/results/speed.json").write_text(
        json.dumps(results, indent=1) + "\n", encoding="utf-8"
    )
    return 0


def page(results: dict[str, Any]) -> str:
    """Return the results as Markdown."""
    n_frames, layouts = results["n_frames"], results["layouts"]
    steps = list(next(iter(layouts.values()))["seconds"])
    heads = " | ".join(f"{_TITLES[name]}, s | µs a frame" for name in layouts)
    lines = [
        "# Speed",
        "",
        "Written by `make bench` (`python -m benchmarks.speed`) into",
        f"`benchmarks/results/speed.json`. A synthetic performance of {n_frames:,} frames with",
        f"1 mm noise; Python {results['python']}, NumPy {results['numpy']}, one BLAS thread,",
        "kernels compiled before. The fastest of a few runs on a machine with other work to do:",
        "read the figures as upper bounds. `import kinesphere` with everything `solve` needs takes",
        f"{results['import_s']:.1f} s.",
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
    return "\n".join(lines) + "\n"


def _layout_seconds(layout: Layout, n_frames: int, repeats: int) -> dict[str, Any]:
    generator = np.random.default_rng(0)
    warm = make_performance(generator, layout=layout, calibration_s=20, free_s=5)
    _solve(warm)  # compiles the kernels
    make, performance = _fastest(
        lambda: make_performance(np.random.default_rng(1), layout=layout, n_frames=n_frames),
        repeats,
    )
    recording = spoil_with_noise(performance.recording, generator)
    solved: list[tuple[float, Solution]] = []
    for _ in range(repeats):
        start = time.perf_counter()
        model = performance.model if layout == "bodies" else None
        solution = solve(recording, model, calibration=performance.calibration)
        solved.append((time.perf_counter() - start, solution))
    line_s, solution = min(solved, key=lambda pair: pair[0])
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "recording.c3d"
        written, _ = _fastest(lambda: write(recording, path), repeats)
        reading, _ = _fastest(lambda: read(path), repeats)
        saved, _ = _fastest(lambda: write_solution(solution, Path(folder) / "solved"), 1)
    rebuilt, _ = _fastest(lambda: motion_from_parameters(solution.parameters), repeats)
    seconds = {
        "make the performance": make,
        "write C3D": written,
        "read C3D": reading,
        **dict(solution.seconds),
        "parameters back to motion": rebuilt,
        "write the solved folder": saved,
    }
    return {
        "n_markers": recording.n_markers,
        "n_limbs": len(solution.skeleton.limbs),
        "line_s": line_s,
        "seconds": seconds,
    }


def _solve(performance: Performance) -> Solution:
    return solve(performance.recording, performance.model, calibration=performance.calibration)


def _fastest(call: Callable[[], Any], repeats: int) -> tuple[float, Any]:
    best, result = np.inf, None
    for _ in range(repeats):
        start = time.perf_counter()
        result = call()
        best = min(best, time.perf_counter() - start)
    return float(best), result


def _import_seconds() -> float:
    command = [sys.executable, "-c", "import kinesphere.pipeline"]
    return _fastest(lambda: subprocess.run(command, check=True), 2)[0]


sys.exit(main())
