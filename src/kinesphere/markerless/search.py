"""Poses looked for in the large: limbs put in many places, then every joint shaken, ever less.

What Gauss-Newton cannot do, as a silhouette's edge has no slope to a limb that is elsewhere. The
shaking is annealing without acceptance of the worse, in blocks of a few joints (compare the
annealed particle filter: Deutscher and Reid 2005, doi:10.1023/B:VISI.0000043757.18370.9c).
"""

from collections.abc import Callable, Iterator, Sequence

import numpy as np

from kinesphere.data import Array
from kinesphere.markerless.chain import SLIDE, Chain
from kinesphere.markerless.hypotheses import arm_places
from kinesphere.markerless.pose import Pose, limited, moved
from kinesphere.markerless.sketch import Sketch

_BLOCKS = (
    ("pelvis",),
    ("pelvis", "trunk"),
    ("pelvis", "trunk", "left_thigh", "right_thigh"),
    ("trunk", "head"),
    *((f"{side}_thigh", f"{side}_shank") for side in ("left", "right")),
    *((f"{side}_shank", f"{side}_foot") for side in ("left", "right")),
    *((f"{side}_upper_arm", f"{side}_forearm") for side in ("left", "right")),
    *((f"{side}_clavicle", f"{side}_upper_arm") for side in ("left", "right")),
    *((f"{side}_forearm", f"{side}_hand") for side in ("left", "right")),
)
"""Joints shaken together."""
_SHIFT = 0.15
"""m by which the root is shaken, for a rad of the joints."""
_KEPT = 4
"""Places of an arm that are shaken."""
_ARM = (0.3, 0.2, 0.12)
"""rad by which it is."""
_TRIES = 20
"""Shakes of an arm at each."""


def shaken(
    sketch: Sketch, pose: Pose, sizes: Sequence[float], tries: int, blocks: Sequence[str] = ()
) -> Pose:
    """Return the best pose met while every block of joints is shaken.

    Parameters
    ----------
    sizes
        rad, standard deviations, one round each.
    tries
        In each block and round.
    blocks
        Only blocks with one of these limbs; all, if there are none.
    """
    rng = np.random.default_rng(0)
    names = sketch.body.chain.limb_names
    for size in sizes:
        for block in _BLOCKS:
            limbs = [names.index(limb) for limb in block if limb in names]
            if limbs and (not blocks or any(limb in blocks for limb in block)):
                worth = sketch.worth if 0 in limbs else sketch.worth_beside(pose, limbs)
                pose, _ = _climbed(sketch.body.chain, pose, worth, limbs, size, tries, rng)
    return pose


def with_arms_found(sketch: Sketch, pose: Pose, *, roughly: bool = False) -> Pose:
    """Return the pose with each arm where it explains most, of all the places it can reach.

    Parameters
    ----------
    roughly
        Of a third of the places, and without a closer look at the best: so that nothing else is
        turned to explain what is an arm.
    """
    directions, kept = (60, 1) if roughly else (180, _KEPT)
    chain = sketch.body.chain
    rng = np.random.default_rng(0)
    for side in ("left", "right"):
        names = [f"{side}_upper_arm", f"{side}_forearm"]
        if names[0] not in chain.limb_names:
            continue
        limbs = [chain.limb_names.index(name) for name in names]
        worth = sketch.worth_beside(pose, limbs)
        places = [
            (worth(p), i, p)
            for i, p in enumerate(_with(pose, arm_places(chain, pose, side, directions)))
        ]
        places.sort(key=lambda place: (-place[0], place[1]))
        found = []
        for most, i, place in places[:kept]:
            for size in _ARM[:1] if roughly else _ARM:
                place, most = _climbed(chain, place, worth, limbs, size, _TRIES, rng)
            found.append((most, -i, place))
        pose = max(found, key=lambda one: one[:2])[2]
    return pose


def _with(pose: Pose, others: Iterator[Pose]) -> Iterator[Pose]:
    yield pose
    yield from others


def _climbed(
    chain: Chain,
    pose: Pose,
    worth: Callable[[Pose], float],
    limbs: Sequence[int],
    size: float,
    tries: int,
    rng: np.random.Generator,
) -> tuple[Pose, float]:
    """Return the best of poses met on a walk that only goes up, and its worth."""
    most = worth(pose)
    dofs = np.flatnonzero(np.isin(chain.dof_limbs, limbs))
    scale: Array = size * np.where(chain.dof_kinds[dofs] == SLIDE, _SHIFT, 1.0)
    for _ in range(tries):
        step = np.zeros(chain.n_dofs)
        # half of the joints at a time: a step that must be right in all hardly ever is
        step[dofs] = scale * rng.normal(size=len(dofs)) * (rng.random(len(dofs)) < 0.5)
        other = limited(chain, moved(chain, pose, step), limbs)
        if (value := worth(other)) > most:
            pose, most = other, value
    return pose, most
