"""Movement about another axis that goes with a main one: how far that may put the axis off."""

from collections import Counter
from dataclasses import dataclass, field

import numpy as np

from kinesphere.data import Array, Motion
from kinesphere.parameterization.axes.fit import Labels, phase_labels, phase_swing, thinned
from kinesphere.parameterization.samples import Frames, JointSamples

SHARE = 0.07
"""rad for a rad of the movement, that skin comes back about another axis, which turns the axis as
much however long the arc; two knees of one person twist by 0.077 and 0.068 with their angle, which
is such a share, of skin or not. About the limb itself `AxesQuality.readings` tells it."""
NEIGHBOURS = 0.035
"""rad for a rad of the joints beyond, that skin turns the limb: 0.032 at hips and 0.039 at
shoulders of synthetic people who move all joints at once, beside what else puts their axes off."""
MOST_JOINTS = 2  # of a limb whose skin turns with them; trunk and pelvis are too wide for that


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


@dataclass(frozen=True, eq=False)
class Neighbours:
    """How limbs move at the joints that share a limb with one."""

    rotations: Array = field(default_factory=lambda: np.empty((0, 0, 3, 3)))
    """(n_frames, n_limbs, 3, 3) ``world_from_limb`` of the whole motion; NaN where unseen."""
    pairs: tuple[tuple[int, int, Array], ...] = ()
    """Of each such joint parent, child and the child's long axis, (3,)."""
    wide: bool = False
    """Whether the child is as wide as trunk or pelvis."""

    def arcs(self, samples: JointSamples, labels: Labels, n_axes: int) -> Array:
        """Return how far they move in the phases about each axis, together, (n_axes,) rad.

        An arc is twice the way from its middle; of several joints the root of the sum of squares,
        of several phases the root mean square.
        """
        squares, counts = np.zeros(n_axes), np.zeros(n_axes)
        at = np.arange(len(samples.rotations)) if samples.frames is None else samples.frames
        for phase, k in zip(samples.phases, labels, strict=True):
            if k >= 0:
                counts[k] += 1
                frames = at[thinned(phase)]
                squares[k] += sum(self._arc(frames, *pair) ** 2 for pair in self.pairs)
        return np.asarray(np.sqrt(squares / np.maximum(counts, 1)))

    def _arc(self, frames: Frames, parent: int, child: int, long_axis: Array) -> float:
        above, below = self.rotations[frames, parent], self.rotations[frames, child]
        directions = np.einsum("nji,nj->ni", above, below @ long_axis)
        known = directions[np.isfinite(directions[:, 0])]
        if len(known) == 0:
            return 0.0
        middle = known.mean(axis=0)
        middle /= max(float(np.linalg.norm(middle)), 1e-9)
        return 2 * float(np.arccos(np.clip(known @ middle, -1, 1)).max())


def neighbours_of(motion: Motion) -> list[Neighbours]:
    """Return the neighbours of every joint: those at the other end of a limb that has two ends."""
    skeleton = motion.skeleton
    limbs = [(skeleton.parents[j + 1], j + 1) for j in range(len(skeleton.joints))]
    ends = Counter(limb for pair in limbs for limb in pair)
    narrow = {limb for limb, count in ends.items() if count <= MOST_JOINTS}
    return [
        Neighbours(
            motion.rotations,
            tuple(
                (*other, skeleton.limbs[other[1]].long_axis)
                for i, other in enumerate(limbs)
                if i != j and set(other) & set(mine) & narrow
            ),
            mine[1] not in narrow,
        )
        for j, mine in enumerate(limbs)
    ]


def coupling(samples: JointSamples, axes: Array, ranges: Array, neighbours: Neighbours) -> Array:
    """Return how far other movement may put axes off that goes with their own, (n_axes,) rad.

    Circling, and skin: of a joint's two limbs it also goes with their other joints, by
    `NEIGHBOURS` of how far those move. Where they do and the joint itself hardly does, skin is
    the movement.

    Parameters
    ----------
    samples
        One joint.
    axes : (n_axes, 3)
    ranges : (n_axes,)
        rad, how far the joint moves about each.
    neighbours
        Of the joint.
    """
    labels = phase_labels(samples, axes)
    skin = NEIGHBOURS * neighbours.arcs(samples, labels, len(axes))
    return np.asarray(
        np.hypot(circling(samples, axes, labels), np.arctan2(skin, np.maximum(ranges, 1e-9)))
    )
