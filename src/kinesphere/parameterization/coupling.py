"""Movement about another axis that goes with a main one: how far that may put the axis off."""

import numpy as np

from kinesphere.data import Array
from kinesphere.parameterization.axes.fit import Labels, phase_swing
from kinesphere.parameterization.samples import JointSamples


def circling(samples: JointSamples, axes: Array, labels: Labels) -> Array:
    """Return how far each axis may be off because the limb circles about it, (n_axes,) rad.

    Where a limb goes round on an ellipse instead of there and back, it also turns about a second
    axis, in step with the first. What of that is in phase tilts the axis and cannot be told from
    it; what is a quarter of a turn late can, and shows how large the other is: the slope of the
    sideward turn on the speed of the main one, relative to the main one. Errors that do not go
    with the movement leave none.

    Parameters
    ----------
    samples
        One joint.
    axes : (n_axes, 3)
    labels : (n_phases,)
        Which axis each of the samples' phases moves about; below 0 for none.

    Returns
    -------
    (n_axes,)
        0 for an axis without a phase. Root mean square over phases, for they need not go round the
        same way.
    """
    late, main = np.zeros(len(axes)), np.zeros(len(axes))
    for phase, k in zip(samples.phases, labels, strict=True):
        if k < 0:
            continue
        swing = phase_swing(samples, phase)
        along = axes[k] - (axes[k] @ swing.direction) * swing.direction
        along /= max(float(np.linalg.norm(along)), 1e-9)
        a = swing.vectors @ along
        b = swing.vectors @ np.cross(swing.direction, along)
        if len(a) < 3:
            continue
        speed = np.gradient(a)
        speed -= speed.mean()
        late[k] += float((b - b.mean()) @ speed) ** 2 / max(float(speed @ speed), 1e-300)
        main[k] += float(a @ a)
    return np.asarray(np.arctan(np.sqrt(late / np.maximum(main, 1e-300))))
