"""Keypoints of one instant, as a pose estimator found them: in the images, or in space."""

from dataclasses import dataclass

from kinesphere.data.arrays import Array, frozen

_PAIRS = ("ear", "shoulder", "elbow", "wrist", "hip", "knee", "ankle", "big_toe", "heel")

KEYPOINTS: tuple[str, ...] = ("nose", *(f"{s}_{p}" for p in _PAIRS for s in ("left", "right")))
"""What is used of every set, in the order of all arrays below."""


@dataclass(frozen=True, eq=False)
class SeenKeypoints:
    """What each camera saw of one person."""

    pixels: Array
    """(n_cameras, n_keypoints, 2) px of the camera's image; NaN where not seen."""
    confidence: Array
    """(n_cameras, n_keypoints) 0 to 1, by the estimator's own word; 0 where not seen."""

    def __post_init__(self) -> None:
        n = len(KEYPOINTS)
        object.__setattr__(self, "pixels", frozen(self.pixels, None, n, 2, name="pixels"))
        object.__setattr__(self, "confidence", frozen(self.confidence, None, n, name="confidence"))


@dataclass(frozen=True, eq=False)
class PlacedKeypoints:
    """Where one person's keypoints are."""

    points: Array
    """(n_keypoints, 3) m in the scene's world; NaN where not seen."""

    def __post_init__(self) -> None:
        points = frozen(self.points, len(KEYPOINTS), 3, name="points")
        object.__setattr__(self, "points", points)
