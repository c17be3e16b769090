"""``kinesphere model``: a topological model from labelled recordings."""

from pathlib import Path
from typing import Annotated

import typer

from kinesphere.cli.options import JsonOption


def model(
    labelled: Annotated[list[Path], typer.Argument(help="Recordings of one marker layout.")],
    output: Annotated[
        Path, typer.Option("-o", "--output", metavar="MODEL.json", help="Where the model goes.")
    ],
    segments: Annotated[
        Path | None,
        typer.Option(
            "--segments",
            metavar="FILE",
            help="Which marker sits on which segment; else found by which markers move together.",
        ),
    ] = None,
    name: Annotated[
        str | None, typer.Option("--name", help="Name of the model; the file's, if not given.")
    ] = None,
    as_json: JsonOption = False,
) -> None:
    """Learn a topological model from labelled recordings.

    Examples: [bold]kinesphere model trial1.c3d trial2.c3d -o layout.json[/bold],
    [bold]kinesphere model knee.c3d --segments MarkerSet.xml -o plates.json[/bold]
    """
    from kinesphere.cli.console import print_json, progress_bar, stdout
    from kinesphere.cli.describe_model import describe_model, show_model
    from kinesphere.cli.files import read_recording
    from kinesphere.io import check_file_place, read_segments, write_model
    from kinesphere.skeleton import learn_model

    check_file_place(output)
    with progress_bar(quiet=as_json) as progress:
        groups = read_segments(segments) if segments is not None else None
        recordings = []
        for i, file in enumerate(labelled):
            progress(f"reading {file.name}", i, len(labelled) + 1)
            recordings.append(read_recording(file))
        progress("learning", len(labelled), len(labelled) + 1)
        learnt = learn_model(recordings, name or output.stem, groups)
        write_model(learnt, output)
    summary = {"output": str(output), **describe_model(learnt)}
    if as_json:
        print_json(summary)
        return
    show_model(summary)
    stdout().print(f"\nModel: {output}", soft_wrap=True)
