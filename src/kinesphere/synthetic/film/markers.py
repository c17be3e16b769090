"""The filmed person once more, as a marker system would have recorded them at the same time."""

import numpy as np
from numpy.typing import NDArray

from kinesphere.data import (
    Array,
    JointModel,
    Landmark,
    Recording,
    Segment,
    Step,
    Surface,
    TopologicalModel,
)
from kinesphere.data.joint_names import joint_above
from kinesphere.synthetic.film.body_motion import BodyMotion

PER_LIMB = 4
"""Markers on each limb: a rigid plate that spans its length and its girth."""
_SPREAD = 0.005
"""m by which a joint centre may be from where the markers' landmark puts it."""


def markers_of(motion: BodyMotion, rng: np.random.Generator, noise: float = 3e-4) -> Recording:
    """Return a marker recording of a film's person, rigid on every limb.

    Parameters
    ----------
    motion
        The film's.
    rng
        Source of noise.
    noise
        m, standard deviation of each coordinate.
    """
    surface = motion.surface
    tracks = []
    for limb, chosen in enumerate(_places(surface)):
        arms = surface.vertices[chosen] - surface.joint_centres[limb]
        carried = np.einsum("tij,mj->tmi", motion.turns[:, limb], arms)
        tracks.append(motion.joint_centres[:, limb, None] + carried)
    markers = np.concatenate(tracks, axis=1)
    return Recording(
        markers=markers + rng.normal(scale=noise, size=markers.shape),
        labels=tuple(
            label for segment in marker_model(surface).segments for label in segment.markers
        ),
        rate=motion.rate,
        up="+y",
        history=(Step("film", findings={"marker_noise_mm": noise * 1e3}),),
    )


def marker_model(surface: Surface) -> TopologicalModel:
    """Return the model of the markers that `markers_of` puts on a surface."""
    places = _places(surface)
    segments = tuple(
        Segment(name, tuple(f"{name}_{k + 1}" for k in range(PER_LIMB))) for name in surface.limbs
    )
    joints = []
    for limb, name in enumerate(surface.limbs[1:], start=1):
        parent = int(surface.parents[limb])
        weights = _affine(surface.vertices[places[parent]], surface.joint_centres[limb])
        landmark = Landmark(
            dict(zip(segments[parent].markers, weights.tolist(), strict=True)),
            spread=_SPREAD,
            source="the film's own body",
        )
        joints.append(
            JointModel(joint_above(name), surface.limbs[parent], name, landmarks=(landmark,))
        )
    return TopologicalModel(
        name="film",
        segments=segments,
        joints=tuple(joints),
        root=surface.limbs[0],
        required=tuple(label for segment in segments for label in segment.markers),
        description="Four markers on each limb of the filmed body.",
    )


def _places(surface: Surface) -> list[NDArray[np.intp]]:
    """Return, for each limb, vertices far from each other that ride mostly on it."""
    found = []
    for limb in range(len(surface.limbs)):
        own = np.flatnonzero(surface.weights.argmax(axis=1) == limb)
        points = surface.vertices[own]
        chosen = [int(np.argmax(np.linalg.norm(points - points.mean(axis=0), axis=1)))]
        for _ in range(2):
            apart = np.linalg.norm(points[:, None] - points[chosen], axis=2).min(axis=1)
            chosen.append(int(np.argmax(apart)))
        normal = np.cross(
            points[chosen[1]] - points[chosen[0]], points[chosen[2]] - points[chosen[0]]
        )
        chosen.append(int(np.argmax(np.abs((points - points[chosen[0]]) @ normal))))
        found.append(own[chosen])
    return found


def _affine(corners: Array, point: Array) -> Array:
    """Return weights of four points, summing to one, whose weighted sum is another point."""
    square = np.vstack([corners.T, np.ones(len(corners))])
    weights: Array = np.linalg.solve(square, np.append(point, 1.0))
    return weights
