"""Edited parameters, the poses that follow from them, and the markers that ride along."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from kinesphere import __version__
from kinesphere.data import (
    Array,
    Motion,
    Parameters,
    Recording,
    Solution,
    Step,
    motion_from_parameters,
)
from kinesphere.data.edits import Edit
from kinesphere.editing.parameters import edit_parameters, unseen_edits


@dataclass(frozen=True)
class Moves:
    """How edits move each limb in the world: ``after = turns @ before + shifts``."""

    turns: Array
    """(n_frames, n_limbs, 3, 3)."""
    shifts: Array
    """(n_frames, n_limbs, 3) m."""


def apply_edits(solution: Solution, edits: Sequence[Edit]) -> Solution:
    """Return a solution whose joint parameters are edited, and everything that follows from them.

    Angles are changed one edit after another. Each limb then moves as the rebuilt motion does
    between its parameters before and after, so what no edit touches stays as it was measured, to
    the bit, and what a pose holds beside its parameters (`Parameters.residuals`) is kept. Markers
    ride with their limbs.

    Parameters
    ----------
    solution
        Solved: its joints have axes.
    edits
        Applied in this order.

    Returns
    -------
    Solution
        Its history says which edits were made, and which change nothing: angles that are NaN
        stay so.

    Raises
    ------
    BadSetting
        If an edit names a joint or an axis that is not there, or frames outside the motion.

    References
    ----------
    Sar Dessai, Hornung & Kobbelt 2006, section 5 and figure 5.
    """
    parameters = solution.parameters
    edited, changed = edit_parameters(parameters, edits)
    step = Step(
        "editing",
        {"edits": [edit.model_dump(mode="json", exclude_none=True) for edit in edits]},
        {"frames": dict(changed)},
        (*unseen_edits(parameters, edits), *_warnings(solution.recording)),
        __version__,
    )
    history = (*solution.history, step)
    skeleton = replace(parameters.skeleton, history=(*parameters.skeleton.history, step))
    edited = replace(edited, skeleton=skeleton, history=history)
    moves = find_moves(parameters, edited)
    motion, recording = solution.motion, solution.recording
    rotations, origins = moved_poses(motion, moves)
    return replace(
        solution,
        parameters=edited,
        motion=replace(
            motion, rotations=rotations, origins=origins, history=(*motion.history, step)
        ),
        recording=replace(
            recording,
            markers=moved_markers(recording, motion, moves),
            history=(*recording.history, step),
        ),
    )


def find_moves(
    before: Parameters, after: Parameters, frames: NDArray[np.intp] | None = None
) -> Moves:
    """Return how each limb moves in the world from one set of parameters to the other.

    Not at all where the rebuilt poses are the same, or where parameters that are NaN tell none.

    Parameters
    ----------
    frames : (n,)
        Which; all by default.
    """
    if frames is not None:
        before, after = _at(before, frames), _at(after, frames)
    old, new = motion_from_parameters(before), motion_from_parameters(after)
    turns = new.rotations @ np.swapaxes(old.rotations, -1, -2)
    shifts = new.origins - (turns @ old.origins[..., None])[..., 0]
    same = (new.rotations == old.rotations).all(axis=(2, 3)) & (new.origins == old.origins).all(
        axis=2
    )
    still = same | ~np.isfinite(shifts).all(axis=2)
    turns[still] = np.eye(3)
    shifts[still] = 0.0
    return Moves(turns, shifts)


def moved_poses(
    motion: Motion, moves: Moves, frames: NDArray[np.intp] | None = None
) -> tuple[Array, Array]:
    """Return rotations (n, n_limbs, 3, 3) and origins (n, n_limbs, 3) after the moves."""
    every = slice(None) if frames is None else frames
    turned = (moves.turns @ motion.origins[every][..., None])[..., 0]
    return moves.turns @ motion.rotations[every], turned + moves.shifts


def moved_markers(
    recording: Recording, motion: Motion, moves: Moves, frames: NDArray[np.intp] | None = None
) -> Array:
    """Return where the markers ride, (n, n_markers, 3) m; those no limb wears stay."""
    markers = np.array(recording.markers if frames is None else recording.markers[frames])
    for i, limb in enumerate(motion.skeleton.limbs):
        at = [recording.labels.index(label) for label in limb.markers if label in recording.labels]
        turned = (moves.turns[:, i, None] @ markers[:, at, :, None])[..., 0]
        markers[:, at] = turned + moves.shifts[:, i, None]
    return markers


def _at(parameters: Parameters, frames: NDArray[np.intp]) -> Parameters:
    return replace(
        parameters,
        root_positions=parameters.root_positions[frames],
        root_rotations=parameters.root_rotations[frames],
        angles=parameters.angles[frames],
        twists=parameters.twists[frames],
        residuals=parameters.residuals[frames],
        flags=parameters.flags[frames],
        moving=parameters.moving[frames],
    )


def _warnings(recording: Recording) -> tuple[str, ...]:
    held = [
        name
        for name, there in (("outputs of other programs", recording.outputs),
                            ("analog channels", recording.analog))
        if there
    ]  # fmt: skip
    if not held:
        return ()
    return (f"{' and '.join(held)} in the file tell of the motion before it was edited",)
