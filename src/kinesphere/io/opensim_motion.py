"""The parameters as an OpenSim motion: one column per coordinate of the model beside it."""

from pathlib import Path

import numpy as np

from kinesphere.data import Array, Parameters
from kinesphere.data.conventions import POSE, WRITTEN_BY
from kinesphere.geometry.euler import continuous_angles, euler_angles
from kinesphere.io.atomic import replacing
from kinesphere.io.holding import held
from kinesphere.io.opensim_joints import COORDINATES, joint_coordinates, root_coordinates
from kinesphere.io.tables import format_rows


def write_mot(parameters: Parameters, path: str | Path) -> None:
    """Write the coordinates of the model that ``write_osim`` writes of the same skeleton.

    Angles in degrees, translations in metres. A motion file has no gaps: a twist that is NaN is
    0, as wherever poses are rebuilt; any other gap holds the last known value (before the first,
    that one; never known, 0).
    """
    skeleton = parameters.skeleton
    root = held(parameters.root_rotations, np.eye(3))
    columns: list[Array] = [
        parameters.times[:, None],
        np.degrees(continuous_angles(euler_angles(root, "xyz"))),
        held(parameters.root_positions, np.zeros(3)),
    ]
    names = ["time", *root_coordinates(skeleton)]
    for j, joint in enumerate(skeleton.joints):
        turns = np.column_stack([parameters.angles[:, j, : joint.n_axes], parameters.twists[:, j]])
        seen = np.isfinite(turns[:, :-1]).all(axis=1)
        turns[seen, -1] = np.nan_to_num(turns[seen, -1], nan=0.0)
        columns.append(np.degrees(held(turns, np.zeros(joint.n_axes + 1))))
        names += joint_coordinates(skeleton, j)
    head = [
        "Coordinates",
        "version=1",
        f"nRows={parameters.n_frames}",
        f"nColumns={len(names)}",
        "inDegrees=yes",
        "Units are S.I. units (second, meters, Newtons, ...)",
        "Angles are in degrees.",
        f"{WRITTEN_BY}: coordinates of the .osim model beside it. {POSE} {COORDINATES}".replace(
            "=", "is"
        ),
        "endheader",
        "\t".join(names),
    ]
    text = "\n".join(head) + "\n" + format_rows(columns, ["%.9f"] * len(columns), "\t")
    with replacing(path) as temporary:
        temporary.write_text(text, encoding="utf-8", newline="\n")
