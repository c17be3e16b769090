"""The axis a limb turns about when it turns about itself, from movements that do nothing else."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from kinesphere.data import Array
from kinesphere.geometry.rotations import mean_rotation, rotation_log
from kinesphere.parameterization.arcs import PERCENTILES
from kinesphere.parameterization.axes.fit import thinned, worth
from kinesphere.parameterization.axes.kernels import turned_between
from kinesphere.parameterization.confidence import with_tissue
from kinesphere.parameterization.halves import halves_disagreement
from kinesphere.parameterization.movement_filter import moving_frames
from kinesphere.parameterization.samples import JointSamples, Phase, runs
from kinesphere.parameterization.settings import FilterSettings, ParameterizationSettings
from kinesphere.parameterization.speed_threshold import persistence_threshold, speed_threshold

NEAR = np.cos(np.deg2rad(15.0))  # of the limb: pronation is 5-10° off the forearm's line; hips of
# somebody who turns the trunk showed 20°, an elbow of somebody who bends 24°: turns of two joints
KNOWN = np.deg2rad(5.0)  # the limb's own line is as near as that to what people twist about
LEAST = 2.0  # s of twisting: less is no movement made on purpose
PURER = 1.0  # times: what is not about the axis, of what a main movement may have


@dataclass(frozen=True, eq=False)
class TwistAxis:
    """What a limb turns about, and how well that is known."""

    axis: Array
    """(3,) unit vector in the child, along the limb rather than against it."""
    phases: tuple[Phase, ...]
    """Frames of the samples in which the limb turns about it and does nothing else."""
    range: float
    """rad, 5 to 95 % of the angle."""
    conditioning: float
    """How many times larger the rotation about it was than about any other, rms: the root of the
    ratio of the two largest eigenvalues of the rotation scatter."""
    halves: float
    """rad, largest disagreement of axes from two halves; NaN where untested."""

    @property
    def uncertainty(self) -> float:
        """Standard deviation of the axis in rad, as `AxesQuality.uncertainty`."""
        return float(with_tissue(np.array(self.halves / 2), np.array(self.range)))


def find_twist_axis(
    samples: JointSamples, settings: ParameterizationSettings, without: Sequence[Phase] = ()
) -> TwistAxis | None:
    """Find the axis of twist phases in the child; None where there are none, or none that tell.

    The paper's filter looks at the limb's direction, which a twist leaves where it is. Here the
    same filter looks at the speed of the whole orientation, and a twist phase is one that from
    rest to rest is about one axis within 15° of the limb, by the range of motion that any axis
    needs. (Pieces of free motion in which a limb happens to do nothing but twist are none: they
    put the axis up to 17° off.) What a limb turns about is fixed in the child, whatever posture
    the phase is done in, so phases are pooled there; the axis is the main eigenvector of the
    scatter of ``log(Q̄ᵀ Q)``.

    Parameters
    ----------
    samples
        One joint.
    settings
        Of the filter and of axes.
    without
        Phases that do not count.

    Returns
    -------
    TwistAxis or None
        Only one that is better known than the limb's own line, which serves without it.
    """
    phases = tuple(phase for phase in _pure(samples, settings) if phase not in without)
    axis = _pooled(samples, phases)
    if axis is None or sum(b - a for a, b in phases) < LEAST * samples.rate:
        return None
    turned = [_turns(samples, phase) for phase in phases]
    values = np.linalg.eigvalsh(sum(w.T @ w for w in turned))
    low, high = np.percentile(np.concatenate(turned) @ axis, PERCENTILES)
    everything = np.zeros(len(phases), dtype=np.intp)

    def find(half: JointSamples) -> Array:
        found = _pooled(half, half.phases)
        return np.empty((0, 3)) if found is None else found[None]

    halves = halves_disagreement(samples.with_phases(phases), axis[None], everything, find)
    told = TwistAxis(
        axis,
        phases,
        float(high - low),
        float(np.sqrt(values[2] / max(values[1], 1e-12))),
        float(halves[0]),
    )
    return told if told.uncertainty <= KNOWN else None  # False where NaN


def _pure(samples: JointSamples, settings: ParameterizationSettings) -> tuple[Phase, ...]:
    """Return the phases in which the limb turns about one axis near itself, far enough."""
    n, rate, s = len(samples.rotations), samples.rate, settings.filter
    if n < 3:
        return ()
    half = max(1, round(s.window * rate / 2))
    at = np.arange(n)
    before, after = np.maximum(at - half, 0), np.minimum(at + half, n - 1)
    speeds = turned_between(samples.rotations, before, after) * rate / (after - before)
    if samples.frames is not None:
        speeds[samples.frames[after] - samples.frames[before] != after - before] = np.nan
    threshold = twist_threshold(speeds[np.isfinite(speeds)], s)
    moving = runs(moving_frames(speeds, threshold, rate, s))
    far = np.deg2rad(settings.axes.smallest_range)
    pure = []
    for phase in moving:
        purity, axis = _main(samples, phase)
        angles = _turns(samples, phase) @ axis
        if purity >= settings.axes.purest and abs(axis @ samples.long_axis) >= NEAR:
            low, high = np.percentile(angles, PERCENTILES)
            if high - low >= far:
                pure.append(phase)
    return tuple(pure)


def twist_threshold(speeds: Array, settings: FilterSettings) -> float:
    """Return the speed in rad/s from which a limb that turns about itself moves.

    ``speeds``, (n,) rad/s, are without NaN. Where much noise leaves no deep valley, a shallow one
    will do: what is pure enough need not be doubted here. One that is slower than any movement is
    none: a single frame that happens to stand still makes it.
    """
    threshold, deep = speed_threshold(speeds, settings)
    shallow = None if deep else persistence_threshold(speeds)
    if shallow is not None and np.rad2deg(shallow) >= settings.slowest:
        return shallow
    return threshold


def _turns(samples: JointSamples, phase: Phase) -> Array:
    """Return rotation vectors from the phase's mean, in the child, (n, 3) rad."""
    rotations = samples.rotations[thinned(phase)]
    return np.asarray(rotation_log(mean_rotation(rotations).T @ rotations))


def _main(samples: JointSamples, phase: Phase) -> tuple[float, Array]:
    """Return which share of a phase's rotation is about its main axis, and that axis, (3,)."""
    w = _turns(samples, phase)
    values, vectors = np.linalg.eigh(w.T @ w)
    return float(values[2] / max(values.sum(), 1e-300)), np.asarray(vectors[:, 2])


def _pooled(samples: JointSamples, phases: tuple[Phase, ...]) -> Array | None:
    """Return the main axis of some phases together, (3,), along the limb; None without any."""
    scatter = np.zeros((3, 3))
    for phase in phases:
        w = _turns(samples, phase)
        scatter += w.T @ w * worth(phase, thinned(phase))
    if not scatter.any():
        return None
    axis = np.linalg.eigh(scatter)[1][:, 2]
    return np.asarray(axis if axis @ samples.long_axis >= 0 else -axis)
