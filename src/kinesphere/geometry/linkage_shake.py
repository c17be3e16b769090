"""What linked bodies tell of their joints, less what noise feigns of their turns."""

import numpy as np
from numpy.typing import NDArray

from kinesphere.geometry.centre_covariance import Told
from kinesphere.geometry.joint_turns import joint_turns, nearest
from kinesphere.geometry.linkage import Linkage, by_pose_of, misfit, square_of
from kinesphere.geometry.linkage_fit import LinkageFit
from kinesphere.geometry.pose_worth import noise_share
from kinesphere.geometry.rotations import mean_rotation
from kinesphere.geometry.shake import DOUBT, clear_of_shake
from kinesphere.geometry.vectors import is_seen

Array = NDArray[np.float64]

STILL = 1e-9
"""rad², variance of turns that keeps their matrix solvable."""


def cleared_of_shake(
    fit: LinkageFit,
    seen: NDArray[np.bool_],
    over: Array,
    expected: Array,
    spreads: Array,
) -> list[Told]:
    """Return what the motion tells of each joint without what noise in the poses feigns.

    Shaking poses look like motion, about the axis of a hinge as about any other: the fit seems to
    know where on it the centre is (see `kinesphere.geometry.shake`). That share of the information
    is as large as the share of the turns that is noise.

    Parameters
    ----------
    fit
        As `kinesphere.geometry.linkage_fit.fit_linkage` returns it.
    seen : (n_frames, n_markers)
    over : (n_bodies,)
        How many times a centre's variance is what the fit's information says.
    expected : (n_bodies, 3) m
        Centres in their parents.
    spreads : (n_bodies,) m
        How far off they may be.

    Returns
    -------
    Of each body; of the first nothing.
    """
    linkage, information = fit.linkage, fit.information
    own = np.linalg.inv(square_of(_seen_pose(linkage, seen))) * fit.scale**2
    told = [Told(np.zeros((3, 3)), np.zeros((3, 3)))]
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
        doubt = DOUBT**2 * feigned @ off @ feigned
        curve, heard = clear_of_shake(information[body], feigned, doubt)
        scatter = over[body] * information[body] + doubt
        told.append(Told(heard @ curve, heard @ scatter @ heard.T))
    return told


def averaging_share(linkage: Linkage, points: Array) -> float:
    """Return the share of the markers' strays that averages out over frames, 0…1.

    Parameters
    ----------
    points : (n_frames, n_markers, 3) m
        Body by body; NaN where not seen, which says nothing.
    """
    seen = is_seen(points)
    off = misfit(linkage, points, seen)
    first, others = linkage.rotations[:, :1], linkage.rotations[:, 1:]
    turns = np.swapaxes(first, 2, 3) @ others
    near = nearest(turns.reshape(len(turns), -1))
    if seen.all():
        return noise_share(off.reshape(len(off), -1), near)
    both = seen & seen[near]
    if not both.any():
        return 0.0
    apart = np.median(((off - off[near])[both] ** 2).sum(axis=1)) / 2
    return min(float(apart / max(np.median((off[both] ** 2).sum(axis=1)), 1e-300)), 1.0)


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
