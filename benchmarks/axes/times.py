"""Section 7: times of the steps that the paper timed, on a body as large and a film as long."""

import platform
import time
from collections.abc import Callable
from typing import Any

import numpy as np

from benchmarks.axes.bars import number
from kinesphere.normalization import normalize
from kinesphere.parameterization import ParameterizationSettings, TwistSettings, parameterize
from kinesphere.synthetic import make_performance

FRAMES = 24_000
REPEATS = 3


def run() -> dict[str, Any]:
    """Time normalization and parameterization of 24,000 frames of 12 limbs, processor seconds."""
    true = make_performance(np.random.default_rng(1), n_frames=FRAMES)
    motion = true.motion
    sampled = ParameterizationSettings(twist=TwistSettings(method="sampled"))
    steps: dict[str, Callable[[], Any]] = {
        "normalization": lambda: normalize(motion),
        "parameterization": lambda: parameterize(motion, calibration=true.calibration),
        "angles and twist alone, axes given": lambda: parameterize(motion, reuse=true.skeleton),
        "the same, twist sampled every degree": lambda: parameterize(
            motion, sampled, reuse=true.skeleton
        ),
    }
    return {
        "seconds": {name: _fastest(step) for name, step in steps.items()},
        "frames": FRAMES,
        "limbs": len(true.skeleton.limbs),
        "joints": len(true.skeleton.joints),
        "python": platform.python_version(),
        "numpy": np.__version__,
    }


def _fastest(step: Callable[[], Any]) -> float:
    best = np.inf
    for _ in range(REPEATS):
        start = time.process_time()
        step()
        best = min(best, time.process_time() - start)
    return float(best)


PAPER = {
    "normalization": "955 ms; 449 ms of it for every frame",
    "parameterization": "37.2 s",
    "angles and twist alone, axes given": "28.1 s",
    "the same, twist sampled every degree": "28.1 s (its step is not told)",
}


_BEFORE = """\
## 7 Times

{frames:,} frames of {limbs} limbs and {joints} joints, the size the paper reports; the fastest of
a few runs, kernels compiled before, processor time of one thread. Each row is a whole stage as
`normalize` and `parameterize` are called from Python: the search for the default position and the
limb frames; relative rotations, movement phases, axes with halves, doubts and uncertainty, rest
positions, angles, twist, residuals, flags and the containers. Reading, writing, labelling and the
skeleton are not in it. Steps of the same names are far shorter in `docs/results/speed.md` where
kernels alone are timed, on arrays in memory (angles and twist of all joints: a few µs a frame);
its stages of the whole line are those of the first two rows, on a recording with noise.

| step | here, s | µs a frame | *paper (2.8 GHz Pentium 4, 2005)* |
|---|---:|---:|---|"""
_AFTER = """
Twenty years of machines lie between the columns, so their ratio says little about algorithms; the
last two rows do, for they differ in nothing but the twist.
"""


def page(found: dict[str, Any]) -> str:
    """Return the section."""
    lines = [_BEFORE.format(**{key: found[key] for key in ("frames", "limbs", "joints")})]
    for name, seconds in found["seconds"].items():
        each = number(1e6 * seconds / found["frames"])
        lines.append(f"| {name} | {number(seconds)} | {each} | {PAPER[name]} |")
    return "\n".join([*lines, _AFTER])
