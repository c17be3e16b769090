"""``parameters.csv``: a row a frame, which together with ``skeleton.json`` rebuilds every pose."""

from pathlib import Path

import numpy as np
from scipy.spatial.transform import Rotation

from kinesphere.data import Array, Parameters, Skeleton, Step
from kinesphere.errors import BadModel, UnreadableFile
from kinesphere.geometry.rotations import canonical_quaternions
from kinesphere.io.csv import TIME_FORMAT, rate_of, read_columns, write_columns
from kinesphere.io.skeleton_json import read_skeleton

_ROOT = ["root.x_m", "root.y_m", "root.z_m", "root.qx", "root.qy", "root.qz", "root.qw"]


def write_parameters(parameters: Parameters, path: str | Path) -> None:
    """Write the root pose and every joint's angles, twist, residual and flag.

    Angles are printed to 1e-10° and places to 1e-9 m, so that rounding moves no point of a body by
    more than 1e-8 m.
    NaN becomes a blank cell. First frame number, movement mask and history are not in the table.

    Raises
    ------
    BadModel
        If a joint has no axes yet.
    """
    joints = parameters.skeleton.joints
    if lacking := [joint.name for joint in joints if joint.axes is None]:
        raise BadModel(f"joint {lacking[0]} has no movement axes yet: parameterize first")
    columns = [parameters.times[:, None], parameters.root_positions]
    columns.append(canonical_quaternions(parameters.root_rotations))
    formats = [TIME_FORMAT, "%.9f", "%.12f"]
    for j, joint in enumerate(joints):
        columns += [
            np.degrees(parameters.angles[:, j, : joint.n_axes]),
            np.degrees(parameters.twists[:, j, None]),
            parameters.residuals[:, j, None] * 1e3,
            parameters.flags[:, j, None].astype(np.float64),
        ]
        formats += ["%.10f", "%.10f", "%.6f", "%d"]
    write_columns(path, _column_names(parameters.skeleton), columns, formats)


def read_parameters(path: str | Path, skeleton: Skeleton | None = None) -> Parameters:
    """Read a table of parameters.

    Columns may stand in any order, and others among them are passed over. The table does not
    hold the movement mask nor the number of the first frame: ``moving`` is False, the number 1.

    Parameters
    ----------
    skeleton
        Whose joints the columns belong to; None to read ``skeleton.json`` beside the table.

    Raises
    ------
    UnreadableFile
        If a column is missing, a flag is none, or a line is damaged.
    """
    path = Path(path)
    if skeleton is None:
        skeleton = read_skeleton(path.with_name("skeleton.json"))
    table = read_columns(path)
    wanted = _column_names(skeleton)
    at = {name: i for i, name in enumerate(table.names)}
    if missing := [name for name in wanted if name not in at]:
        more = f" and {len(missing) - 1} more" if len(missing) > 1 else ""
        raise UnreadableFile(f"{path}: line 1 has no column {missing[0]}{more}")
    table = table._replace(names=wanted, values=table.values[:, [at[name] for name in wanted]])
    rate, warnings = rate_of(table, path)
    n, n_joints = len(table.values), len(skeleton.joints)
    angles = np.full((n, n_joints, 3), np.nan)
    twists, residuals, flags = (np.full((n, n_joints), np.nan) for _ in range(3))
    column = 1 + len(_ROOT)
    for j, joint in enumerate(skeleton.joints):
        block = table.values[:, column : column + joint.n_axes + 3]
        angles[:, j, : joint.n_axes] = np.radians(block[:, :-3])
        twists[:, j], residuals[:, j], flags[:, j] = np.radians(block[:, -3]), *block[:, -2:].T
        residuals[:, j] /= 1e3
        column += joint.n_axes + 3
    bad = ~(np.isin(flags, np.arange(256))).all(axis=1)
    if bad.any():
        line = table.lines[int(bad.argmax())]
        raise UnreadableFile(f"{path}: line {line} holds a flag that is no whole number 0…255")
    step = Step(
        name="read",
        settings={"format": "parameters", "file": path.name},
        findings={"n_frames": n, "n_joints": n_joints, "rate_hz": rate},
        warnings=warnings,
    )
    return Parameters(
        skeleton=skeleton,
        root_positions=table.values[:, 1:4],
        root_rotations=_matrices(table.values[:, 4:8]),
        angles=angles,
        twists=twists,
        residuals=residuals,
        flags=flags.astype(np.uint8),
        moving=np.zeros((n, n_joints), dtype=np.bool_),
        rate=rate,
        history=(*skeleton.history, step),
    )


def _column_names(skeleton: Skeleton) -> list[str]:
    names = ["time_s", *_ROOT]
    for joint in skeleton.joints:
        names += [f"{joint.name}.axis{k}_deg" for k in range(1, joint.n_axes + 1)]
        names += [f"{joint.name}.{what}" for what in ("twist_deg", "residual_mm", "flag")]
    return names


def _matrices(quaternions: Array) -> Array:
    known = np.linalg.norm(quaternions, axis=1) > 0  # False for NaN
    rotations = np.full((len(quaternions), 3, 3), np.nan)
    if known.any():
        rotations[known] = Rotation.from_quat(quaternions[known]).as_matrix()
    return rotations
