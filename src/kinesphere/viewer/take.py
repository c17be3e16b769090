"""What the viewer shows: a bare recording, a motion, or a solution with its edits."""

from dataclasses import dataclass, field

import numpy as np

from kinesphere.data import Array, Motion, Recording, Skeleton, Solution
from kinesphere.errors import BadRecording, KinesphereError
from kinesphere.quality import orient
from kinesphere.viewer.poses import EditedPoses
from kinesphere.viewer.stage import Shown


@dataclass(frozen=True)
class Take:
    """A recording on view, with y up."""

    recording: Recording
    solution: Solution | None
    poses: EditedPoses | None
    """None where there are no joint parameters to edit."""
    motion: Motion | None = None
    notes: tuple[str, ...] = field(default=())
    """What a person should know of how it is shown."""

    @property
    def skeleton(self) -> Skeleton | None:
        """The skeleton, if there is one."""
        if self.solution is not None:
            return self.solution.skeleton
        return None if self.motion is None else self.motion.skeleton

    def at(self, frame: int) -> Shown:
        """Return rotations and origins of the limbs, and markers, of one frame."""
        if self.poses is not None:
            return self.poses.at(frame)
        if self.motion is not None:
            return self.motion.rotations[frame], self.motion.origins[frame], np.empty((0, 3))
        return None, None, self.recording.markers[frame]

    def middle(self) -> Array:
        """Return where the figure is at the beginning, (3,) m."""
        markers = self.recording.markers
        seen = np.flatnonzero(self.recording.seen.any(axis=1))
        if len(seen):
            return np.asarray(np.nanmedian(markers[seen[0]], axis=0))
        if self.motion is not None:
            known = np.isfinite(self.motion.origins).all(axis=(1, 2))
            if known.any():
                return np.asarray(self.motion.origins[known.argmax()].mean(axis=0))
        return np.array([0.0, 0.9, 0.0])

    def facing(self) -> Array:
        """Return the axes forward, up and to the right of the figure at the beginning, (3, 3)."""
        if self.motion is not None:
            ahead = self.motion.rotations[:, 0, :, 0] * (1.0, 0.0, 1.0)
            known = np.flatnonzero(np.linalg.norm(ahead, axis=1) > 0.1)
            if len(known):
                forward = ahead[known[0]] / np.linalg.norm(ahead[known[0]])
                up = np.array([0.0, 1.0, 0.0])
                return np.stack([forward, up, np.cross(forward, up)], axis=1)
        return np.eye(3)

    def floor(self) -> float:
        """Return how high the floor is, m: the world's, unless everything is elsewhere."""
        heights = self.recording.markers[:: max(1, len(self.recording.markers) // 200), :, 1]
        known = heights[np.isfinite(heights)]
        low = float(np.quantile(known, 0.005)) if len(known) else 0.0
        return 0.0 if abs(low) < 0.15 else low - 0.03


def take_from(found: object, name: str) -> Take:
    """Return what can be shown of what a file held.

    Raises
    ------
    BadRecording
        If it is neither a recording nor a solution, or has no frame.
    """
    if isinstance(found, Solution):
        if found.motion.n_frames == 0:
            raise BadRecording(f"{name} has no frames; there is nothing to show")
        return Take(found.recording, found, EditedPoses(found), found.motion)
    if isinstance(found, Motion):
        if found.n_frames == 0:
            raise BadRecording(f"{name} has no frames; there is nothing to show")
        nothing = np.empty((found.n_frames, 0, 3))
        bare = Recording(nothing, (), found.rate, found.first_frame)
        return Take(bare, None, None, found)
    if not isinstance(found, Recording):
        raise BadRecording(
            f"{name} holds a {type(found).__name__}; a recording, a motion or a solved folder "
            "can be viewed"
        )
    if found.n_frames == 0 or not found.seen.any():
        raise BadRecording(f"{name} has no marker in any frame; there is nothing to show")
    try:
        return Take(orient(found), None, None)
    except KinesphereError as error:
        return Take(found, None, None, None, (f"shown in the axes of the file: {error}",))
