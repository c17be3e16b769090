"""An actor with markers on the spines of the pelvis, which tell its hips as far as they do.

The pelvis is put where the regression of Harrington et al. 2007 has the true hips on average. What
a hip deviates from it is put into its landmark, so that the actor's hips stay where they are.
"""

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from kinesphere.data import Landmark, Limb, Skeleton, TopologicalModel
from kinesphere.labelling import built_in_model
from kinesphere.synthetic import Performance

Array = NDArray[np.float64]

HIPS = ("left_hip", "right_hip")
SPINES = ("LASI", "RASI", "LPSI", "RPSI")
DEVIATION_M = (0.0040, 0.0038, 0.0052)
"""m, standard deviation of people's hips from the regression inward, down and forward. Predicted
by leaving one out 3.2, 3.6, 5.2 mm (Harrington et al. 2007, doi:10.1016/j.jbiomech.2006.02.003),
3.8, 4.4, 5.2 (Hara et al. 2016, doi:10.1038/srep37707)."""
OF_WIDTH = {"depth": 0.65, "behind": 0.38}
"""Depth of a pelvis, and distance of the posterior spines, in widths."""
TILT_DEG = 12.0, 5.0
"""°, how far a pelvis dips to the front, mean and deviation."""


@dataclass(frozen=True)
class Dressed:
    """An actor who wears them."""

    performance: Performance
    landmarks: dict[str, Landmark]
    """Hip → where it is expected."""
    expected_mm: dict[str, float]
    """Hip → how far off that is."""


def wear_pelvis(
    performance: Performance, rng: np.random.Generator, *, times: float, misplaced: float
) -> Dressed:
    """Return the actor with spines.

    Parameters
    ----------
    times
        How many times as far as people's the hips are off the regression.
    misplaced
        m, how far each marker is off its spine, in a direction of its own.
    """
    hips = np.array([performance.skeleton.joint(name).centre_in_parent for name in HIPS])
    spines = _spines(hips, performance.skeleton.limbs[0], rng)
    put = rng.normal(size=spines.shape)
    spines = spines + misplaced * put / np.linalg.norm(put, axis=1)[:, None]
    joints = {joint.name: joint for joint in built_in_model("plugin-gait").joints}
    landmarks, expected = {}, {}
    for name, hip in zip(HIPS, hips, strict=True):
        book = joints[name].landmarks[0]
        deviation = times * rng.normal(size=3) * DEVIATION_M
        inward, down, forward = (float(x) for x in np.add(book.offset, deviation))
        landmarks[name] = replace(book, offset=(inward, down, forward))
        sign = 1.0 if name == "left_hip" else -1.0
        at = regression(spines) * (1, 1, -sign)
        off = hip - _placed(spines, at) - _along(spines, deviation, sign)
        expected[name] = 1e3 * float(np.linalg.norm(off))
    worn = _worn(performance.skeleton, spines)
    motion = replace(performance.motion, skeleton=worn)
    markers = motion.marker_positions()
    recording = replace(
        performance.recording,
        markers=np.stack(list(markers.values()), axis=1),
        labels=tuple(markers),
        residuals=None,
    )
    dressed = replace(
        performance,
        recording=recording,
        motion=motion,
        parameters=replace(performance.parameters, skeleton=worn),
        model=_marked(performance.model),
    )
    return Dressed(dressed, landmarks, expected)


def regression(spines: Array) -> Array:
    """Return the right hip as published, m forward, up and to the right of the ASIS' middle, (3,).

    x = −0.24 PD − 9.9 mm, y = −0.30 PW − 10.9 mm, z = 0.33 PW + 7.3 mm.

    Parameters
    ----------
    spines : (4, 3) m
        Left and right ASIS, left and right PSIS.
    """
    width = np.linalg.norm(spines[1] - spines[0])
    depth = np.linalg.norm(spines[:2].mean(axis=0) - spines[2:].mean(axis=0))
    return np.array([-0.24 * depth - 0.0099, -0.30 * width - 0.0109, 0.33 * width + 0.0073])


def pelvic_axes(spines: Array) -> Array:
    """Return forward, up and right of the pelvis as published, (3, 3), an axis a row."""
    right = (spines[1] - spines[0]) / np.linalg.norm(spines[1] - spines[0])
    ahead = spines[:2].mean(axis=0) - spines[2:].mean(axis=0)
    forward = ahead - (ahead @ right) * right
    forward /= np.linalg.norm(forward)
    return np.stack([forward, np.cross(right, forward), right])


def _placed(spines: Array, at: Array) -> Array:
    placed: Array = spines[:2].mean(axis=0) + at @ pelvic_axes(spines)
    return placed


def _along(spines: Array, deviation: Array, sign: float) -> Array:
    """Return a deviation inward, down and forward as the actor's limb has it."""
    inward, down, forward = deviation
    along: Array = np.array([forward, -down, sign * inward]) @ pelvic_axes(spines)
    return along


def _spines(hips: Array, root: Limb, rng: np.random.Generator) -> Array:
    """Return spines that put hips where these are on average, (4, 3) m."""
    apart = float(np.linalg.norm(hips[1] - hips[0]))
    right = (hips[1] - hips[0]) / apart
    width = (apart / 2 - 0.0073) / 0.33
    depth = OF_WIDTH["depth"] * width * rng.uniform(0.85, 1.15)
    up = root.long_axis - (root.long_axis @ right) * right
    up /= np.linalg.norm(up)
    tilt = np.deg2rad(rng.normal(*TILT_DEG))
    forward = np.cos(tilt) * np.cross(up, right) - np.sin(tilt) * up
    behind = OF_WIDTH["behind"] * width / 2 * right
    spines = np.array([-width / 2 * right, width / 2 * right, -behind, behind])
    spines[2:] -= depth * forward
    centres = [_placed(spines, regression(spines) * (1, 1, side)) for side in (-1, 1)]
    placed: Array = spines + np.mean(hips, axis=0) - np.mean(centres, axis=0)
    return placed


def _worn(skeleton: Skeleton, spines: Array) -> Skeleton:
    root, *others = skeleton.limbs
    limb = replace(
        root,
        markers=(*root.markers, *SPINES),
        marker_positions=np.vstack([root.marker_positions, spines]),
    )
    return replace(skeleton, limbs=(limb, *others))


def _marked(model: TopologicalModel) -> TopologicalModel:
    root, *others = model.segments
    return replace(
        model,
        segments=(replace(root, markers=(*root.markers, *SPINES)), *others),
        required=(*model.required, *SPINES),
        mirror=(*model.mirror, ("LASI", "RASI"), ("LPSI", "RPSI")),
    )
