"""What is done to a performance before the line gets to see it."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Any, TypeAlias

import numpy as np

from kinesphere.data import Recording
from kinesphere.synthetic import (
    Performance,
    spoil_with_gaps,
    spoil_with_ghosts,
    spoil_with_noise,
    spoil_with_soft_tissue,
    spoil_with_turned_camera,
)

Spoil: TypeAlias = Callable[[Performance, np.random.Generator], Recording]


@dataclass(frozen=True)
class Condition:
    """One column of the results."""

    name: str
    what: str
    spoil: Spoil
    actor: Mapping[str, Any] = field(default_factory=dict)
    """Arguments of `make_performance` beside the layout."""


def _as_it_is(performance: Performance, rng: np.random.Generator) -> Recording:
    del rng
    return performance.recording


def _noisy(performance: Performance, rng: np.random.Generator) -> Recording:
    return spoil_with_noise(performance.recording, rng, deviation=0.001)


def _gappy(performance: Performance, rng: np.random.Generator) -> Recording:
    return spoil_with_gaps(performance.recording, rng, share=0.1, gap_s=0.3)


def _haunted(performance: Performance, rng: np.random.Generator) -> Recording:
    return spoil_with_ghosts(performance.recording, rng, n_ghosts=20)


def _turned(performance: Performance, rng: np.random.Generator) -> Recording:
    return spoil_with_turned_camera(performance.recording, rng)


def _soft(performance: Performance, rng: np.random.Generator) -> Recording:
    return spoil_with_soft_tissue(performance.recording, rng, performance)


def _as_in_a_laboratory(performance: Performance, rng: np.random.Generator) -> Recording:
    recording = spoil_with_soft_tissue(
        performance.recording, rng, performance, per_radian=0.005, wobble=0.001
    )
    recording = spoil_with_noise(recording, rng, deviation=0.0005)
    return spoil_with_gaps(recording, rng, share=0.02)


CONDITIONS = (
    Condition("noise-free", "nothing spoiled", _as_it_is),
    Condition(
        "wide cones",
        "nothing spoiled; limbs at 60–120° to their axes instead of 80–100°",
        _as_it_is,
        {"cone_deg": (60.0, 120.0)},
    ),
    Condition("turned camera", "axes of the file permuted, up not told", _turned),
    Condition("gaps", "10 % of every marker hidden, 0.3 s at a time", _gappy),
    Condition("ghosts", "20 reflections of about 0.3 s", _haunted),
    Condition("1 mm noise", "Gaussian, every coordinate by itself", _noisy),
    Condition(
        "soft tissue",
        "markers slide by 10 mm per rad near a joint and wobble by 2 mm",
        _soft,
    ),
    Condition(
        "laboratory",
        "slide 5 mm per rad, wobble 1 mm, noise 0.5 mm, gaps 2 %",
        _as_in_a_laboratory,
    ),
)
