"""Solve spoiled performances and compare with what they were."""

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np

from benchmarks.accuracy.conditions import Condition
from kinesphere.errors import KinesphereError
from kinesphere.pipeline import solve
from kinesphere.synthetic import TruthRow, compare_with_truth, make_performance
from kinesphere.synthetic.layout import Layout

LAYOUTS: tuple[Layout, ...] = ("bodies", "cmu41")


@dataclass(frozen=True)
class Trial:
    """One performance, solved."""

    layout: Layout
    condition: str
    seed: int
    rows: tuple[TruthRow, ...]
    failure: str = ""
    """Why there is no solution; empty where there is one."""

    def as_json(self) -> dict[str, Any]:
        """Return what JSON can hold; NaN becomes null, digits that mean nothing are cut."""
        rows = [
            {
                "measure": row.measure,
                "of": row.of,
                "error": _short(row.error),
                "largest": _short(row.largest),
                "unit": row.unit,
            }
            for row in self.rows
        ]
        return {
            "layout": self.layout,
            "condition": self.condition,
            "seed": self.seed,
            "failure": self.failure,
            "rows": rows,
        }


def _short(value: float) -> float | None:
    return round(value, 5) if np.isfinite(value) else None


def trials(conditions: tuple[Condition, ...], seeds: range) -> Iterator[Trial]:
    """Run every condition on both layouts; the same seed is the same actor and motion.

    Marker bodies are solved with the model that is true for them, the CMU layout with whatever the
    line chooses by itself.
    """
    for layout in LAYOUTS:
        for condition in conditions:
            for seed in seeds:
                yield _trial(layout, condition, seed)


def _trial(layout: Layout, condition: Condition, seed: int) -> Trial:
    performance = make_performance(np.random.default_rng(seed), layout=layout, **condition.actor)
    recording = condition.spoil(performance, np.random.default_rng([seed, 1]))
    model = performance.model if layout == "bodies" else None
    try:
        solution = solve(recording, model, calibration=performance.calibration)
    except KinesphereError as error:
        return Trial(layout, condition.name, seed, (), f"{type(error).__name__}: {error}")
    return Trial(layout, condition.name, seed, compare_with_truth(performance, solution))
