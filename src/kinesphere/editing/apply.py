"""Edited angles, the poses that follow from them, and the markers that ride along."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

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
from kinesphere.editing.weights import edit_weights
from kinesphere.errors import BadSetting


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
        Its history says which edits were made. Angles that are NaN stay so.

    Raises
    ------
    BadSetting
        If an edit names a joint or an axis that is not there, or frames outside the motion.

    References
    ----------
    Sar Dessai, Hornung & Kobbelt 2006, section 5 and figure 5.
    """
    parameters = solution.parameters
    angles, twists = np.array(parameters.angles), np.array(parameters.twists)
    changed: dict[str, int] = {}
    for number, edit in enumerate(edits, start=1):
        try:
            column = _column(parameters, edit, angles, twists)
            weights = edit_weights(
                edit, parameters.n_frames, parameters.rate, parameters.first_frame
            )
        except BadSetting as error:
            raise BadSetting(f"edit {number}: {error}") from error
        column += weights * _change(edit, column)
        column[:] = _half_open(column)
        changed[edit.joint] = changed.get(edit.joint, 0) + int((weights > 0).sum())
    step = Step(
        "editing",
        {"edits": [edit.model_dump(mode="json", exclude_none=True) for edit in edits]},
        {"frames": dict(changed)},
        _warnings(solution.recording),
        __version__,
    )
    history = (*solution.history, step)
    skeleton = replace(parameters.skeleton, history=(*parameters.skeleton.history, step))
    edited = replace(parameters, angles=angles, twists=twists, skeleton=skeleton, history=history)
    turns, shifts = _moves(parameters, edited)
    return replace(
        solution,
        parameters=edited,
        motion=_moved_motion(solution.motion, turns, shifts, step),
        recording=_moved_recording(solution.recording, solution.motion, turns, shifts, step),
    )


def _column(parameters: Parameters, edit: Edit, angles: Array, twists: Array) -> Array:
    """Return a view of the angle that an edit changes, (n_frames,) rad."""
    names = parameters.skeleton.joint_names
    if edit.joint not in names:
        raise BadSetting(f"there is no joint {edit.joint!r}; the joints are {', '.join(names)}")
    j = names.index(edit.joint)
    if edit.axis == "twist":
        return twists[:, j]
    n_axes = parameters.skeleton.joints[j].n_axes
    if edit.axis > n_axes:
        there = ", ".join(str(k + 1) for k in range(n_axes))
        raise BadSetting(f"{edit.joint} has no axis {edit.axis}; it has {there} and 'twist'")
    return angles[:, j, edit.axis - 1]


def _change(edit: Edit, column: Array) -> Array:
    """Return what the whole of an edit adds to each angle, (n_frames,) rad."""
    if edit.add_deg is not None:
        return np.full(len(column), np.deg2rad(edit.add_deg))
    assert edit.set_deg is not None
    return _half_open(np.deg2rad(edit.set_deg) - column)


def _half_open(angles: Array) -> Array:
    """Return angles in (−π, π]; those that are there already unchanged to the bit."""
    wrapped = np.pi - np.mod(np.pi - angles, 2 * np.pi)
    with np.errstate(invalid="ignore"):
        return np.asarray(np.where(np.abs(angles) <= np.pi, angles, wrapped))


def _moves(before: Parameters, after: Parameters) -> tuple[Array, Array]:
    """Return how each limb moves in the world, turns (n, n_limbs, 3, 3) and shifts (n, n_limbs, 3).

    Nothing where the rebuilt poses are the same, or where parameters that are NaN tell none.
    """
    old, new = motion_from_parameters(before), motion_from_parameters(after)
    turns = new.rotations @ np.swapaxes(old.rotations, -1, -2)
    shifts = new.origins - (turns @ old.origins[..., None])[..., 0]
    same = (new.rotations == old.rotations).all(axis=(2, 3)) & (new.origins == old.origins).all(
        axis=2
    )
    still = same | ~np.isfinite(shifts).all(axis=2)
    turns[still] = np.eye(3)
    shifts[still] = 0.0
    return turns, shifts


def _moved_motion(motion: Motion, turns: Array, shifts: Array, step: Step) -> Motion:
    return replace(
        motion,
        rotations=turns @ motion.rotations,
        origins=(turns @ motion.origins[..., None])[..., 0] + shifts,
        history=(*motion.history, step),
    )


def _moved_recording(
    recording: Recording, motion: Motion, turns: Array, shifts: Array, step: Step
) -> Recording:
    markers = np.array(recording.markers)
    for i, limb in enumerate(motion.skeleton.limbs):
        at = [recording.labels.index(label) for label in limb.markers if label in recording.labels]
        markers[:, at] = (turns[:, i, None] @ markers[:, at, :, None])[..., 0] + shifts[:, i, None]
    return replace(recording, markers=markers, history=(*recording.history, step))


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
