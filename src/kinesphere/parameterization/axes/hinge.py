"""The axis of a joint that has only one: cone and twist, each weighed by its worth."""

import numpy as np

from kinesphere.data import Array
from kinesphere.parameterization.axes.cone_and_twist import Cone, ConeAndTwist, likeliest_axis
from kinesphere.parameterization.axes.fit import moving_positions, plane_normal
from kinesphere.parameterization.samples import JointSamples

MOST_FRAMES = 400  # more change the axis by less than its uncertainty
TRIAL_FRAMES = 80  # enough to tell starts apart
CELLS = 64  # of the stratification, on a bend there or back; more let a limb that dwells count,
# fewer leave noise less to average over
ROUNDS = (6, 20)  # of a trial and of the last fit
FREEDOM = 4.0  # heavy tails: a joint called a hinge leaves its cone at times
USUAL_CONE = Cone(np.pi / 2, np.deg2rad(20.0))  # carrying angles reach 20°; without any such
# knowledge a cluster of directions always lies on some tiny circle


def hinge_axis(samples: JointSamples, starts: Array) -> Array:
    """Return the one axis of a hinge, (1, 3), from directions and orientations together.

    A hinge keeps the limb on one cone in all phases, so noise-free directions make the axis exact
    however the limb twists; see `ConeAndTwist`.

    Parameters
    ----------
    samples
        One joint with at least one phase.
    starts : (n, 3)
        Where to start from, beside the planes that directions lie in; the likeliest end counts.
    """
    parts = [samples.positions[a:b] for a, b in samples.phases]
    centred = np.concatenate([part - part.mean(axis=0) for part in parts])
    tried = np.vstack([starts, plane_normal(centred), plane_normal(moving_positions(samples))])
    cell = _arc(parts) / CELLS
    few = ConeAndTwist.of(samples, samples.phases, TRIAL_FRAMES, cell)
    ends = (likeliest_axis(few, start, ROUNDS[0], USUAL_CONE, FREEDOM) for start in tried)
    best = min(ends, key=lambda end: end[1])[0]
    errors = ConeAndTwist.of(samples, samples.phases, MOST_FRAMES, cell)
    return likeliest_axis(errors, best, ROUNDS[1], USUAL_CONE, FREEDOM)[0][None]


def _arc(parts: list[Array]) -> float:
    """Return how far the limb goes from one side to the other in its longest movement, rad."""
    ends = [(part, end) for part in parts for end in (part[0], part[-1])]
    chords = (np.linalg.norm(part - end, axis=1).max() for part, end in ends)
    return float(2 * np.arcsin(min(1.0, max(chords) / 2)))
