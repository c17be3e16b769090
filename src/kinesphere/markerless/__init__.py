"""Motion without markers: cameras, silhouettes, correspondences, pose (Rosenhahn et al. 2006)."""

from kinesphere.markerless.tracked import PosedBody as PosedBody
from kinesphere.markerless.tracked import TrackedMotion as TrackedMotion
