"""Motion without markers: cameras, silhouettes, correspondences, pose (Rosenhahn et al. 2006).

What needs OpenCV is not fetched here: ``markerless.tracker.track`` and
``markerless.checks.check_scene``.
"""

from kinesphere.markerless.result import motion_from_tracked as motion_from_tracked
from kinesphere.markerless.result import recording_of as recording_of
from kinesphere.markerless.result import tracking_step as tracking_step
from kinesphere.markerless.result import with_first_frame as with_first_frame
from kinesphere.markerless.settings import TrackSettings as TrackSettings
from kinesphere.markerless.tracked import PosedBody as PosedBody
from kinesphere.markerless.tracked import TrackedMotion as TrackedMotion
