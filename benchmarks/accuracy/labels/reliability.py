"""How often labels are right that are said to be so sure."""

from collections.abc import Iterator
from typing import Any

import numpy as np

from benchmarks.accuracy.labels.sources import CMU, cmu, model_of, others, shuffled
from kinesphere.data import Array, TopologicalModel
from kinesphere.labelling.pair_statistics import match_pair_statistics

EDGES = (0.0, 0.05, 0.1, 0.2, 0.3, 0.4, 0.6, 0.8, 1.0)
"""Of the confidence."""
SEED = 7
"""Other windows, and other markers missing, than in the other parts."""
CASES = 2
"""Of each recording and number of markers missing."""

Case = tuple[str, Array, np.ndarray, TopologicalModel]


def reliability() -> list[dict[str, Any]]:
    """Count labels by the confidence stated for them, and how many are right."""
    counts: dict[str, np.ndarray] = {}
    for kind, points, truth, model in [*_windows(5.0), *_windows(2.0), *_missing()]:
        match = match_pair_statistics(points, model)
        given = match.labels >= 0
        at = np.digitize(match.confidence[given], EDGES[1:-1])
        found = counts.setdefault(kind, np.zeros((2, len(EDGES) - 1), dtype=np.int64))
        np.add.at(found[0], at, 1)
        np.add.at(found[1], at[(match.labels == truth)[given]], 1)
        print(kind, int((match.labels == truth).sum()), len(truth), flush=True)
    return [
        {"cases": kind, "from": EDGES[k], "to": EDGES[k + 1], "labels": int(n), "right": int(right)}
        for kind, found in counts.items()
        for k, (n, right) in enumerate(found.T)
    ]


def _windows(length_s: float) -> Iterator[Case]:
    """Yield windows half their length later than those of the other parts."""
    for name in CMU:
        recording = cmu(name)
        n = round(length_s * recording.rate)
        count = min(12, recording.n_frames // n)
        models = [others(name)] if length_s < 5.0 else [(other,) for other in others(name)]
        for start in np.linspace(0, recording.n_frames - n, max(count, 1)).astype(int) + n // 2:
            if start + n > recording.n_frames:
                continue
            for model in models:
                rng = np.random.default_rng([SEED, int(start)])
                points, truth = shuffled(recording.markers[start : start + n], rng)
                yield f"windows of {length_s:g} s", points, truth, model_of(model)


def _missing() -> Iterator[Case]:
    for count in (1, 2, 3, 4):
        for number, name in enumerate(CMU):
            for case in range(CASES):
                rng = np.random.default_rng([SEED, count, case, number])
                kept = rng.permutation(41)[count:]
                yield "markers missing", cmu(name).markers[:, kept], kept, model_of(others(name))
