"""``python -m benchmarks.accuracy.joined``: axes from several recordings, put together."""

import argparse
import os
import sys
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np

from benchmarks.accuracy.joined_real import functional, rms
from benchmarks.accuracy.one_movement import DISTAL, NONE, PROXIMAL, axis_errors, one_movement
from kinesphere.data import Skeleton
from kinesphere.pipeline import solve
from kinesphere.pipeline.best_axes import with_best_axes
from kinesphere.pipeline.reuse import calibrated
from kinesphere.synthetic import make_performance

ROOT = Path(__file__).parents[2]
PAGE = ROOT / "docs" / "results" / "joined.md"
SCATTER = 4.0  # deg
WHERE = {
    "own": "in its own trial",
    "joined": "beside the other, turned by the markers",
    "named": "beside the other, frames of one name taken for the same",
    "across": "put across by the other trial",
    "reused": "reused in a third recording, whose default position is another",
}


def synthetic(seeds: int) -> tuple[dict[str, list[float]], int]:
    """Return errors of proximal axes in deg by where they are told, and how many joints there are.

    Joints count that the two trials tell together.
    """
    errors: dict[str, list[float]] = {name: [] for name in WHERE}
    n_joints = 0
    for seed in range(seeds):
        actor = make_performance(
            np.random.default_rng(seed), rate=25.0, calibration_s=60.0, free_s=0.0
        )
        trials = {
            name: solve(one_movement(actor, about, SCATTER, 100 * seed + about), actor.model)
            for name, about in (("distal", DISTAL), ("proximal", PROXIMAL))
        }
        distal, proximal = (trials[name].skeleton for name in trials)
        both, _ = with_best_axes(distal, calibrated(trials))
        still = one_movement(actor, NONE, SCATTER, 100 * seed + 50)
        third = solve(still, actor.model, calibration_from=trials).skeleton
        for joint in actor.skeleton.joints:
            if joint.n_axes != 2 or joint.name.endswith("wrist"):  # hands have two markers
                continue
            n_joints += 1
            if both.joint(joint.name).axes_reused_from != ("distal", "proximal"):
                continue
            told = {
                "own": proximal,
                "joined": both,
                "named": _with_proximal(both, proximal, joint.name),
                "across": distal,
                "reused": third,
            }
            for where, skeleton in told.items():
                errors[where].append(float(axis_errors(skeleton, actor, joint.name)[1]))
    return errors, n_joints


def _with_proximal(skeleton: Skeleton, other: Skeleton, name: str) -> Skeleton:
    """Return a skeleton with a joint's proximal axis as another one's frames have it."""
    mine, its = skeleton.joint(name), other.joint(name)
    assert mine.axes is not None
    assert its.axes is not None
    put = replace(mine, axes=np.array([mine.axes[0], its.axes[1]]))
    return replace(skeleton, joints=tuple(put if j.name == name else j for j in skeleton.joints))


def page(errors: dict[str, list[float]], n_joints: int, real: Sequence[str]) -> str:
    """Return the page."""
    rows = [
        f"| {words} | {np.median(errors[where]):.1f} | {rms(errors[where]):.1f} | "
        f"{max(errors[where]):.1f} |"
        for where, words in WHERE.items()
    ]
    lines = [
        "# Axes from several recordings",
        "",
        "Written by `python -m benchmarks.accuracy.joined`. In one trial of a known actor every",
        "joint of two axes moves about the distal one, in another about the proximal one, under 1",
        "mm of correlated noise; in each it stands differently, by "
        f"{SCATTER:g}° in every joint. Each trial",
        "tells one axis and puts the other across it; both together tell the joint "
        f"({len(errors['own'])} of {n_joints} joints).",
        "Errors are beside the markers of the parent.",
        "",
        "| the proximal axis | median, deg | rms | worst |",
        "|---|---|---|---|",
        *rows,
        "",
        *real,
    ]
    return "\n".join(lines).rstrip() + "\n"


def main() -> int:
    """Measure, print, write; exit code 1 where joining makes an axis worse."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--seeds", type=int, default=8, help="actors")
    arguments = parser.parse_args()
    errors, n_joints = synthetic(arguments.seeds)
    folder = Path(os.environ.get("KINESPHERE_DATA", ROOT.parent / "shared" / "data")) / "functional"
    real = functional(folder) if folder.is_dir() else []
    text = page(errors, n_joints, real)
    print(text)
    if real:
        PAGE.write_text(text, encoding="utf-8")
    return int(rms(errors["joined"]) > 1.1 * rms(errors["own"]))


if __name__ == "__main__":
    sys.exit(main())
