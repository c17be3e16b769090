"""``python -m benchmarks.accuracy.real``: checks on recordings whose truth nobody knows.

Bones of both sides are about equally long, knees bend backward and elbows forward, and markers lie
where skeleton and parameters put them.
"""

import argparse
import json
import os
import sys
import time
from collections.abc import Iterator
from dataclasses import asdict, dataclass
from pathlib import Path

import numpy as np

from kinesphere import __version__, read
from kinesphere.data import Solution, motion_from_parameters
from kinesphere.errors import KinesphereError
from kinesphere.pipeline import solve

ROOT = Path(__file__).parents[2]
FOLDERS = ("cmu41", "plugin-gait", "functional")
PAIRED = ("upper_arm", "forearm", "thigh", "shank")
HINGES = {"knee": -1.0, "elbow": 1.0}
"""Joint → which way along the body's x the next limb goes when it bends."""
_BENT = np.deg2rad(25.0)  # from which a hinge counts as bent


@dataclass(frozen=True)
class RealRow:
    """One recording, solved."""

    recording: str
    failure: str = ""
    model: str = ""
    n_frames: int = 0
    seconds: float = np.nan
    sides_percent: dict[str, float] | None = None
    """Limb → how much longer the left one is than the mean of both."""
    bends_percent: dict[str, float] | None = None
    """Joint → share of the frames in which it is bent that it is bent the anatomical way."""
    rebuilt_mm: float = np.nan
    """Median over all samples of the distance of markers to where the parameters put them."""
    n_warnings: int = 0


def real_rows(folder: Path) -> Iterator[RealRow]:
    """Solve every full-body recording of a folder of real ones."""
    for name in FOLDERS:
        for path in sorted((folder / name).glob("*.c3d")):
            yield _row(f"{name}/{path.name}", path)


def _row(name: str, path: Path) -> RealRow:
    start = time.perf_counter()
    try:
        solution = solve(read(path))
    except KinesphereError as error:
        return RealRow(name, failure=f"{type(error).__name__}: {error}")
    return RealRow(
        recording=name,
        model=solution.model_name,
        n_frames=solution.motion.n_frames,
        seconds=time.perf_counter() - start,
        sides_percent=_sides(solution),
        bends_percent=_bends(solution),
        rebuilt_mm=_rebuilt(solution),
        n_warnings=len(solution.warnings),
    )


def _sides(solution: Solution) -> dict[str, float]:
    lengths = {limb.name: limb.length for limb in solution.skeleton.limbs}
    differences = {}
    for kind in PAIRED:
        left, right = lengths.get(f"left_{kind}", np.nan), lengths.get(f"right_{kind}", np.nan)
        if np.isfinite(left + right):
            differences[kind] = 200 * (left - right) / (left + right)
    return differences


def _bends(solution: Solution) -> dict[str, float]:
    """From the poses alone: where the next limb points, seen from the normalized one before."""
    skeleton = solution.skeleton
    relative = solution.motion.relative_rotations()
    shares = {}
    for j, joint in enumerate(skeleton.joints):
        forward = HINGES.get(joint.name.partition("_")[2])
        if forward is None:
            continue
        points = relative[:, j] @ skeleton.limbs[j + 1].long_axis
        along = points @ skeleton.limb(joint.parent).long_axis
        bent = np.arccos(np.clip(along, -1, 1)) > _BENT
        if bent.any():
            shares[joint.name] = 100 * float((points[bent, 0] * forward > 0).mean())
    return shares


def _rebuilt(solution: Solution) -> float:
    placed = motion_from_parameters(solution.parameters).marker_positions()
    labels = tuple(placed)
    columns = solution.recording.columns(labels)
    there = np.stack([placed[label] for label in labels], axis=1)
    off = np.linalg.norm(solution.recording.markers[:, columns] - there, axis=2)
    return 1e3 * float(np.nanmedian(off))


def page(rows: list[RealRow]) -> str:
    """Return the results as Markdown."""
    lines = [
        "# Real recordings",
        "",
        "Written by `python -m benchmarks.accuracy.real`; the numbers are in",
        "`benchmarks/results/real.json`. Nobody knows the truth of these recordings, so three",
        "things are looked at that it cannot contradict: *sides*, the difference of left and",
        "right segment length in percent of their mean; *bends*, the share of frames with a knee",
        "or elbow bent by more than 25° in which it bends the anatomical way (least of the four);",
        "*rebuilt*, the median distance of a marker to where skeleton and parameters put it.",
        "",
        "| recording | model | frames | " + " | ".join(k.replace("_", " ") for k in PAIRED)
        + " | bends | rebuilt | warnings |",
        "|---|---|---:|" + "---:|" * (len(PAIRED) + 3),
    ]  # fmt: skip
    for row in rows:
        if row.failure:
            empty = " – |" * (len(PAIRED) + 2)
            lines.append(f"| {row.recording} | {row.failure} | – |{empty} – |")
            continue
        sides = row.sides_percent or {}
        bends = min((row.bends_percent or {}).values(), default=np.nan)
        cells = [f"{sides[k]:+.1f} %" if k in sides else "–" for k in PAIRED]
        cells.append(f"{bends:.0f} %" if np.isfinite(bends) else "–")
        cells.append(f"{row.rebuilt_mm:.1f} mm")
        lines.append(
            f"| {row.recording} | {row.model} | {row.n_frames} | "
            + " | ".join(cells)
            + f" | {row.n_warnings} |"
        )
    return "\n".join(lines) + "\n"


def main() -> int:
    """Solve what there is and write ``real.json`` and ``real.md``."""
    parser = argparse.ArgumentParser(description=__doc__)
    default = os.environ.get("KINESPHERE_DATA", ROOT.parent / "shared" / "data")
    parser.add_argument("folder", type=Path, nargs="?", default=Path(default))
    folder = parser.parse_args().folder
    if not folder.is_dir():
        print(f"no real recordings at {folder}; name their folder", file=sys.stderr)
        return 2
    rows = []
    for row in real_rows(folder):
        rows.append(row)
        print(f"{row.recording}: {row.failure or f'{row.seconds:.1f} s'}", file=sys.stderr)
    text = page(rows)
    print(text)
    (ROOT / "docs" / "results").mkdir(parents=True, exist_ok=True)
    (ROOT / "docs" / "results" / "real.md").write_text(text, encoding="utf-8")
    kept = [
        {
            key: (None if isinstance(value, float) and np.isnan(value) else value)
            for key, value in asdict(row).items()
            if key != "seconds"  # differs from run to run
        }
        for row in rows
    ]
    (ROOT / "benchmarks" / "results" / "real.json").write_text(
        json.dumps({"version": __version__, "recordings": kept}, allow_nan=False, indent=1) + "\n",
        encoding="utf-8",
    )
    return 0


if __name__ == "__main__":
    sys.exit(main())
