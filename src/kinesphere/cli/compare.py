"""``kinesphere compare``: two solutions of one motion."""

from pathlib import Path
from typing import Annotated, Any

import typer

from kinesphere.cli.options import BadArgument, JsonOption


def compare(
    first: Annotated[Path, typer.Argument(metavar="A", help="A solved folder.")],
    second: Annotated[Path, typer.Argument(metavar="B", help="Another, of the same motion.")],
    output: Annotated[
        Path | None,
        typer.Option("-o", "--output", metavar="REPORT.html", help="Write a page with curves."),
    ] = None,
    offset: Annotated[
        float | None,
        typer.Option(
            "--offset",
            metavar="SECONDS",
            help="How much later B's clock says what A's says; 0 of one recording, else found by "
            "itself, if not given.",
        ),
    ] = None,
    joint: Annotated[
        str | None,
        typer.Option("--joint", metavar="JOINT", help="Whose curves the page shows first."),
    ] = None,
    as_json: JsonOption = False,
) -> None:
    """Compare two solutions of one motion: by markers and without, by two models, before and after.

    What differs by definition is found, told and taken out: the time offset, the world, and the
    constant turn between the frames of each limb. What both have from one source is not: two
    solutions of one recording have one clock and one world, an edited motion has its source's limb
    frames, too, and differs by its edits alone. Differences are B minus A. A parameter table
    (with skeleton.json beside it) or any readable motion may stand for a solved folder; joints are
    known by their names or their limbs', as BVH has them, in the words of other programs, too.

    Example: [bold]kinesphere compare markers markerless --joint left_elbow -o both.html[/bold]
    """
    from kinesphere.cli.console import print_json, stdout
    from kinesphere.cli.describe_comparison import describe_comparison, show_comparison
    from kinesphere.comparison import compare as compared
    from kinesphere.io import check_file_place, replacing

    if output is not None:
        check_file_place(output)
    found = compared(read_comparable(first), read_comparable(second), offset=offset)
    known = list(dict.fromkeys(p.joint for p in found.parameters))
    if joint is not None and joint not in known:
        raise BadArgument(f"--joint {joint}: not compared; there are {', '.join(known)}")
    if output is not None:
        from kinesphere.report import comparison_html

        page = comparison_html(found, *_called(first, second), joint)
        with replacing(output) as temporary:
            Path(temporary).write_text(page, encoding="utf-8")
    if as_json:
        print_json(
            {"first": str(first), "second": str(second), "report": output and str(output)}
            | describe_comparison(found)
        )
        return
    show_comparison(found, f"{first} against {second}")
    if output is not None:
        stdout().print(f"\nReport: {output}", soft_wrap=True)


def read_comparable(path: Path) -> Any:
    """Return the solution, motion or parameters at a path; BadArgument for anything else."""
    from kinesphere.data import Motion, Parameters, Recording, Solution
    from kinesphere.io import read

    found = read(path)
    if isinstance(found, Recording):
        raise BadArgument(f"{path} is a recording; solve it first, then compare the folders")
    if not isinstance(found, Solution | Motion | Parameters):
        raise BadArgument(
            f"{path} holds a {type(found).__name__}; a solved folder or a motion is wanted"
        )
    return found


def _called(first: Path, second: Path) -> tuple[str, str]:
    """Return short names of the two that differ."""
    if first.name != second.name:
        return first.name or str(first), second.name or str(second)
    return str(first), str(second)
