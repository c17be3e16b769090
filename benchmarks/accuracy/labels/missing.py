"""Markers that are not there at all: every choice at random."""

from typing import Any

import numpy as np

from benchmarks.accuracy.labels.sources import CMU, cmu, given_labels, model_of, others, score_of

CASES = 7
"""Cases of each recording and number: 112 in all."""


def missing() -> list[dict[str, Any]]:
    """Label recordings that lack 1 to 4 of the 41 markers, by the model of all other people."""
    rows = []
    for count in (1, 2, 3, 4):
        for name in CMU:
            for case in range(CASES):
                rng = np.random.default_rng([3, count, case, CMU.index(name)])
                kept = rng.permutation(41)[count:]
                labels = given_labels(cmu(name).markers[:, kept], model_of(others(name)))
                score = score_of(labels, kept)
                rows.append(
                    {
                        "recording": name,
                        "missing": count,
                        "points": score.points,
                        "right": score.right,
                        "wrong": score.wrong,
                    }
                )
            print(count, name, rows[-CASES:], flush=True)
    return rows
