"""``python -m benchmarks.axes``: run, print, write; with ``--check`` a missed bar fails."""

import argparse
import json
import multiprocessing
import os
import sys
import time
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any

from benchmarks.axes import (
    angles,
    doubts,
    estimators,
    filters,
    floor,
    free_motion,
    free_served,
    halves_alone,
    held,
    held_noise,
    normalization,
    one_wide,
    outlying,
    segments,
    solved,
    third_axis,
    times,
)
from benchmarks.axes.page import all_bars, page
from kinesphere import __version__

ROOT = Path(__file__).parents[2]
RESULTS = ROOT / "benchmarks" / "results" / "axes.json"
PAGE = ROOT / "docs" / "results" / "parameterization.md"
Run = Callable[[str, Callable[..., Any], Sequence[tuple[Any, ...]]], list[Any]]


def main() -> int:
    """Measure everything and write ``axes.json`` and ``parameterization.md``."""
    parser = argparse.ArgumentParser(description=__doc__)
    default = Path(os.environ.get("KINESPHERE_DATA", ROOT.parent / "shared" / "data"))
    parser.add_argument("--data", type=Path, default=default, help="folder of real recordings")
    parser.add_argument("--jobs", type=int, default=2, help="processes")
    parser.add_argument("--check", action="store_true", help="fail if a bar is missed")
    parser.add_argument(
        "--page", action="store_true", help="measure nothing, write the page of the last figures"
    )
    parser.add_argument(
        "--only",
        nargs="+",
        default=[],
        choices=[*SECTIONS, "times"],
        help="measure these sections, keep the last figures of the others",
    )
    arguments = parser.parse_args()
    found: dict[str, Any] = {}
    if arguments.page or arguments.only:
        found = json.loads(RESULTS.read_text(encoding="utf-8"))
        del found["version"], found["bars"]
    if not arguments.page:
        found |= measured(arguments.data, arguments.jobs, arguments.only)
        RESULTS.write_text(as_json(found), encoding="utf-8")
    text = page(found)
    print(text)
    PAGE.parent.mkdir(parents=True, exist_ok=True)
    PAGE.write_text(text, encoding="utf-8")
    missed = [bar for bar in all_bars(found) if not bar.met]
    return 1 if missed and arguments.check else 0


def measured(data: Path, jobs: int, only: Sequence[str] = ()) -> dict[str, Any]:
    """Run every section, or some, the times alone and last."""
    for name in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS"):
        os.environ.setdefault(name, "1")
    with multiprocessing.get_context("spawn").Pool(jobs) as pool:

        def run(name: str, task: Callable[..., Any], tasks: Sequence[tuple[Any, ...]]) -> list[Any]:
            start = time.perf_counter()
            results = pool.starmap(task, tasks, chunksize=1)
            print(f"{name}: {time.perf_counter() - start:.0f} s", file=sys.stderr, flush=True)
            return results

        found = measure(run, data, only)
    if "times" in (only or ("times",)):
        found["times"] = times.run()
    return found


SECTIONS: Mapping[str, Callable[[Run, Path], dict[str, Any]]] = {
    "solved": lambda run, data: solved.summary(
        run("real recordings", solved.run_real, solved.real_tasks(data)),
        run("synthetic performances", solved.run_synthetic, solved.SYNTHETIC_TASKS),
    ),
    "filter": lambda run, _: {"filter": filters.summary(run("filter", filters.run, filters.TASKS))},
    "segments": lambda run, data: {
        "segments": run("segments", segments.run, segments.trials(data)),
    },
    "alone": halves_alone.section,
    "normalization": lambda run, _: {
        "normalization": normalization.summary(
            run("normalization", normalization.run, normalization.TASKS)
        )
    },
    "angles": lambda run, _: {
        "angles": angles.summary(
            run("round trip", angles.run_round_trip, angles.TRIP_TASKS),
            run("branches", angles.run_branches, angles.BRANCH_TASKS),
            run("cross-talk", angles.run_cross_talk, angles.CROSS_TASKS),
            run("reach", angles.run_reach, angles.REACH_TASKS),
            run("twist", angles.run_twist, angles.TWIST_TASKS),
        )
    },
    "axes": lambda run, _: {
        "axes": estimators.summary(run("axes", estimators.run, estimators.TASKS))
    },
    "third": lambda run, _: {
        "third": third_axis.summary(run("third axis", third_axis.run, third_axis.TASKS))
    },
    "hinges": lambda run, _: {
        "hinges": outlying.summary(run("hinges", outlying.run, outlying.TASKS))
    },
    "one": lambda run, _: {
        "one": one_wide.summary(run("one wide axis", one_wide.run, one_wide.TASKS))
    },
    "free": lambda run, _: {
        "free": free_motion.summary(run("free motion", free_motion.run, free_motion.TASKS))
    },
    "served": free_served.section,
    "doubts": doubts.section,
    "floor": lambda run, _: {
        "floor": floor.summary(run("floor of free motion", floor.run, floor.TASKS))
    },
    "held": lambda run, _: {
        "held": held.summary(run("held by free motion", held.run, held.TASKS))
        | held.summary(
            run("held without rhythm", held_noise.run, held_noise.TASKS), held_noise.TASKS
        )
    },
}


def measure(run: Run, data: Path, only: Sequence[str] = ()) -> dict[str, Any]:
    """Run every section but the times, or only some."""
    found: dict[str, Any] = {}
    for name, section in SECTIONS.items():
        if name in (only or SECTIONS):
            found |= section(run, data)
    return found


def as_json(found: dict[str, Any]) -> str:
    """Return the figures as JSON, one line for each part of a section."""
    whole = {"version": __version__, "bars": [bar.as_json() for bar in all_bars(found)], **found}
    return _lines(_short(whole), depth=2) + "\n"


def _lines(value: Any, depth: int) -> str:
    """Return JSON with a line for each entry of the outer ``depth`` levels."""
    if depth and isinstance(value, dict) and value:
        names = [json.dumps(key, ensure_ascii=False) for key in value]
        parts = [_lines(item, depth - 1) for item in value.values()]
        entries = [f"{name}: {part}" for name, part in zip(names, parts, strict=True)]
        return "{\n" + ",\n".join(entries) + "\n}"
    if depth and isinstance(value, list) and value:
        return "[\n" + ",\n".join(_lines(item, depth - 1) for item in value) + "\n]"
    return json.dumps(value, allow_nan=False, ensure_ascii=False)


def _short(value: Any) -> Any:
    """Return figures without digits that mean nothing; null for no number."""
    if isinstance(value, dict):
        return {key: _short(item) for key, item in value.items()}
    if isinstance(value, list | tuple):
        return [_short(item) for item in value]
    if isinstance(value, float):
        return float(f"{value:.5g}") if value == value and abs(value) != float("inf") else None
    return value


if __name__ == "__main__":
    sys.exit(main())
