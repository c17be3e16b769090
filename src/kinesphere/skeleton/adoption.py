"""Markers the model does not know, taken in by the limb they are rigid with."""

from dataclasses import replace

import numpy as np

from kinesphere.data import Array, TopologicalModel
from kinesphere.geometry.rigid import into_frame
from kinesphere.geometry.vectors import is_seen
from kinesphere.skeleton.averages import mean_seen, median_seen
from kinesphere.skeleton.body import Body, robust_rms

CLEARLY = 0.6
"""A limb adopts a marker that wanders in it less than this share of what it does in any other."""
SEEN = 0.3
"""Least share of the frames in which a marker must be seen together with the limb."""
NEAR = 0.5
"""m, farthest a marker may sit from the middle of the limb's own."""


def find_adoptions(
    model: TopologicalModel, bodies: dict[str, Body], sample: dict[str, Array], limit: float
) -> dict[str, str]:
    """Return which limb each marker unknown to the model belongs to, label → limb.

    A marker is adopted if it stays in one place of one limb, to ``limit`` (m, rms), and clearly not
    in any other. Points nobody labelled (``*0``…) stay strangers, and so does everything where
    nothing moves: there every limb would do.

    Parameters
    ----------
    sample
        Label → (n_sample, 3) m, every marker of the recording in the sampled frames.
    """
    known = {*model.labels, *(label for s in model.segments for label in s.shared)}
    adopted = {}
    for label in sorted(sample.keys() - known):
        if label.startswith("*"):
            continue
        strays = {
            name: _straying(body, sample[label])
            for name, body in bodies.items()
            if not body.twist_open
        }
        order = sorted(strays, key=lambda name: strays[name])
        if len(order) < 2 or strays[order[0]] > limit:
            continue
        if strays[order[0]] < CLEARLY * strays[order[1]]:
            adopted[label] = order[0]
    return adopted


def _straying(body: Body, marker: Array) -> float:
    """Return how far a marker strays in a limb, m rms; infinite if it is far or hardly seen."""
    local = into_frame(body.rotations, body.shifts, marker[:, None])
    if is_seen(local).mean() < SEEN:
        return np.inf
    usual = median_seen(local)
    if np.linalg.norm(usual - mean_seen(body.shape)) > NEAR:
        return np.inf
    return float(robust_rms(np.linalg.norm(local - usual, axis=2))[0])


def adopt(model: TopologicalModel, adopted: dict[str, str]) -> TopologicalModel:
    """Return the model with the adopted markers on their limbs."""
    segments = tuple(
        replace(
            segment,
            markers=(*segment.markers, *(m for m, limb in adopted.items() if limb == segment.name)),
        )
        for segment in model.segments
    )
    return replace(model, segments=segments)
