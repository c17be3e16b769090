"""Time and memory of a skeleton from motion alone, and how they grow."""

import time
import tracemalloc
from dataclasses import dataclass

import numpy as np

from benchmarks.accuracy.bodies.cases import FRAMES, hidden
from kinesphere.data import Recording
from kinesphere.skeleton import discover, fit_skeleton
from kinesphere.synthetic import make_performance, spoil_with_noise, together

FRAME_COUNTS = (3_000, 6_000, 12_000, 24_000, 48_000)
PEOPLE = (1, 2, 3)


@dataclass(frozen=True)
class Cost:
    """One run, after compilation."""

    n_frames: int
    n_markers: int
    discovery_s: float
    skeleton_s: float
    """Shapes, joints and the pose of every limb in every frame."""
    memory_mb: float
    """Most that was allocated at once, beside the recording."""


def cost_rows() -> list[Cost]:
    """Return the costs of growing recordings: of one person in more frames, of more people."""
    _run(_recording(2000, 1))  # compiles
    return [
        *(_run(_recording(n, 1)) for n in FRAME_COUNTS),
        *(_run(_recording(FRAMES, people)) for people in PEOPLE[1:]),
    ]


def _recording(n_frames: int, people: int) -> Recording:
    cast = {
        f"P{k}": make_performance(
            np.random.default_rng(k), n_frames=n_frames, calibration_s=min(60.0, n_frames / 100)
        )
        for k in range(people)
    }
    rng = np.random.default_rng(5)
    return hidden(spoil_with_noise(together(cast), rng, deviation=0.001))


def _run(recording: Recording) -> Cost:
    start = time.process_time()
    found = discover(recording)
    between = time.process_time()
    fit_skeleton(recording, found.model)
    end = time.process_time()
    tracemalloc.start()
    fit_skeleton(recording, discover(recording).model)
    _, most = tracemalloc.get_traced_memory()
    tracemalloc.stop()
    return Cost(
        n_frames=recording.n_frames,
        n_markers=recording.n_markers,
        discovery_s=between - start,
        skeleton_s=end - between,
        memory_mb=most / 1e6,
    )


def plot(rows: list[Cost]) -> str:
    """Return how time grows with frames as an SVG drawing."""
    grown = [row for row in rows if row.n_markers == rows[0].n_markers]
    wide, high = 520, 240
    most_s = max(row.discovery_s + row.skeleton_s for row in grown) * 1.15
    most_n = max(row.n_frames for row in grown)

    def line(values: list[float]) -> str:
        return " ".join(
            f"{60 + wide * row.n_frames / most_n:.1f},{20 + high * (1 - value / most_s):.1f}"
            for row, value in zip(grown, values, strict=True)
        )

    total = line([row.discovery_s + row.skeleton_s for row in grown])
    found = line([row.discovery_s for row in grown])
    text = 'font-family="sans-serif" font-size="12"'
    ticks = "".join(
        f'<text x="{60 + wide * row.n_frames / most_n:.1f}" y="{high + 38}" {text} '
        f'text-anchor="middle">{row.n_frames // 1000}k</text>'
        for row in grown
    )
    return (
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {wide + 130} {high + 70}">'
        f'<rect width="100%" height="100%" fill="#ffffff"/>'
        f'<path d="M60 20V{20 + high}H{60 + wide}" fill="none" stroke="#98a2b3"/>{ticks}'
        f'<text x="52" y="26" {text} text-anchor="end">{most_s:.1f} s</text>'
        f'<text x="{60 + wide / 2}" y="{high + 60}" {text} text-anchor="middle">frames of '
        f"{grown[0].n_markers} markers</text>"
        f'<polyline points="{total}" fill="none" stroke="#3b5bdb" stroke-width="2"/>'
        f'<polyline points="{found}" fill="none" stroke="#e8590c" stroke-width="2"/>'
        f'<text x="80" y="40" {text} fill="#3b5bdb">bodies, joints and every pose</text>'
        f'<text x="80" y="58" {text} fill="#e8590c">bodies, tree and names</text></svg>\n'
    )
