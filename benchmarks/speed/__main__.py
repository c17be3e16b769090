"""``python -m benchmarks.speed``: against the paper, stage by stage, and as recordings grow."""

import argparse
import json
import platform
import subprocess
import sys
import tempfile
from pathlib import Path
from typing import Any

import numpy as np

from benchmarks.speed.clock import StageClock, median_seconds
from benchmarks.speed.memory import extra_bytes
from benchmarks.speed.page import page
from benchmarks.speed.paper import paper_comparison
from kinesphere import __version__
from kinesphere.data import Recording, Solution, motion_from_parameters
from kinesphere.io import read, write, write_solution
from kinesphere.pipeline import solve
from kinesphere.synthetic import Performance, make_performance, spoil_with_noise
from kinesphere.synthetic.layout import Layout

ROOT = Path(__file__).parents[2]
RESULTS = ROOT / "benchmarks" / "results" / "speed.json"
PAGE = ROOT / "docs" / "results" / "speed.md"
LAYOUTS: tuple[Layout, ...] = ("bodies", "cmu41")
GROWTH = (1_000, 3_000, 10_000, 30_000, 100_000, 300_000, 1_000_000)


def main() -> int:
    """Time everything and write ``speed.json`` and ``speed.md``."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--frames", type=int, default=24_000)
    parser.add_argument("--twin-frames", type=int, default=400)
    parser.add_argument("--repeats", type=int, default=3, help="runs, of which the median counts")
    parser.add_argument(
        "--page", action="store_true", help="measure nothing, write the page of the last figures"
    )
    arguments = parser.parse_args()
    if arguments.page:
        results = json.loads(RESULTS.read_text(encoding="utf-8"))
    else:
        results = _measured(arguments.frames, arguments.twin_frames, arguments.repeats)
    text = page(results)
    print(text)
    for path in (RESULTS, PAGE):
        path.parent.mkdir(parents=True, exist_ok=True)
    PAGE.write_text(text, encoding="utf-8")
    RESULTS.write_text(json.dumps(results, indent=1) + "\n", encoding="utf-8")
    return 0


def _measured(n_frames: int, twin_frames: int, repeats: int) -> dict[str, Any]:
    layouts, paper = {}, {}
    for layout in LAYOUTS:
        performance, recording = _performance(layout, n_frames)
        layouts[layout], solution = _line(performance, recording, layout, repeats)
        if layout == "bodies":
            paper = paper_comparison(performance, solution, twin_frames, 3 * repeats)
    return {
        "version": __version__,
        "python": platform.python_version(),
        "numpy": np.__version__,
        "n_frames": n_frames,
        "import_s": _import_seconds(),
        "paper": paper,
        "layouts": layouts,
        "growth": [_growth(n) for n in GROWTH],
    }


def _performance(layout: Layout, n_frames: int) -> tuple[Performance, Recording]:
    warm = make_performance(np.random.default_rng(0), layout=layout, calibration_s=20, free_s=5)
    _solve(warm, warm.recording, layout)  # compiles the kernels
    performance = make_performance(np.random.default_rng(1), layout=layout, n_frames=n_frames)
    return performance, spoil_with_noise(performance.recording, np.random.default_rng(2))


def _line(
    performance: Performance, recording: Recording, layout: Layout, repeats: int
) -> tuple[dict[str, Any], Solution]:
    line_s, stages, solution = _median_line(performance, recording, layout, repeats)
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "recording.c3d"
        written, _ = median_seconds(lambda: write(recording, path), repeats)
        reading, _ = median_seconds(lambda: read(path), repeats)
        saved, _ = median_seconds(lambda: write_solution(solution, Path(folder) / "solved"), 1)
    rebuilt, _ = median_seconds(lambda: motion_from_parameters(solution.parameters), repeats)
    seconds = {
        "read C3D": reading,
        **stages,
        "parameters back to motion": rebuilt,
        "write C3D": written,
        "write the solved folder": saved,
    }
    shown = {
        "n_markers": recording.n_markers,
        "n_limbs": len(solution.skeleton.limbs),
        "line_s": line_s,
        "seconds": seconds,
    }
    return shown, solution


def _growth(n_frames: int) -> dict[str, Any]:
    performance = make_performance(
        np.random.default_rng(3), rate=50.0, calibration_s=20.0, n_frames=n_frames
    )
    recording = spoil_with_noise(performance.recording, np.random.default_rng(4))
    repeats = 3 if n_frames <= 10_000 else 1
    line_s, stages, _ = _median_line(performance, recording, "bodies", repeats)
    extra = extra_bytes(lambda: _solve(performance, recording, "bodies"))
    return {"n_frames": n_frames, "line_s": line_s, "seconds": stages, "extra_bytes": extra}


def _median_line(
    performance: Performance, recording: Recording, layout: Layout, repeats: int
) -> tuple[float, dict[str, float], Solution]:
    """Return the median seconds of the line and of each stage, and a solution."""
    clocks = []

    def run() -> Solution:
        clocks.append(StageClock())
        solution = _solve(performance, recording, layout, clocks[-1])
        clocks[-1].stop()
        return solution

    line_s, solution = median_seconds(run, repeats)
    stages = {
        stage: float(np.median([clock.seconds[stage] for clock in clocks]))
        for stage in clocks[0].seconds
    }
    return line_s, stages, solution


def _solve(
    performance: Performance,
    recording: Recording,
    layout: Layout,
    clock: StageClock | None = None,
) -> Solution:
    model = performance.model if layout == "bodies" else None
    return solve(recording, model, calibration=performance.calibration, progress=clock)


def _import_seconds() -> float:
    """Return the processor time a new process takes to import what ``solve`` needs, in s."""
    program = "import time, kinesphere.pipeline; print(time.process_time())"
    command = [sys.executable, "-c", program]
    runs = [subprocess.run(command, check=True, capture_output=True, text=True) for _ in range(3)]
    return float(np.median([float(run.stdout) for run in runs]))


if __name__ == "__main__":
    sys.exit(main())
