"""How often a main movement is done: with a rest between, or on and on."""

import numpy as np
from numpy.typing import NDArray

from kinesphere.data import Array
from kinesphere.parameterization.arcs import PERCENTILES
from kinesphere.parameterization.axes.fit import Labels, phase_swing, thinned, worth
from kinesphere.parameterization.samples import JointSamples

STROKE = 0.6  # of the movement's range, from one turning point to the next


def repeats(samples: JointSamples, axes: Array, labels: Labels) -> NDArray[np.intp]:
    """Return how often the movement about each axis is done, (n_axes,).

    As often as strokes, each at least `STROKE` of the range, make cycles of two. Somebody who bends
    eight times without a rest has shown it eight times; who bends, holds, and comes back after a
    rest, once. A phase that ends where it began is a cycle at least, however small its strokes.

    Parameters
    ----------
    samples
        One joint.
    axes : (n_axes, 3)
    labels : (n_phases,)
        Which axis each phase moves about; below 0 for none.
    """
    angles: list[list[Array]] = [[] for _ in axes]
    for phase, k in zip(samples.phases, labels, strict=True):
        if k >= 0:
            size = np.sqrt(worth(phase, thinned(phase)))
            angles[k].append(phase_swing(samples, phase).vectors @ axes[k] / size)
    counts = np.zeros(len(axes), dtype=np.intp)
    for k, mine in enumerate(angles):
        if mine:
            widest = max(float(np.diff(np.percentile(a, PERCENTILES))[0]) for a in mine)
            made = sum(_strokes_of(a, STROKE * widest) for a in mine)
            counts[k] = max(1, (made + 1) // 2)
    return counts


def _strokes_of(angles: Array, least: float) -> int:
    """Return the strokes of one phase, (n,), an even number where it ends near where it began."""
    count = strokes(angles, least)
    arc = float(np.diff(np.percentile(angles, PERCENTILES))[0])
    closed = abs(float(angles[-1] - angles[0])) <= (1 - STROKE) * arc
    return max(2, count + count % 2) if closed else count


def strokes(angles: Array, least: float) -> int:
    """Return how many times angles, (n,), go ``least`` or more one way and turn or end."""
    count, way = 0, 0
    low = high = float(angles[0]) if len(angles) else 0.0
    for angle in angles:
        low, high = min(low, float(angle)), max(high, float(angle))
        if way >= 0 and high - angle >= least > 0:
            count, way, low = count + 1, -1, float(angle)
        elif way <= 0 and angle - low >= least > 0:
            count, way, high = count + 1, 1, float(angle)
    return count
