"""The axis of a joint that has only one: cone and twist, each weighed by its worth."""

import numpy as np

from kinesphere.data import Array
from kinesphere.parameterization.axes.cone_and_twist import ConeAndTwist
from kinesphere.parameterization.axes.fit import moving_positions, plane_normal
from kinesphere.parameterization.axes.likeliest import Cone, Likeliest, likeliest_axis
from kinesphere.parameterization.samples import JointSamples

MOST_FRAMES = 400  # more change the axis by less than its uncertainty
TRIAL_FRAMES = 80  # enough to tell starts apart
CELLS = 64  # of the stratification, on a bend there or back; more let a limb that dwells count,
# fewer leave noise less to average over
ROUNDS = (6, 20)  # of a trial and of the last fit
FREEDOM = 4.0  # heavy tails: a joint called a hinge leaves its cone at times
USUAL_CONE = Cone(np.pi / 2, np.deg2rad(20.0))  # carrying angles reach 20°; without any such
# knowledge a cluster of directions always lies on some tiny circle
USUAL_COUPLING = (
    0.1  # rad of twist for a rad of the angle: knees turn by some 10° while they are bent
)
# (screw-home), and skin takes part in a movement by a tenth


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
    parts = _parts(samples)
    centred = np.concatenate([part - part.mean(axis=0) for part in parts])
    tried = np.vstack([starts, plane_normal(centred), plane_normal(moving_positions(samples))])
    few = _errors(samples, TRIAL_FRAMES)
    ends = (likeliest_axis(few, start, ROUNDS[0], USUAL_CONE, FREEDOM) for start in tried)
    best = min(ends, key=lambda end: end.cost).axis
    errors = _errors(samples, MOST_FRAMES)
    return likeliest_axis(errors, best, ROUNDS[1], USUAL_CONE, FREEDOM).axis[None]


def other_reading(samples: JointSamples, axis: Array) -> float:
    """Return how far the axis of a hinge may be off for taking twist as error, rad.

    Twist that goes with the angle tilts the axis that orientations tell, and neither repetition nor
    halves show it: an axis about which the limb may twist in proportion to the angle can be
    another. The square of the angle between both counts by the probability that there is such a
    coupling, by its Bayes factor at even odds (Savage-Dickey ratio: Dickey 1971,
    doi:10.1214/aoms/1177693507). Arcs too short to show a coupling show none.

    Parameters
    ----------
    samples
        One joint with at least one phase.
    axis : (3,)
        From `hinge_axis`.
    """
    errors = _errors(samples, MOST_FRAMES)
    other = likeliest_axis(errors, axis, ROUNDS[1], USUAL_CONE, FREEDOM, USUAL_COUPLING)
    return off_by_probability(other, axis, USUAL_COUPLING)


def off_by_probability(other: Likeliest, axis: Array, usual: float) -> float:
    """Return how far an axis is off one with a coupling of ``usual`` size, rms by probability."""
    if not other.deviation > 0:
        return 0.0
    against = np.exp(-((other.coupling / other.deviation) ** 2) / 2)
    probability = 1 / (1 + usual / other.deviation * against)
    apart = np.arctan2(np.linalg.norm(np.cross(other.axis, axis)), abs(other.axis @ axis))
    return float(np.sqrt(probability) * apart)


def _errors(samples: JointSamples, most: int) -> ConeAndTwist:
    return ConeAndTwist.of(samples, samples.phases, most, _arc(_parts(samples)) / CELLS)


def _parts(samples: JointSamples) -> list[Array]:
    return [samples.positions[a:b] for a, b in samples.phases]


def _arc(parts: list[Array]) -> float:
    """Return how far the limb goes from one side to the other in its longest movement, rad."""
    ends = [(part, end) for part in parts for end in (part[0], part[-1])]
    chords = (np.linalg.norm(part - end, axis=1).max() for part, end in ends)
    return float(2 * np.arcsin(min(1.0, max(chords) / 2)))
