"""What noise feigns of the turns of linked bodies, and where that draws their joints."""

import numpy as np
from numpy.typing import NDArray

from kinesphere.geometry.joint_turns import joint_turns
from kinesphere.geometry.linkage import Linkage, by_pose_of, square_of
from kinesphere.geometry.rotations import mean_rotation

Array = NDArray[np.float64]

STILL = 1e-9
"""rad², variance of turns that keeps their matrix solvable."""


def feigned_pull(
    linkage: Linkage,
    seen: NDArray[np.bool_],
    scale: float,
    information: Array,
    expected: Array,
    spreads: Array,
) -> Array:
    """Return the variance of the force that feigned turns put on each joint, (n_bodies, 3, 3) 1/m².

    Shaking poses look like motion, about the axis of a hinge as about any other: the fit seems to
    know where on it the centre is, and puts it where noise moves points least, amid the markers of
    the limb beyond (see `kinesphere.geometry.shake`). Information in proportion to the share of the
    turns that is noise pulls there, from wherever the centre is.

    Parameters
    ----------
    linkage
        Fitted.
    seen : (n_frames, n_markers)
    scale
        m, standard deviation of a marker in each direction.
    information : (n_bodies, 3, 3) 1/m²
        As `kinesphere.geometry.linkage_fit.fit_linkage` returns it.
    expected : (n_bodies, 3) m
        Centres in their parents.
    spreads : (n_bodies,) m
        How far off they may be; the first says nothing.
    """
    own = np.linalg.inv(square_of(_seen_pose(linkage, seen))) * scale**2
    pulls = np.zeros((len(linkage.parents), 3, 3))
    for body, parent in enumerate(linkage.parents[1:], start=1):
        to_parent = np.swapaxes(linkage.rotations[:, parent], 1, 2)
        relative = to_parent @ linkage.rotations[:, body]
        mean = mean_rotation(relative)
        turns = joint_turns(relative) @ mean.T
        a, b = slice(3 * parent, 3 * parent + 3), slice(3 * body, 3 * body + 3)
        apart = own[:, a, a] + own[:, b, b] - own[:, a, b] - own[:, b, a]
        noise = (to_parent @ apart @ np.swapaxes(to_parent, 1, 2)).mean(axis=0)
        shown = _moves(turns.T @ turns / len(turns)) + STILL * np.eye(3)
        root = _power(information[body], 0.5) @ _power(shown, -0.5)
        feigned = root @ _within(_moves(noise), shown) @ root.T
        towards = expected[body] - linkage.centres[body] - mean @ linkage.shapes[body].mean(axis=0)
        off = np.outer(towards, towards) + spreads[body] ** 2 * np.eye(3)
        pulls[body] = feigned @ off @ feigned
    return pulls


def _seen_pose(linkage: Linkage, seen: NDArray[np.bool_]) -> Array:
    moved = by_pose_of(linkage, seen.shape[1]) * seen[..., None, None]
    flat: Array = moved.reshape(len(seen), -1, moved.shape[3])
    return flat


def _moves(turns: Array) -> Array:
    """Return how far turns of a covariance move points, by where those are, (3, 3) rad²."""
    moves: Array = np.trace(turns) * np.eye(3) - turns
    return moves


def _within(noise: Array, shown: Array) -> Array:
    """Return noise as far as there is no more of it than is shown."""
    back, root = _power(shown, 0.5), _power(shown, -0.5)
    values, vectors = np.linalg.eigh(root @ noise @ root)
    least: Array = back @ (vectors * np.clip(values, 0.0, 1.0)) @ vectors.T @ back
    return least


def _power(matrix: Array, power: float) -> Array:
    values, vectors = np.linalg.eigh(matrix)
    raised: Array = (vectors * np.maximum(values, 1e-300) ** power) @ vectors.T
    return raised
