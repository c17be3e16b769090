"""Which phases are main movements: about one axis at a time, and far enough (paper section 4)."""

from collections.abc import Iterator

import numpy as np

from kinesphere.data import Array
from kinesphere.geometry.rotations import rotation_log
from kinesphere.parameterization.axes.fit import phase_swing, thinned, worth
from kinesphere.parameterization.samples import JointSamples, Phase
from kinesphere.parameterization.settings import AxesSettings

PERCENTILES = (5.0, 95.0)  # a range of motion leaves the extremes out
SHORTER = 0.6  # times as far as all phases about an axis together: ends of a phase are slow, and a
# phase of few frames loses more of them; feet turned seven times by 17° have phases of 11 to 12°
STEP = 0.1  # s, over which the direction of a turn is taken
SHORTEST = 0.8  # s, of a piece that a phase is cut into
LONG = 2.0  # s, of one axis at a time: a repeated stroke, hardly ever an accident
MOST_TRIALS = 300  # places where a cut is tried


def main_movements(
    samples: JointSamples, s: AxesSettings, share: float = 1.0
) -> Iterator[tuple[Phase, ...]]:
    """Yield sets of phases to find axes in, the most trustworthy set first.

    A main movement is done about one axis at a time; a phase of free motion is not, but may hold
    more movement than all of calibration and would outweigh it. So first come the phases that are
    very pure, and the halves of phases that run from one main movement into the next without a
    rest, cut where the axes change; then the phases that are nearly pure; at last all there are.
    Pure phases count from a ``share`` of `AxesSettings.smallest_range` on.
    """
    far = share * np.deg2rad(s.smallest_range)
    purities = {phase: _purity(samples, phase) for phase in samples.phases}
    purer = 1 - (1 - s.purest) / 4
    very_pure: list[Phase] = []
    for phase, purity in purities.items():
        if purity >= purer:
            very_pure.append(phase)
        elif (cut := best_cut(samples, phase)) is not None:
            both = ((phase[0], cut), (cut, phase[1]))
            if all(_purity(samples, half) >= purer for half in both):
                very_pure += both
    nearly_pure = [phase for phase, purity in purities.items() if purity >= s.purest]
    very_pure, nearly_pure = (
        [phase for phase in pure if _extent(samples, phase) >= far]
        for pure in (very_pure, nearly_pure)
    )
    yield tuple(very_pure)
    yield tuple(nearly_pure)
    yield samples.phases


def long_phases(samples: JointSamples) -> tuple[Phase, ...]:
    """Return the phases that are hardly pure by accident, as some of minutes of free motion are."""
    return tuple((a, b) for a, b in samples.phases if b - a >= LONG * samples.rate)


def best_cut(samples: JointSamples, phase: Phase) -> int | None:
    """Return the frame where one axis of rotation gives way to another.

    The cut after which one axis for each side explains most of the turning, measured across the
    limb so that twist has no say; None for a phase too short to be cut.
    """
    start, stop = phase
    shortest = int(np.ceil(SHORTEST * samples.rate))
    if stop - start < 2 * shortest:
        return None
    half = max(1, round(STEP * samples.rate / 2))
    # cuts lie between places: those are an odd stride apart, and as far from either end
    stride = (stop - start) // MOST_TRIALS // 2 * 2 + 1
    places = stop - start - 2 * half
    count = (places - 1) // stride + 1
    count -= (places - 1 - (count - 1) * stride) % 2
    frames = start + half + (places - 1 - (count - 1) * stride) // 2 + stride * np.arange(count)
    q, p = samples.rotations, samples.positions
    turns = rotation_log(q[frames + half] @ np.swapaxes(q[frames - half], -1, -2))
    turns -= (turns * p[frames]).sum(axis=1, keepdims=True) * p[frames]
    before = np.cumsum(turns[:, :, None] * turns[:, None, :], axis=0)
    explained = _largest(before) + _largest(before[-1] - before)
    cuts = frames + stride // 2 + 1
    explained[(cuts < start + shortest) | (cuts > stop - shortest)] = -1.0
    return int(cuts[explained.argmax()])


def _largest(matrices: Array) -> Array:
    return np.asarray(np.linalg.eigvalsh(matrices)[:, 2])


def _purity(samples: JointSamples, phase: Phase) -> float:
    """Return the share of a phase's swing that is about its own main axis."""
    w = phase_swing(samples, phase).vectors
    values = np.linalg.eigvalsh(w.T @ w)
    return float(values[2] / max(values.sum(), 1e-300))


def _extent(samples: JointSamples, phase: Phase) -> float:
    """Return how far the limb moves about the main axis of a phase, in rad."""
    w = phase_swing(samples, phase).vectors
    axis = np.linalg.eigh(w.T @ w)[1][:, 2]
    angles = w @ axis / np.sqrt(worth(phase, thinned(phase)))
    return float(np.diff(np.percentile(angles, PERCENTILES))[0])
