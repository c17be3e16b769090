"""A layout's markers in other postures: which distances joints change, and by how much.

One recording shows a person in few postures. Which of the distances could be others is known from
the layout alone: within a segment none, across a joint some, from hand to thigh nearly all. So the
body's mean shape is bent at every joint, at random.
"""

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from kinesphere.data import Array, JointModel, TopologicalModel
from kinesphere.labelling.shapes import shape_of

POSTURES = 128
"""Spreads are known to 6 % by that many."""
BEND = 0.4
"""rad, spread of a joint's bend about each of three axes."""
SEED = 1681
"""Same model, same postures."""


def postures_of(model: TopologicalModel, labels: tuple[str, ...], mean: Array) -> Array:
    """Return the markers of a layout in random postures, (POSTURES, n_labels, 3).

    The first is the mean shape itself; the root stays where it is there. As distances know no
    mirror, all postures may be mirrored, together.

    Parameters
    ----------
    mean : (n_labels, n_labels)
        Mean distances, NaN where nothing is known; postures are in the same unit.
    """
    at = {label: i for i, label in enumerate(labels)}
    own = {s.name: [at[x] for x in s.markers if x in at] for s in model.segments}
    near = {s.name: [at[x] for x in (*s.markers, *s.shared) if x in at] for s in model.segments}
    shape = shape_of(mean)
    postures = np.repeat(shape[None], POSTURES, axis=0)
    rng = np.random.default_rng(SEED)
    beyond = {name: list(some) for name, some in own.items()}
    # outermost first: what hangs from a joint is bent already, the joint is where it was
    for joint in reversed(model.joints_from_root):
        outward = beyond[joint.child]
        beyond[joint.parent] = beyond[joint.parent] + outward
        bends = BEND * rng.normal(size=(POSTURES, 3))
        bends[0] = 0.0
        weights = _centre(joint, at, near, shape)
        if not outward or weights is None:
            continue
        turns = Rotation.from_rotvec(bends).as_matrix()
        centre = weights @ shape
        postures[:, outward] = (postures[:, outward] - centre) @ turns.swapaxes(1, 2) + centre
    return postures


def _centre(
    joint: JointModel, at: dict[str, int], near: dict[str, list[int]], shape: Array
) -> Array | None:
    """Return the weights of markers that add up to a joint's place, about; None if none are near.

    Where its landmark lies in or out of them makes no difference here.
    """
    weights = np.zeros(len(shape))
    for landmark in joint.landmarks:
        if all(label in at for label in landmark.weights):
            for label, weight in landmark.weights.items():
                weights[at[label]] = weight
            return weights
    parent, child = near[joint.parent], near[joint.child]
    if not parent or not child:
        return None
    apart = np.linalg.norm(shape[parent][:, None] - shape[child][None], axis=2)
    a, b = np.unravel_index(int(apart.argmin()), apart.shape)
    weights[parent[a]] += 0.5
    weights[child[b]] += 0.5
    return weights


def spread_of_distances(postures: Array) -> Array:
    """Return the deviation of every distance from posture to posture, (n_labels, n_labels)."""
    apart = np.linalg.norm(postures[:, :, None] - postures[:, None], axis=3)
    return np.asarray(apart.std(axis=0))


def steadiness(postures: Array, quadruples: NDArray[np.int64]) -> Array:
    """Return how far quadruples keep the side they have in the first posture, (n_quadruples,) −1…1.

    1 where all postures agree, 0 where half of them do.
    """
    a, b, c, d = (postures[:, quadruples[:, k]] for k in range(4))
    sides = np.sign(np.einsum("tqi,tqi->tq", np.cross(b - a, c - a), d - a))
    return np.asarray((sides * sides[0]).mean(axis=0))
