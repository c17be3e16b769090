"""Hinges that bend as a knee does in its functional trial, and what keeps real ones from it."""

from collections.abc import Mapping

import numpy as np

from benchmarks.axes.generator import (
    NOISES,
    RATE,
    SWAY,
    Cones,
    TrueJoint,
    draw_axes,
    poses,
    spoil,
    wander,
)
from kinesphere.geometry.rotations import rotation_about, rotation_exp

BENDS, EVERY, LASTS = 5, 3.0, 2.4  # s
REACH, JITTER = 120.0, 0.15  # deg
CARRIED = Cones((70.0, 110.0), (75.0, 105.0))
LIFTED = 6.0  # deg, by which the parent turns with its skin during the first bend
SCREWED = 10.0  # deg of twist at 120°
TURNING = 4.0  # deg rms, as knees turn about the shank at equal angles in bends and returns
LASTING = 2.0  # s, about a bend
MADE: Mapping[str, Mapping[str, float]] = {
    "hinge": {},
    "hinge, first bend lifted": {"lifted": LIFTED},
    "hinge, twisting with the angle": {"screwed": SCREWED},
    "hinge, turning at random": {"turning": TURNING},
    "hinge, turning anew in each bend": {"renewed": TURNING},
}


def make_hinge(
    rng: np.random.Generator,
    noise: str,
    lifted: float = 0.0,
    screwed: float = 0.0,
    turning: float = 0.0,
    renewed: float = 0.0,
) -> TrueJoint:
    """Return a hinge that bends five times by 120°.

    ``lifted`` deg off about anything at first, twisting by ``screwed`` deg at 120°, and turning
    about its limb at random, by ``turning`` deg rms with a memory of `LASTING` or by ``renewed``
    deg rms in proportion to the angle, by another share in each bend.
    """
    axes, limb = draw_axes(rng, CARRIED)
    n = round(RATE * (BENDS * EVERY + 4.0))
    t = np.arange(n) / RATE
    angles = np.deg2rad(SWAY) * wander(rng, n, 3)
    angles[:, 1] = 0.0
    off, about = np.zeros((n, 3)), np.zeros((n, 2), dtype=bool)
    raised = np.zeros((n, BENDS))
    for i in range(BENDS):
        start = 2.0 + EVERY * i
        during = (t >= start) & (t < start + LASTS)
        share = (t[during] - start) / LASTS
        reach = np.deg2rad(REACH) * rng.uniform(1 - JITTER, 1 + JITTER)
        raised[during, i] = (1 - np.cos(2 * np.pi * share)) / 2
        course = reach * raised[during, i]
        angles[during, 0] += course
        angles[during, 2] += screwed / REACH * course
        about[during, 0] = True
        if i == 0:
            way = rng.normal(size=3)
            way *= np.deg2rad(lifted) / np.linalg.norm(way)
            off[during] = np.sin(np.pi * share)[:, None] * way
    clean = rotation_exp(off) @ poses(axes, np.eye(3), limb, angles)
    rotations = spoil(rng, clean, angles, NOISES[noise])
    # drawn last: the other kinds are what they are without
    turns = np.deg2rad(turning) * wander(rng, n, 1, LASTING)[:, 0]
    usual = np.sqrt((raised[about[:, 0]] ** 2).sum(axis=1).mean())
    turns += np.deg2rad(renewed) / usual * (raised @ rng.normal(size=BENDS))
    angles[:, 2] += turns
    return TrueJoint(rotations @ rotation_about(limb, turns), limb, axes, np.eye(3), angles, about)
