"""Edits on the parameters: angles of joints, and the pose of the root."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from kinesphere.data import Array, Parameters
from kinesphere.data.edits import ROOT, Edit
from kinesphere.editing.weights import edit_weights
from kinesphere.errors import BadSetting
from kinesphere.geometry.rotations import rotation_about

_WORLD = {"x": 0, "y": 1, "z": 2}


def edit_parameters(
    parameters: Parameters, edits: Sequence[Edit]
) -> tuple[Parameters, dict[str, int]]:
    """Return parameters whose angles are edited one after another, and frames changed per joint.

    Raises
    ------
    BadSetting
        If an edit names a joint or an axis that is not there, or frames outside the motion.
    """
    angles, twists = np.array(parameters.angles), np.array(parameters.twists)
    turns, places = np.array(parameters.root_rotations), np.array(parameters.root_positions)
    changed: dict[str, int] = {}
    for number, edit in enumerate(edits, start=1):
        try:
            weights = edit_weights(
                edit, parameters.n_frames, parameters.rate, parameters.first_frame
            )
            if edit.joint == ROOT:
                _edit_root(edit, weights, turns, places)
            else:
                column = _column(parameters, edit, angles, twists)
                weights[np.isnan(column)] = 0.0
                column += weights * _change(edit, column)
                column[:] = _half_open(column)
        except BadSetting as error:
            raise BadSetting(f"edit {number}: {error}") from error
        changed[edit.joint] = changed.get(edit.joint, 0) + int((weights > 0).sum())
    edited = replace(
        parameters, angles=angles, twists=twists, root_rotations=turns, root_positions=places
    )
    return edited, changed


def unseen_edits(parameters: Parameters, edits: Sequence[Edit]) -> list[str]:
    """Return a sentence for each edit that changes nothing: its angle is NaN in all its frames."""
    said = []
    for number, edit in enumerate(edits, start=1):
        if edit.joint == ROOT:
            continue
        chosen = edit_weights(edit, parameters.n_frames, parameters.rate, parameters.first_frame)
        column = _column(parameters, edit, parameters.angles, parameters.twists)
        if np.isnan(column[chosen > 0]).all():
            axis = edit.axis if edit.axis == "twist" else f"axis {edit.axis}"
            said.append(
                f"edit {number} changes nothing: {axis} of {edit.joint} is known in none of its "
                "frames"
            )
    return said


def _edit_root(edit: Edit, weights: Array, turns: Array, places: Array) -> None:
    if isinstance(edit.axis, int):
        assert edit.add_deg is not None
        touched = weights > 0  # the rest stays to the bit
        angles = np.deg2rad(edit.add_deg) * weights[touched]
        turns[touched] = turns[touched] @ rotation_about(np.eye(3)[edit.axis - 1], angles)
    else:
        assert edit.add_m is not None
        places[:, _WORLD[edit.axis]] += edit.add_m * weights


def _column(parameters: Parameters, edit: Edit, angles: Array, twists: Array) -> Array:
    """Return a view of the angle that an edit changes, (n_frames,) rad."""
    names = parameters.skeleton.joint_names
    if edit.joint not in names:
        raise BadSetting(
            f"there is no joint {edit.joint!r}; the joints are {', '.join(names)}, and {ROOT!r}"
        )
    j = names.index(edit.joint)
    if edit.axis == "twist":
        return twists[:, j]
    n_axes = parameters.skeleton.joints[j].n_axes
    if not isinstance(edit.axis, int) or edit.axis > n_axes:
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
