"""``kinesphere convert``: any readable format to any writable one."""

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from kinesphere.cli.options import JsonOption

if TYPE_CHECKING:
    from kinesphere.data import Solution


def convert(
    source: Annotated[Path, typer.Argument(metavar="IN", help="Any readable file or folder.")],
    target: Annotated[Path, typer.Argument(metavar="OUT", help="Its suffix says the format.")],
    as_json: JsonOption = False,
) -> None:
    """Turn a file into another format.

    Nothing is lost where both can hold it. A recording goes to [bold].c3d[/bold],
    [bold].trc[/bold] or [bold].csv[/bold]; a solved folder to these (its angles, as
    [bold].csv[/bold]), to [bold].bvh[/bold], [bold].glb[/bold] and
    [bold].gltf[/bold] (with the body), [bold].osim[/bold], [bold].mot[/bold],
    [bold].json[/bold] (its skeleton) and [bold].limbs.csv[/bold] (the frame of every limb).

    Examples: [bold]kinesphere convert walk.c3d walk.trc[/bold],
    [bold]kinesphere convert solved walk.bvh[/bold]
    """
    from kinesphere.cli.console import print_json, print_warnings, stdout
    from kinesphere.cli.files import check_target
    from kinesphere.cli.losses import left_behind
    from kinesphere.cli.options import BadArgument
    from kinesphere.data import Recording, Solution
    from kinesphere.io import read, write

    if target.exists() and source.exists() and target.samefile(source):
        raise BadArgument(f"{target} is what is to be converted; name another file for the result")
    check_target(target)
    found = read(source)
    if isinstance(found, Solution):
        found = part_for(found, target)
    write(found, target)
    warnings = [warning for step in getattr(found, "history", ()) for warning in step.warnings]
    suffix = target.suffix.lower()
    if isinstance(found, Recording) and (lost := left_behind(found, suffix)):
        warnings.append(f"{suffix} has no place for {', '.join(lost)}: left behind")
    size = target.stat().st_size if target.is_file() else None
    if as_json:
        print_json({"in": str(source), "out": str(target), "bytes": size, "warnings": warnings})
        return
    console = stdout()
    console.print(f"{source} → {target}" + (f" ({size:,} bytes)" if size else ""), soft_wrap=True)
    print_warnings(console, warnings)


def part_for(solution: "Solution", target: Path) -> object:
    """Return what of a solution the target's format holds: the parameters rather than markers."""
    from kinesphere.io import known_formats

    parts = (solution, solution.motion, solution.parameters, solution.skeleton, solution.recording)
    suffix = target.suffix.lower()
    for part in parts:
        kind = type(part).__name__
        if suffix and any(f.is_named_by(target) and kind in f.writers for f in known_formats()):
            return part
    return solution
