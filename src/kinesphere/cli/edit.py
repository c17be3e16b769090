"""``kinesphere edit``: poses changed by their joint parameters, as a file says."""

from pathlib import Path
from typing import Annotated

import typer

from kinesphere.cli.options import JsonOption


def edit(
    directory: Annotated[Path, typer.Argument(metavar="DIR", help="A solved folder.")],
    apply: Annotated[
        Path,
        typer.Option("--apply", metavar="EDITS.toml", help="The edits, in their order."),
    ],
    output: Annotated[
        Path, typer.Option("-o", "--output", metavar="DIR", help="Folder for the edited solution.")
    ],
    as_json: JsonOption = False,
) -> None:
    """Change a solved motion by its joint angles: some frames, some joints, the rest untouched.

    The edits are tables in a TOML file, as docs/file-formats.md shows them: which joint, which
    axis, by how much, in which frames, and how softly it begins and ends.

    Example: [bold]kinesphere edit walk --apply raise.toml -o raised[/bold]
    """
    from kinesphere.cli.console import print_json, print_table, print_title, print_warnings, stdout
    from kinesphere.cli.files import REPORT, check_apart, read_solved, write_solved
    from kinesphere.data.edits import change_in_words, frames_in_words
    from kinesphere.editing import apply_edits
    from kinesphere.io import check_solution_place, read_edits
    from kinesphere.report import counted

    check_apart(output, directory, apply)
    check_solution_place(output, [REPORT])
    edits = read_edits(apply)
    solution = apply_edits(read_solved(directory), edits)
    report = write_solved(solution, output, f"{directory.name}, edited")
    step = solution.history[-1]
    summary = {"output": str(output), **step.settings, **step.findings}
    if as_json:
        print_json({**summary, "warnings": list(step.warnings)})
        return
    console = stdout()
    print_title(console, str(directory), counted(len(edits), "edit"))
    rows = [
        (
            one.joint,
            str(one.axis),
            change_in_words(one),
            frames_in_words(one),
            f"{one.blend_s:g} s",
        )
        for one in edits
    ]
    print_table(console, ("joint", "axis", "change", "where", "blend"), rows, "llrlr")
    if step.warnings:
        print_title(console, "Warnings")
        print_warnings(console, list(step.warnings), frozenset())
    console.print(f"\nReport: {report}", soft_wrap=True)
