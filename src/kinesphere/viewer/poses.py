"""Edited poses of any frame when it is looked at: a long take is never edited as a whole."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from kinesphere.data import Array, Parameters, Solution
from kinesphere.data.edits import Axis, Edit
from kinesphere.editing import edit_parameters, find_moves, moved_markers, moved_poses
from kinesphere.geometry.rotations import rotation_about

CHUNK = 64
"""Frames worked out together: hardly slower than one."""


class EditedPoses:
    """Poses and markers of a solution after edits, worked out where they are looked at.

    They are those of ``kinesphere.editing.apply_edits``, frame by frame.
    """

    def __init__(self, solution: Solution, edits: Sequence[Edit] = ()) -> None:
        self.solution = solution
        motion, recording = solution.motion, solution.recording
        self._rotations = np.array(motion.rotations)
        self._origins = np.array(motion.origins)
        self._markers = np.array(recording.markers)
        self._current = np.zeros(motion.n_frames, dtype=bool)
        self.edit(edits)

    def edit(self, edits: Sequence[Edit]) -> None:
        """Take other edits; BadSetting where one means nothing here."""
        self.parameters, _ = edit_parameters(self.solution.parameters, edits)
        self._current[:] = False

    def at(self, frame: int) -> tuple[Array, Array, Array]:
        """Return rotations (n_limbs, 3, 3), origins (n_limbs, 3), markers (n_markers, 3)."""
        if not self._current[frame]:
            self._update(np.array([frame]))
        return self._rotations[frame], self._origins[frame], self._markers[frame]

    def prepare(self, frame: int) -> None:
        """Work out the frames that will be shown next."""
        end = min(frame + CHUNK, len(self._current))
        wanted = frame + np.flatnonzero(~self._current[frame:end])
        if len(wanted):
            self._update(wanted)

    def _update(self, frames: NDArray[np.intp]) -> None:
        solution = self.solution
        moves = find_moves(solution.parameters, self.parameters, frames)
        self._rotations[frames], self._origins[frames] = moved_poses(solution.motion, moves, frames)
        self._markers[frames] = moved_markers(solution.recording, solution.motion, moves, frames)
        self._current[frames] = True


def turning_axes(parameters: Parameters, joint: int, frame: int) -> Array:
    """Return about which axes a limb turns in a pose, (n_axes + 1, 3), in the parent's frame.

    One row for each movement axis, the last for the twist. The angle about the first axis is
    taken first, so the later ones carry it along (`Joint`); angles that are NaN count as zero.
    """
    hung = parameters.skeleton.joints[joint]
    limb = parameters.skeleton.limbs[joint + 1]
    assert hung.axes is not None
    assert hung.rest is not None
    angles = np.nan_to_num(parameters.angles[frame, joint])
    carried = np.eye(3)
    found = []
    for k in reversed(range(hung.n_axes)):
        found.append(carried @ hung.axes[k])
        carried = carried @ rotation_about(hung.axes[k], angles[k : k + 1])[0]
    found = [*reversed(found), carried @ hung.rest @ limb.long_axis]
    return np.array(found)


def angle_deg(parameters: Parameters, frame: int, joint: int, axis: Axis) -> float:
    """Return an angle of a joint in a frame, deg: about a movement axis, or else the twist."""
    if isinstance(axis, int):
        return float(np.rad2deg(parameters.angles[frame, joint, axis - 1]))
    return float(np.rad2deg(parameters.twists[frame, joint]))
