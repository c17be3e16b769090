"""``kinesphere model``: a topological model from labelled recordings."""

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from kinesphere.cli.options import JsonOption

if TYPE_CHECKING:
    from kinesphere.data import Recording, TopologicalModel


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
            help="Which marker sits on which segment (OpenSim marker set, JSON or TOML); "
            "needed unless a built-in model covers the labels.",
        ),
    ] = None,
    name: Annotated[
        str | None, typer.Option("--name", help="Name of the model; the file's, if not given.")
    ] = None,
    as_json: JsonOption = False,
) -> None:
    """Learn a topological model from labelled recordings.

    With segments from a file, the joints between them come from the motion. Where a built-in
    model covers the labels, its limbs and joints are kept and the distances between the markers
    are learnt.

    Examples: [bold]kinesphere model knee.c3d --segments MarkerSet.xml -o plates.json[/bold],
    [bold]kinesphere model walk.c3d run.c3d -o mine.json[/bold]
    """
    from kinesphere.cli.console import print_json, progress_bar, stdout
    from kinesphere.cli.describe_model import describe_model, show_model
    from kinesphere.cli.files import read_recording
    from kinesphere.io import check_file_place, read_segments, write_model
    from kinesphere.labelling import match_labels
    from kinesphere.skeleton import learn_model

    check_file_place(output)
    with progress_bar(quiet=as_json) as progress:
        groups = read_segments(segments) if segments is not None else None
        recordings = []
        for i, file in enumerate(labelled):
            progress(f"reading {file.name}", i, len(labelled) + 1)
            recordings.append(read_recording(file))
        progress("learning", len(labelled), len(labelled) + 1)
        known = None
        if groups is None:
            known = common_model(recordings)
            recordings = [match_labels(recording, known) for recording in recordings]
        learnt = learn_model(recordings, name or output.stem, groups, known)
        write_model(learnt, output)
    summary = {"output": str(output), **describe_model(learnt)}
    if as_json:
        print_json(summary)
        return
    show_model(summary)
    stdout().print(f"\nModel: {output}", soft_wrap=True)


def common_model(recordings: "list[Recording]") -> "TopologicalModel":
    """Return the built-in model that covers every recording; BadModel if there is none."""
    from dataclasses import replace

    from kinesphere.errors import BadModel
    from kinesphere.labelling import built_in_models, choose_model

    chosen = {model.name: model for r in recordings if (model := choose_model(r)) is not None}
    if len(chosen) != 1 or any(choose_model(recording) is None for recording in recordings):
        raise BadModel(
            f"no built-in model ({', '.join(built_in_models())}) covers the labels of every "
            "recording; --segments FILE says which marker sits on which segment"
        )
    # its own statistics stay behind: what is learnt are these recordings and no others
    return replace(next(iter(chosen.values())), statistics=())
