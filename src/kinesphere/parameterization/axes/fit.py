"""What every axis method takes and gives, and what they share."""

from dataclasses import dataclass
from itertools import combinations
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from kinesphere.data import Array
from kinesphere.geometry.even_frames import every_nth
from kinesphere.geometry.rotations import mean_rotation, rotation_log
from kinesphere.geometry.vectors import lengths
from kinesphere.parameterization.samples import Frames, JointSamples, Phase
from kinesphere.parameterization.settings import AxesSettings

Labels = NDArray[np.intp]

SAME = np.cos(np.deg2rad(25.0))  # a phase within 25° of an axis moves about it
MOST_FRAMES = 400  # of one phase; what they have in common shows in fewer
ALL_ROUND = np.deg2rad(170.0)  # from the mean orientation, and twice that about the mean direction
SIDEWAYS = np.sin(np.deg2rad(6.0))  # half the least range: a limb nearer to its axis goes nowhere
MANY_PHASES = 40  # all pairs of the heaviest so many are tried as a start


class AxesMethod(Protocol):
    """An interchangeable way to find movement axes."""

    def __call__(self, samples: JointSamples, n_axes: int, settings: AxesSettings) -> Array:
        """Return up to ``n_axes`` unit axes in the parent frame, (n_found, 3), any sign."""
        ...


@dataclass(frozen=True, eq=False)
class PhaseScatter:
    """Second moments of the rotation vectors of each phase about the phase's mean."""

    scatter: Array
    """(n_phases, 3, 3) rad², summed over frames."""
    values: Array
    """(n_phases, 3) eigenvalues, largest first."""
    axes: Array
    """(n_phases, 3) main rotation axis of each phase."""


def phase_scatter(samples: JointSamples) -> PhaseScatter:
    """Return the scatter of ``log(Q Q̄ᵀ)`` of every phase, Q̄ its mean rotation."""
    scatter = np.zeros((len(samples.phases), 3, 3))
    for i, phase in enumerate(samples.phases):
        frames = thinned(phase)
        rotations = samples.rotations[frames]
        w = rotation_log(rotations @ mean_rotation(rotations).T)
        scatter[i] = w.T @ w * worth(phase, frames)
    values, vectors = np.linalg.eigh(scatter)
    return PhaseScatter(scatter, values[:, ::-1], vectors[:, :, 2])


def pooled_axes(parts: Array, directions: Array, weights: Array, n_axes: int) -> Array:
    """Return the top eigenvectors of matrices pooled by the axis their direction is close to.

    Parameters
    ----------
    parts : (n, 3, 3)
        Symmetric; their eigenvectors count.
    directions : (n, 3)
        Main direction of each part, any sign.
    weights : (n,)
        How much each part says.

    Returns
    -------
    (n_found, 3)
        Heaviest first. Starts from the pair of directions that explains most, so no start is
        random; fewer than ``n_axes`` where all parts have one direction.
    """
    if len(parts) == 0 or not weights.max() > 0:
        return np.empty((0, 3))
    axes = directions[_best_start(directions, weights, n_axes)]
    labels = np.full(len(parts), -2)
    for _ in range(30):
        cosines = np.abs(directions @ axes.T)
        new = np.where(cosines.max(axis=1) > SAME, cosines.argmax(axis=1), -1)
        if (new == labels).all():
            break
        labels = new
        axes = np.array(
            [
                np.linalg.eigh(parts[labels == k].sum(axis=0))[1][:, 2]
                if (labels == k).any()
                else a
                for k, a in enumerate(axes)
            ]
        )
    pooled = np.array([weights[labels == k].sum() for k in range(len(axes))])
    order = np.argsort(-pooled, kind="stable")
    return axes[order[pooled[order] > 0]]


def _best_start(directions: Array, weights: Array, n_axes: int) -> list[int]:
    """Return the directions that explain most weight together; fewer if one explains all."""
    heavy = np.argsort(-weights, kind="stable")[:MANY_PHASES]
    near = np.maximum(np.abs(directions @ directions[heavy].T) ** 2 - SAME**2, 0) / (1 - SAME**2)
    gains = weights[:, None] * near
    best: tuple[int, ...] = (int(gains.sum(axis=0).argmax()),)
    for count in range(2, n_axes + 1):
        if count == 2:
            trials: list[tuple[int, ...]] = list(combinations(range(len(heavy)), 2))
        else:  # a third joins the best two
            trials = [(*best, k) for k in range(len(heavy)) if k not in best]
        trials = [
            t
            for t in trials
            if all(near[heavy[a], b] == 0 for a, b in combinations(t, 2))  # further than 25° apart
        ]
        if not trials:
            break
        best = max(trials, key=lambda t: float(gains[:, list(t)].max(axis=1).sum()))
    return [int(heavy[k]) for k in best]


def plane_normal(points: Array) -> Array:
    """Return the normal of the plane through the origin that is closest to points, (n, 3)."""
    normal: Array = np.linalg.eigh(points.T @ points)[1][:, 0]
    return normal


def moving_positions(samples: JointSamples) -> Array:
    """Return the positions of all phases one after another, (n, 3)."""
    parts = [samples.positions[start:stop] for start, stop in samples.phases]
    return np.concatenate(parts) if parts else np.empty((0, 3))


@dataclass(frozen=True, eq=False)
class Swing:
    """Rotation of a limb about its mean in one phase, without what it turns about itself."""

    vectors: Array
    """(n, 3) rad, rotation vectors across the limb's mean direction, weighted so that their squares
    add up to those of all frames."""
    direction: Array
    """(3,) mean direction of the limb; 0 where that is its axis, for it goes all round."""

    def about(self, axes: Array) -> Array:
        """Return how much of the movement each axis explains, (n_axes, 3) → (n_axes,) rad²."""
        across = axes - np.outer(axes @ self.direction, self.direction)
        across /= np.maximum(np.linalg.norm(across, axis=1), 1e-9)[:, None]
        return np.asarray(((self.vectors @ across.T) ** 2).sum(axis=0))


def phase_swing(samples: JointSamples, phase: Phase) -> Swing:
    """Return the swing of one phase."""
    frames = thinned(phase)
    rotations = samples.rotations[frames]
    w = rotation_log(rotations @ mean_rotation(rotations).T)
    positions = samples.positions[frames]
    p = positions.mean(axis=0)
    p /= max(float(np.linalg.norm(p)), 1e-9)
    if goes_round(w, positions, p):
        p = np.zeros(3)
    return Swing(np.sqrt(worth(phase, frames)) * (w - np.outer(w @ p, p)), p)


def goes_round(vectors: Array, positions: Array, middle: Array) -> bool:
    """Return whether a limb turns on and on about its mean direction, as a crank does.

    Then rotation about that direction is no twist: it is what moves the limb.

    Parameters
    ----------
    vectors : (n, 3)
        rad, rotation vectors from the mean orientation.
    positions : (n, 3)
        Directions of the limb, in the order of time.
    middle : (3,)
        Their mean direction.
    """
    if lengths(vectors).max() < ALL_ROUND:
        return False  # there and back, or circling with hardly any rotation
    across = positions - np.outer(positions @ middle, middle)
    if np.median(lengths(across)) < SIDEWAYS:
        return False  # it turns about itself
    side = across[lengths(across).argmax()]
    azimuth = np.arctan2(across @ np.cross(middle, side), across @ side)
    return bool(np.ptp(np.unwrap(azimuth)) >= 2 * ALL_ROUND)


def thinned(phase: Phase) -> Frames:
    """Return the frames of a phase, (n,), evenly thinned where there are very many."""
    start, stop = phase
    return start + every_nth(stop - start, (stop - start) // MOST_FRAMES)


def worth(phase: Phase, frames: Frames) -> float:
    """Return for how many frames of a phase each of some of them stands."""
    return (phase[1] - phase[0]) / len(frames)


def phase_labels(samples: JointSamples, axes: Array) -> Labels:
    """Return which axis, (n_axes, 3), each phase moves about most, (n_phases,).

    −1 where less than half of its movement is about any.
    """
    labels = np.full(len(samples.phases), -1, dtype=np.intp)
    for i, phase in enumerate(samples.phases):
        swing = phase_swing(samples, phase)
        about = swing.about(axes)
        if about.max() >= 0.5 * (swing.vectors**2).sum():
            labels[i] = int(about.argmax())
    return labels
