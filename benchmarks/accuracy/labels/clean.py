"""Whole recordings and windows, every marker there: the paper's table 1, rebuilt."""

import time
from typing import Any

import numpy as np

from benchmarks.accuracy.labels.sources import (
    CMU,
    cmu,
    given_labels,
    model_of,
    others,
    score_of,
    shuffled,
)
from kinesphere.labelling.huang_xia import match_huang_xia
from kinesphere.labelling.similarity_tree import label_frame

WINDOWS = 12
"""Most windows of one recording, evenly spread."""


def pairs() -> list[dict[str, Any]]:
    """Label every recording by every other person's: frames right by each method."""
    rows = []
    for name in CMU:
        for other in others(name):
            points, truth = shuffled(cmu(name).markers, np.random.default_rng(1))
            start = time.perf_counter()
            labels = given_labels(points, model_of([other]))
            seconds = time.perf_counter() - start
            score = score_of(labels, truth)
            paper = score_of(match_huang_xia(points, model_of([other])).labels, truth)
            rows.append(
                {
                    "recording": name,
                    "model": other,
                    "frames": len(points),
                    "ours": len(points) if score.perfect else 0,
                    "huang_xia": len(points) if paper.perfect else 0,
                    "similarity_tree": _frames_by_tree(points, truth, cmu(other).markers[0], name),
                    "markers_ours": score.right,
                    "markers_huang_xia": paper.right,
                    "wrong": score.wrong,
                    "seconds": round(seconds, 2),
                }
            )
            print(rows[-1], flush=True)
    return rows


def _frames_by_tree(points: np.ndarray, truth: np.ndarray, pose: np.ndarray, name: str) -> int:
    """Return in how many frames the similarity tree of one pose gets all markers right."""
    up = np.array([0.0, 1.0, 0.0])  # the files of these recordings have y up
    del name
    wanted = np.argsort(truth)
    whole = np.isfinite(points).all(axis=(1, 2))
    return sum(bool((label_frame(frame, pose, up) == wanted).all()) for frame in points[whole])


def windows(length_s: float, *, several: bool) -> list[dict[str, Any]]:
    """Label windows by one other person's model each, or by that of all others."""
    rows = []
    for name in CMU:
        recording = cmu(name)
        n = round(length_s * recording.rate)
        count = min(WINDOWS, recording.n_frames // n)
        if not count:
            continue
        starts = np.linspace(0, recording.n_frames - n, count).astype(int)
        models = [others(name)] if several else [(other,) for other in others(name)]
        for model in models:
            done, right, wrong = 0, 0, 0
            for start in starts:
                rng = np.random.default_rng([2, int(start)])
                points, truth = shuffled(recording.markers[start : start + n], rng)
                score = score_of(given_labels(points, model_of(model)), truth)
                done += score.perfect
                right += score.right
                wrong += score.wrong
            rows.append(
                {
                    "recording": name,
                    "model": " + ".join(model),
                    "windows": count,
                    "perfect": done,
                    "right": right,
                    "wrong": wrong,
                    "points": 41 * count,
                }
            )
            print(length_s, rows[-1], flush=True)
    return rows
