"""``kinesphere convert``: any readable format to any writable one."""

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from kinesphere.cli.options import JsonOption, SetOption, SettingsOption, settings_from_options

if TYPE_CHECKING:
    from kinesphere.data import Solution
    from kinesphere.pipeline import Settings


def convert(
    source: Annotated[Path, typer.Argument(metavar="IN", help="Any readable file or folder.")],
    target: Annotated[Path, typer.Argument(metavar="OUT", help="Its suffix says the format.")],
    assignments: SetOption = None,
    settings_file: SettingsOption = None,
    as_json: JsonOption = False,
) -> None:
    """Turn a file into another format.

    Nothing is lost where both can hold it. A recording goes to [bold].c3d[/bold],
    [bold].trc[/bold] or [bold].csv[/bold]; a solved folder to these (its angles, as
    [bold].csv[/bold]), to [bold].bvh[/bold], [bold].glb[/bold] and
    [bold].gltf[/bold] (with the body), [bold].osim[/bold], [bold].mot[/bold],
    [bold].json[/bold] (its skeleton) and [bold].limbs.csv[/bold] (the frame of every limb); a
    motion read from [bold].bvh[/bold] or [bold].amc[/bold] to [bold].bvh[/bold],
    [bold].limbs.csv[/bold], and its joints as points to [bold].c3d[/bold], [bold].trc[/bold] and
    [bold].csv[/bold].

    Examples: [bold]kinesphere convert walk.c3d walk.trc[/bold],
    [bold]kinesphere convert solved walk.bvh --set bvh.rest=t-pose --set bvh.names=unity[/bold],
    [bold]kinesphere convert 01_01.amc 01_01.bvh[/bold]
    """
    from kinesphere.cli.console import print_json, print_warnings, stdout
    from kinesphere.cli.files import check_target
    from kinesphere.cli.losses import left_behind
    from kinesphere.cli.options import BadArgument
    from kinesphere.data import Recording, Solution
    from kinesphere.io import read
    from kinesphere.io.own_points import without_own_points

    settings = (
        settings_from_options(assignments, settings_file) if assignments or settings_file else None
    )
    if target.exists() and source.exists() and target.samefile(source):
        raise BadArgument(f"{target} is what is to be converted; name another file for the result")
    check_target(target)
    found = read(source)
    if isinstance(found, Solution):
        found = part_for(found, target)
    suffix = target.suffix.lower()
    if isinstance(found, Recording) and suffix != ".c3d":  # only C3D says that they are computed
        found = without_own_points(found)
    write_as_set(found, target, settings)
    warnings = [warning for step in getattr(found, "history", ()) for warning in step.warnings]
    if isinstance(found, Recording) and (lost := left_behind(found, suffix)):
        warnings.append(f"{suffix} has no place for {', '.join(lost)}: left behind")
    size = target.stat().st_size if target.is_file() else None
    if as_json:
        print_json({"in": str(source), "out": str(target), "bytes": size, "warnings": warnings})
        return
    console = stdout()
    console.print(f"{source} → {target}" + (f" ({size:,} bytes)" if size else ""), soft_wrap=True)
    print_warnings(console, warnings)


def write_as_set(found: object, target: Path, settings: "Settings | None") -> None:
    """Write in the format that the target's suffix names, a BVH file as the settings say."""
    from dataclasses import asdict

    from kinesphere.data import Motion
    from kinesphere.io import recording_of_joints, write, write_bvh
    from kinesphere.io.registry import no_format

    points = target.suffix.lower() in (".c3d", ".trc", ".csv") and ".limbs" not in target.suffixes
    if isinstance(found, Motion) and points:
        write(recording_of_joints(found), target)
    elif settings is not None and isinstance(found, Motion) and target.suffix.lower() == ".bvh":
        write_bvh(found, target, **asdict(settings.bvh))
    elif isinstance(found, Motion) and not _has_format(found, target):
        raise no_format(target, "Motion", "Recording")
    else:
        write(found, target)


def part_for(solution: "Solution", target: Path) -> object:
    """Return what of a solution the target's format holds: the parameters rather than markers.

    Where there are no markers, as from cameras, limbs stand in for them.

    Raises
    ------
    UnknownFormat
        If the target has a suffix that names no format for any of it.
    """
    from kinesphere.io.registry import no_format

    parts = (solution, solution.motion, solution.parameters, solution.skeleton, solution.recording)
    if not target.suffix or target.is_dir():
        return solution
    for part in parts:
        if _has_format(part, target):
            cameras_alone = part is solution.recording and not solution.recording.n_markers
            return solution.motion if cameras_alone else part
    raise no_format(target, *(type(part).__name__ for part in parts))


def _has_format(part: object, target: Path) -> bool:
    from kinesphere.io import known_formats

    kind = type(part).__name__
    return any(f.is_named_by(target) and kind in f.writers for f in known_formats())
