"""Sections 4 to 6 and 8 need solved recordings: synthetic ones and every usable real one."""

from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from benchmarks.axes import same_person
from benchmarks.axes.bends import bend_row
from benchmarks.axes.papers_metrics import joint_rows
from benchmarks.axes.repeatability import half_rows
from benchmarks.axes.vendor import vendor_rows
from kinesphere import read
from kinesphere.data import Recording, Solution, TopologicalModel
from kinesphere.errors import KinesphereError
from kinesphere.io import read_segments
from kinesphere.pipeline import solve
from kinesphere.skeleton import learn_model
from kinesphere.synthetic import make_performance, spoil_with_noise, spoil_with_soft_tissue

REAL = ("cmu41", "plugin-gait", "functional", "plates", "formats", "rigid-bodies")
KNEES = {f"functional/Test_func_{side[0]}knee.c3d": f"{side}_knee" for side in ("left", "right")}
SYNTHETIC = ("synthetic, noise-free", "synthetic, 1 mm noise", "synthetic, soft tissue")


def real_tasks(folder: Path | None) -> list[tuple[str, str]]:
    """Return (name, path) of the real recordings there are."""
    if folder is None or not folder.is_dir():
        return []
    return [
        (f"{name}/{path.name}", str(path))
        for name in REAL
        for path in sorted((folder / name).glob("*.c3d"))
    ]


def run_real(name: str, path: str) -> dict[str, Any]:
    """Solve one real recording; say why, if it cannot be."""
    try:
        recording = read(path)
        solution = solve(recording, _model(Path(path), recording))
        return {
            "name": name,
            "paper": joint_rows(solution.motion, solution.parameters),
            "halves": half_rows(solution.motion, solution.parameters),
            "vendor": vendor_rows(solution),
            "frames": same_person.frames_of(name, solution.motion),
            "bends": {
                joint: bend_row(solution.motion, solution.parameters, joint)
                for trial, joint in KNEES.items()
                if name == trial
            },
        }
    except KinesphereError as error:
        return {"name": name, "failure": str(error).partition(" (")[0].partition(";")[0]}


def summary(real: Sequence[dict[str, Any]], made: Sequence[dict[str, Any]]) -> dict[str, Any]:
    """Return what sections 4, 5, 6 and 8 show, by recording."""
    usable = [r for r in real if "failure" not in r]
    paper: dict[str, list[Any]] = {}
    for result in (*made, *usable):
        paper.setdefault(result["name"], []).extend(result["paper"])
    return {
        "paper": paper,
        "halves": {r["name"]: r["halves"] for r in usable},
        "vendor": {r["name"]: r["vendor"] for r in usable},
        "same_person": same_person.summary([r["frames"] for r in usable]),
        "bends": {joint: row for r in usable for joint, row in r["bends"].items()},
        "skipped": {r["name"]: r["failure"] for r in real if "failure" in r},
    }


def _model(path: Path, recording: Recording) -> TopologicalModel | None:
    """Return the model that a segment table beside the file describes; None to choose one."""
    tables: Iterator[Path] = path.parent.glob("MarkerSet.xml")
    table = next(tables, None)
    if table is None:
        return None
    return learn_model((recording,), path.parent.name, read_segments(table))


def run_synthetic(name: str, seed: int) -> dict[str, Any]:
    """Solve one synthetic performance."""
    return {"name": name, "paper": _paper_rows(_synthetic(name, seed), seed)}


def _paper_rows(solution: Solution, seed: int) -> list[dict[str, Any]]:
    return joint_rows(solution.motion, solution.parameters, seed)


def _synthetic(name: str, seed: int) -> Solution:
    true = make_performance(np.random.default_rng(seed), cone_deg=(60.0, 120.0))
    rng = np.random.default_rng([seed, 1])
    recording = true.recording
    if name.endswith("noise"):
        recording = spoil_with_noise(recording, rng, deviation=0.001)
    elif name.endswith("tissue"):
        recording = spoil_with_soft_tissue(recording, rng, true)
    return solve(recording, true.model, calibration=true.calibration)


SYNTHETIC_TASKS = [(name, seed) for name in SYNTHETIC for seed in range(2)]
