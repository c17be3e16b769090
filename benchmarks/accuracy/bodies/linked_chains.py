"""Synthetic limbs in a row, of 4, 2 and 3 or 4 markers, whose joints are known."""

from dataclasses import dataclass

import numpy as np
from scipy.ndimage import gaussian_filter1d

from kinesphere.data import Array, JointModel, Motion, Recording, Segment, TopologicalModel
from kinesphere.geometry.rotations import rotation_exp

FRAMES, RATE = 700, 120.0
JOINTS = np.array([[0.03, -0.09, 0.01], [0.0, -0.27, 0.0]])
HAND = np.array([[0.03, -0.08, 0.0], [-0.03, -0.09, 0.01], [0.0, -0.12, 0.03], [0.0, -0.1, -0.03]])
NOISE = 0.001
"""m, of every marker and frame."""


@dataclass(frozen=True)
class Kind:
    """What a chain is like."""

    name: str
    beside: float = 0.02
    """m, how far the middle limb's markers are off the line of its joints."""
    skin: float = 0.0
    """m, half of it with the joints and half of it with nothing."""
    last: int = 4
    """Markers of the last limb."""
    hinge: bool = False
    """Whether the second joint turns about one axis but for a twentieth."""
    movement: float = 1.0
    """Share of the usual 29° and 34° rms about each axis of the joints."""


KINDS = (
    Kind("noise"),
    Kind("noise, on a line", beside=0.003),
    Kind("noise, three beyond", last=3),
    Kind("3 mm of skin", skin=0.003),
    Kind("3 mm of skin, on a line, three beyond", beside=0.003, skin=0.003, last=3),
    Kind("3 mm of skin, a hinge", skin=0.003, hinge=True),
    Kind("8 mm of skin", skin=0.008),
    Kind("8 mm of skin, little movement", skin=0.008, movement=0.4),
)


def model(last: int) -> TopologicalModel:
    """Return the chain's model."""
    labels, at = [f"*{i}" for i in range(6 + last)], (4, 6)
    segments = tuple(
        Segment(f"limb_{i}", tuple(map(str, own))) for i, own in enumerate(np.split(labels, at))
    )
    joints = tuple(JointModel(f"joint_{i}", f"limb_{i - 1}", f"limb_{i}") for i in (1, 2))
    return TopologicalModel("chain", segments, joints, "limb_0")


def chain(kind: Kind, seed: int) -> tuple[Recording, Array]:
    """Return a chain's recording and its joints in the world, (2, n_frames, 3) m."""
    rng = np.random.default_rng(seed)
    upper = rng.normal(scale=0.05, size=(4, 3))
    middle = np.array([[kind.beside, -0.05, 0.0], [-kind.beside, -0.22, 0.0]])
    trunk = _smooth(rng, 0.3)
    bent = kind.movement * np.hstack([_smooth(rng, 0.5), _smooth(rng, 0.6)])
    if kind.hinge:
        bent[:, 4:] *= 0.05
    first = rotation_exp(trunk)
    second = first @ rotation_exp(bent[:, :3])
    third = second @ rotation_exp(bent[:, 3:])
    start = _smooth(rng, 0.1)
    joints = np.array([start + first @ JOINTS[0], np.zeros_like(start)])
    joints[1] = joints[0] + second @ JOINTS[1]
    hung = (
        (start, first, upper),
        (joints[0], second, middle),
        (joints[1], third, HAND[: kind.last]),
    )
    placed = []
    for origin, turns, shape in hung:
        moved = np.stack([m + _skin(rng, bent, kind.skin) for m in shape], axis=1)
        placed.append(origin[:, None] + moved @ np.swapaxes(turns, 1, 2))
    markers = np.concatenate(placed, axis=1)
    markers += NOISE * rng.normal(size=markers.shape)
    labels = tuple(f"*{i}" for i in range(markers.shape[1]))
    return Recording(markers=markers, labels=labels, rate=RATE), joints


def errors(motion: Motion, joints: Array) -> list[float]:
    """Return how far each joint is from the truth in its better-marked limb, mm."""
    skeleton, found = motion.skeleton, []
    ends = (
        (0, skeleton.joint("joint_1").centre_in_parent),
        (2, skeleton.joint("joint_2").centre_in_child),
    )
    for (limb, centre), truth in zip(ends, joints, strict=True):
        turns = motion.rotations[:, limb]
        off = motion.origins[:, limb] + turns @ centre - truth
        mean = np.nanmean(np.einsum("nji,nj->ni", turns, off), axis=0)
        found.append(1e3 * float(np.linalg.norm(mean)))
    return found


def _smooth(rng: np.random.Generator, scale: float) -> Array:
    walk = gaussian_filter1d(rng.normal(size=(FRAMES, 3)), 12, axis=0)
    smooth: Array = scale * walk / walk.std(axis=0)
    return smooth


def _skin(rng: np.random.Generator, bent: Array, size: float) -> Array:
    """Return how a marker goes with the joints' angles and, as far, with nothing."""
    along = bent @ rng.normal(size=(6, 3))
    return size * np.sqrt(0.5) * (along / along.std() + _smooth(rng, 1.0))
