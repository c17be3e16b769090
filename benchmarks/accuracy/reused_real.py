"""Knees of their own functional trials in the other trials, by frames' names and by markers."""

from collections.abc import Iterator, Mapping

import numpy as np

from benchmarks.accuracy.reused_frames import by_name
from kinesphere.data import Skeleton, Solution
from kinesphere.parameterization import parameterize
from kinesphere.pipeline.best_axes import with_best_axes
from kinesphere.pipeline.reuse import calibrated

KNEES = {"left_knee": "lknee", "right_knee": "rknee"}


def reused_knees(alone: Mapping[str, Solution]) -> list[str]:
    """Return how well each knee's axis from its own trial fits every other trial, lines."""
    rows = list(_misses(alone))
    named, turned, own = (np.array([row[k] for row in rows]) for k in (2, 3, 4))
    summary = [
        f"{np.median(named):.1f} | {np.median(turned):.1f} | {np.median(own):.1f}",
        f"{_rms(named):.1f} | {_rms(turned):.1f} | {_rms(own):.1f}",
    ]
    return [
        "## Knees in other trials",
        "",
        "Each knee about the axis and rest position of its own trial, in every other trial: how",
        f"far the shank is off, mm rms. {(turned < named).sum()} of {len(rows)} are nearer by the "
        "markers.",
        "",
        "| knee | in | by the frames' names | by the markers | about its own axis there |",
        "|---|---|---|---|---|",
        *(
            f"| {knee.replace('_', ' ')} | {trial} | {a:.1f} | {b:.1f} | {c:.1f} |"
            for knee, trial, a, b, c in rows
        ),
        f"| median | | {summary[0]} |",
        f"| rms | | {summary[1]} |",
    ]


def _misses(
    alone: Mapping[str, Solution],
) -> Iterator[tuple[str, str, float, float, float]]:
    """Yield knee, trial, and how far off it is in mm by name, by markers, by its own axis."""
    for knee, source in KNEES.items():
        there = alone[source].skeleton
        for trial, solution in alone.items():
            if trial == source:
                continue
            here, _ = with_best_axes(solution.skeleton, calibrated({source: there}))
            named = by_name(here, there, knee)
            yield (
                knee,
                trial,
                *(_miss(solution, knee, reuse) for reuse in (named, here, solution.skeleton)),
            )


def _miss(solution: Solution, knee: str, reuse: Skeleton) -> float:
    solved = parameterize(solution.motion, reuse=reuse)
    j = reuse.joint_names.index(knee)
    return 1e3 * _rms(solved.residuals[:, j])


def _rms(values: np.ndarray) -> float:
    return float(np.sqrt(np.nanmean(values**2)))
