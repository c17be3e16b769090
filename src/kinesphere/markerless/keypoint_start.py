"""The first pose by keypoints that a pose estimator found."""

from dataclasses import dataclass

import numpy as np

from kinesphere.data import Array, Scene
from kinesphere.data.keypoints import KEYPOINTS, PlacedKeypoints
from kinesphere.data.surface import Surface
from kinesphere.errors import KinesphereError
from kinesphere.markerless.anatomy import full_body
from kinesphere.markerless.keypoint_fit import fitted
from kinesphere.markerless.keypoint_marks import Marks, marks_of
from kinesphere.markerless.pose import Pose
from kinesphere.markerless.settings import TrackSettings
from kinesphere.markerless.shape import shaped
from kinesphere.markerless.triangulation import triangulated

_BONES = tuple(
    (f"{side}_{a}", f"{side}_{b}")
    for side in ("left", "right")
    for a, b in (("shoulder", "elbow"), ("elbow", "wrist"), ("hip", "knee"), ("knee", "ankle"))
)
_SMALLEST, _LARGEST = -0.45, 0.35
"""Logarithms of sizes that people have, beside the bundled body."""
_OFF = 0.08
"""m; keypoints that miss a fitted body by more, in the middle, are not a person's."""
_ALIKE = 0.5
"""Share of what two cameras see that must be at one place in both."""
_LIMBS = {"arm": ("elbow", "wrist"), "leg": ("knee", "ankle")}


class UnusableKeypoints(KinesphereError):
    """Keypoints show no pose; the message says why."""


@dataclass(frozen=True, eq=False)
class KnownPose:
    """What keypoints tell of the first pose."""

    pose: Pose
    """Of the full body."""
    logs: Array
    """(n_factors,) logarithms of the factors of `shape`."""
    points: Array
    """(n_keypoints, 3) m, what it was fitted to; NaN where not known."""
    warnings: tuple[str, ...]


def pose_from_keypoints(
    scene: Scene, surface: Surface, logs: Array, settings: TrackSettings, *, sizes: bool
) -> KnownPose:
    """Return the full body's pose by the keypoints of the scene's start.

    Trunk, then arms and legs are put by the keypoints' directions, then all joints fitted. The
    body's size is the median of what the lengths of arms and legs say.

    Parameters
    ----------
    logs
        Proportions known so far.
    sizes
        Whether the body's size may change.

    Raises
    ------
    UnusableKeypoints
        If they are too few, contradict the cameras, or are no person's.
    """
    points = _placed(scene)
    at = {n: p for n, p in zip(KEYPOINTS, points, strict=True) if np.isfinite(p).all()}
    trunk = [[n for n in at if n.endswith(what)] for what in ("hip", "shoulder")]
    if not all(trunk) or sum(map(len, trunk)) < 3:
        raise UnusableKeypoints(
            f"they place {', '.join(at) or 'nothing'}; a shoulder and both hips, or a hip and both "
            "shoulders, are needed"
        )
    body = full_body(shaped(surface, logs))
    marks = marks_of(body)
    size = _size(marks, at)
    if not _SMALLEST < size < _LARGEST:
        raise UnusableKeypoints(
            f"arms and legs would be {np.exp(size):.2g} times as long as the body model's; "
            "a wrong unit or calibration may be the reason"
        )
    if sizes:
        logs = logs.copy()
        logs[0] += size
        body = full_body(shaped(surface, logs))
        marks = marks_of(body)
    pose, off = fitted(body, marks, points, settings)
    if np.nanmedian(off) > _OFF:
        raise UnusableKeypoints(
            f"the body model misses them by {np.nanmedian(off) * 1e3:.0f} mm in the middle"
        )
    bare = [
        f"{side} {limb}"
        for side in ("left", "right")
        for limb, joints in _LIMBS.items()
        if any(f"{side}_{joint}" not in at for joint in joints)
    ]
    said = f"keypoints do not show the whole {', '.join(bare)}; it starts as if at rest"
    return KnownPose(pose, logs, points, (said,) if bare else ())


def _placed(scene: Scene) -> Array:
    keypoints = scene.start.keypoints
    assert keypoints is not None
    if isinstance(keypoints, PlacedKeypoints):
        return keypoints.points
    found = triangulated(scene.cameras, keypoints.pixels, keypoints.confidence)
    agreed = int(np.isfinite(found.points).all(axis=1).sum())
    if agreed < _ALIKE * found.seen:
        raise UnusableKeypoints(
            f"of {found.seen} that two cameras see {found.seen - agreed} are nowhere in space; the "
            "cameras may show different people, or keypoints belong to other frames or calibrations"
        )
    return found.points


def _size(marks: Marks, at: dict[str, Array]) -> float:
    """Return the logarithm of how much longer limbs are than the body's; 0 if none is known."""
    own = dict(zip(KEYPOINTS, marks.places, strict=True))
    told = [
        np.log(max(float(np.linalg.norm(at[a] - at[b])), 1e-6) / np.linalg.norm(own[a] - own[b]))
        for a, b in _BONES
        if a in at and b in at
    ]
    return float(np.median(told)) if told else 0.0
