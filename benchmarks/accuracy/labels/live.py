"""Frames a second in batch; live, what a frame takes and how many labels are right."""

import time
from typing import Any

import numpy as np

from benchmarks.accuracy.labels.sources import cmu, model_of, others, shuffled
from kinesphere.data import Array, Recording
from kinesphere.labelling import LiveLabeller
from kinesphere.labelling.live import LiveLabels
from kinesphere.labelling.pair_statistics import match_pair_statistics

GHOSTS = 9
"""Points anywhere in the volume, of every frame anew: with 41 markers they are 50."""
LOCK_S = 5.0


def speed() -> list[dict[str, Any]]:
    """Measure frames labelled a second in batch, and the time a live frame takes once locked on."""
    rows = []
    for name in ("135_02", "02_05"):
        recording = cmu(name)
        points, _ = shuffled(recording.markers, np.random.default_rng(8))
        model = model_of(others(name))
        match_pair_statistics(points, model)
        start = time.perf_counter()
        match_pair_statistics(points, model)
        batch = time.perf_counter() - start
        n = round(LOCK_S * recording.rate)
        live = LiveLabels(recording.markers[:n], recording.labels, recording.rate)
        times, right, wrong = _fed(live, recording, recording.markers[n:])
        rows.append(
            {
                "recording": name,
                "frames": recording.n_frames,
                "batch_frames_per_s": round(recording.n_frames / batch),
                "live_points": 50,
                "live_median_ms": round(1e3 * float(np.median(times)), 3),
                "live_p99_ms": round(1e3 * float(np.percentile(times, 99)), 3),
                "live_right": right,
                "live_wrong": wrong,
                "live_samples": int(recording.seen[n:].sum()),
            }
        )
        print(rows[-1], flush=True)
    return rows


def live() -> list[dict[str, Any]]:
    """Feed crowds of points from the first frame on, markers hidden in changing runs."""
    rows = []
    for name in ("85_02", "02_05", "135_02"):
        for hidden in (0, 5):
            recording = cmu(name)
            labeller = LiveLabeller(
                model_of(others(name)), recording.rate, LOCK_S, background=False
            )
            markers = _hidden(recording.markers, hidden, recording.rate)
            n = round(LOCK_S * recording.rate)
            _fed(labeller, recording, markers[: n - 1])
            times, right, wrong = _fed(labeller, recording, markers[n - 1 :])
            rows.append(
                {
                    "recording": name,
                    "hidden": hidden,
                    "locked_on": labeller.locked_on,
                    "lock_s": round(max(times), 2),
                    "median_ms": round(1e3 * float(np.median(times)), 3),
                    "right": right,
                    "wrong": wrong,
                    "samples": int(np.isfinite(markers[n - 1 :, :, 0]).sum()),
                }
            )
            print(rows[-1], flush=True)
    return rows


def _fed(
    live: LiveLabels | LiveLabeller, recording: Recording, markers: Array
) -> tuple[list[float], int, int]:
    """Return seconds of each frame, and how many labels were right and wrong."""
    rng = np.random.default_rng(9)
    low, high = np.nanmin(recording.markers), np.nanmax(recording.markers)
    n = recording.n_markers
    times, right, wrong = [], 0, 0
    for frame in markers:
        crowd = np.concatenate([frame, rng.uniform(low, high, size=(GHOSTS, 3))])
        order = rng.permutation(len(crowd))
        start = time.perf_counter()
        given = live.label(crowd[order])
        times.append(time.perf_counter() - start)
        ok = given == np.where(order < n, order, -1)
        right += int((ok & (given >= 0)).sum())
        wrong += int((~ok & (given >= 0)).sum())
    return times, right, wrong


def _hidden(markers: Array, count: int, rate: float) -> Array:
    """Return markers with about ``count`` hidden at any time, for 0.1 to 1 s each."""
    rng = np.random.default_rng(10)
    changed = markers.copy()
    n_frames, n = markers.shape[:2]
    for _ in range(round(count * n_frames / (0.55 * rate))):
        start, length = rng.integers(n_frames), rng.uniform(0.1, 1.0)
        changed[start : start + round(length * rate), rng.integers(n)] = np.nan
    return changed
