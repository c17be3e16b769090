"""A solved folder: everything one run found out, in the files that others use."""

from collections.abc import Callable, Iterable, Mapping
from dataclasses import asdict, replace
from pathlib import Path

import numpy as np

from kinesphere.data import Recording, Solution
from kinesphere.data.isb import isb_angles
from kinesphere.errors import BadSetting, UnreadableFile
from kinesphere.io.atomic import check_directory_place, replacing_directory
from kinesphere.io.bvh import write_bvh
from kinesphere.io.bvh_settings import BvhSettings
from kinesphere.io.c3d import read_c3d, write_c3d
from kinesphere.io.gltf import write_solution_gltf
from kinesphere.io.isb_csv import write_isb_angles
from kinesphere.io.joint_points import recording_of_joints, with_joints, without_notes
from kinesphere.io.opensim import write_osim
from kinesphere.io.opensim_joints import opensim_name
from kinesphere.io.opensim_motion import write_mot
from kinesphere.io.parameters_csv import write_parameters
from kinesphere.io.skeleton_json import write_skeleton
from kinesphere.io.solution_arrays import read_solution_arrays, write_solution_arrays
from kinesphere.io.summary import read_seconds, write_summary
from kinesphere.io.trc import write_trc

ARRAYS = "solution.npz"
RECORDING = "recording.c3d"
MOTION_GLB = "motion.glb"
"""Older folders are whole without it."""
FILES = (
    RECORDING,
    "skeleton.json",
    "parameters.csv",
    "motion.bvh",
    MOTION_GLB,
    "motion.trc",
    "motion.mot",
    "motion.osim",
    ARRAYS,
    "summary.json",
)
"""What ``write_solution`` writes by itself."""
ISB_ANGLES = "isb_angles.csv"
"""Written where joints have names; older folders are whole without it."""
_OF_CAMERAS = ("overlays.jpg", "overlays.mp4", "tracking.csv")
_LEFT_BEHIND = (".DS_Store", "Thumbs.db", "desktop.ini")
_BESIDE = (ISB_ANGLES, "report.html", *_OF_CAMERAS, *_LEFT_BEHIND)
"""What may stand beside them: reports, pictures, and what file managers leave behind."""
_C3D = "c3d"


def write_solution(
    solution: Solution,
    directory: str | Path,
    extra: Mapping[str, str | bytes] | None = None,
    bvh: BvhSettings | None = None,
) -> None:
    """Write a solved folder; it appears whole or not at all.

    Parameters
    ----------
    directory
        A new or empty folder, or a solved one, which is replaced.
    extra
        Further files: name → text or bytes (``{"report.html": page}``).
    bvh
        What ``motion.bvh`` is like.

    Raises
    ------
    KinesphereError
        If the folder holds files that are not a solution's, or cannot be written.
    """
    extra = dict(extra or {})
    for name in extra:
        if name in ("", "..") or Path(name).name != name or name in (*FILES, ISB_ANGLES):
            raise BadSetting(f"{name!r} cannot be added: a plain name was expected, and a new one")
    recording, skeleton = solution.recording, solution.skeleton
    details = {k: None if k == _C3D else v for k, v in recording.details.items()}
    bare = replace(solution, recording=replace(recording, details=details))
    with replacing_directory(directory, _others(extra)) as folder:
        write_c3d(with_joints(solution), folder / RECORDING)
        write_skeleton(skeleton, folder / "skeleton.json")
        write_parameters(solution.parameters, folder / "parameters.csv")
        if (clinical := isb_angles(solution.motion, skeleton)).joints:
            write_isb_angles(clinical, folder / ISB_ANGLES)
        write_bvh(solution.motion, folder / "motion.bvh", **asdict(bvh or BvhSettings()))
        write_solution_gltf(solution, folder / MOTION_GLB)
        write_trc(_model_markers(solution), folder / "motion.trc")
        write_mot(solution.parameters, folder / "motion.mot")
        write_osim(skeleton, folder / "motion.osim")
        write_solution_arrays(bare, folder / ARRAYS)
        write_summary(solution, folder / "summary.json")
        for name, content in extra.items():
            raw = content.encode() if isinstance(content, str) else content
            (folder / name).write_bytes(raw)


def check_solution_place(directory: str | Path, extra: Iterable[str] = ()) -> None:
    """Raise UnwritableFile unless `write_solution` could write there; nothing is written.

    Parameters
    ----------
    extra
        Names of the further files.
    """
    check_directory_place(directory, _others(extra))


def _others(extra: Iterable[str]) -> Callable[[Path], set[str]]:
    """Return what tells which files in a folder are not a solution's."""
    ours = {*FILES, *_BESIDE, *extra}
    return lambda folder: {entry.name for entry in folder.iterdir()} - ours


def read_solution(directory: str | Path) -> Solution:
    """Read a solved folder back, arrays to the last bit and history included.

    Everything comes from ``solution.npz``, but for what a C3D file needs to be written back
    without loss, which comes from ``recording.c3d``, and how long stages took, from
    ``summary.json``; the other files are for other programs.

    Raises
    ------
    UnreadableFile
        If this is no folder, none of ours, or a file in it is missing or damaged.
    """
    directory = Path(directory)
    if not directory.is_dir():
        found = "a file" if directory.exists() else "not there"
        raise UnreadableFile(f"{directory} is {found}; a solved folder was expected")
    if not (directory / ARRAYS).is_file():
        raise UnreadableFile(f"{directory} holds no {ARRAYS}: it is no solved folder")
    wanted = (name for name in FILES if name != MOTION_GLB)
    if missing := [name for name in wanted if not (directory / name).is_file()]:
        raise UnreadableFile(f"{directory} is not whole: {', '.join(missing)} missing")
    solution = read_solution_arrays(directory / ARRAYS)
    solution = replace(solution, seconds=read_seconds(directory / "summary.json"))
    recording = solution.recording
    if _C3D not in recording.details:
        return solution
    source = read_c3d(directory / RECORDING).details[_C3D]
    details = {**recording.details, _C3D: without_notes(source)}
    return replace(solution, recording=replace(recording, details=details))


def _model_markers(solution: Solution) -> Recording:
    """Return the markers the OpenSim model has, as it names them, in the world it lives in.

    Of a solution without markers, where its limbs hang and end.
    """
    recording = solution.recording
    if not recording.n_markers:
        return recording_of_joints(solution.motion)
    owned = {label for limb in solution.skeleton.limbs for label in limb.markers}
    at = [i for i, label in enumerate(recording.labels) if label in owned]
    return replace(
        recording,
        markers=recording.markers[:, at],
        labels=tuple(opensim_name(recording.labels[i]) for i in at),
        residuals=None,
        confidence=None,
        world_from_file=np.eye(3),
    )
