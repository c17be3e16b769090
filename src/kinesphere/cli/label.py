"""``kinesphere label``: labels for a recording that has none, or not all."""

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from kinesphere.cli.options import (
    BadArgument,
    JsonOption,
    SetOption,
    SettingsOption,
    settings_from_options,
)

if TYPE_CHECKING:
    from kinesphere.data import Recording


def label(
    file: Annotated[Path, typer.Argument(help="A recording; its points may have any names.")],
    model: Annotated[
        str,
        typer.Option("--model", metavar="MODEL", help="A model file or the name of a built-in."),
    ],
    output: Annotated[
        Path,
        typer.Option("-o", "--output", metavar="OUT.c3d", help="Where the labelled file goes."),
    ],
    assignments: SetOption = None,
    settings_file: SettingsOption = None,
    as_json: JsonOption = False,
) -> None:
    """Label a recording by a model of the layout, learnt from other people.

    Writes everything the file held with the labels that could be told and how sure they are; beside
    it a page OUT.html that shows where to look, and OUT.labels.csv, the same as a table. Labels
    that are there already are kept; with [bold]--set labelling.existing=check[/bold] they are
    checked, with [bold]=ignore[/bold] given anew. Where none could be given, nothing is written
    and the reason said.

    Examples: [bold]kinesphere label raw.c3d --model cmu41 -o labelled.c3d[/bold],
    [bold]kinesphere label raw.c3d --model mine.json -o labelled.c3d[/bold]
    """
    from kinesphere.cli.console import print_json, progress_bar, stdout
    from kinesphere.cli.files import read_recording
    from kinesphere.cli.solve import model_from_text
    from kinesphere.io import check_file_place, replacing, write
    from kinesphere.io.own_points import without_own_points
    from kinesphere.labelling import built_in_model
    from kinesphere.labelling import label as give_labels
    from kinesphere.report import labelling_html, write_label_table

    page, table = output.with_suffix(".html"), output.with_suffix(".labels.csv")
    if output.suffix.lower() not in (".c3d", ".trc", ".csv"):
        raise BadArgument(f"{output}: labels go to .c3d, or to .trc or .csv without confidences")
    for place in (output, page, table):
        if place.exists() and file.exists() and place.samefile(file):
            raise BadArgument(
                f"{place} is what is to be labelled; name another file for the result"
            )
        check_file_place(place)
    settings = settings_from_options(assignments, settings_file)
    with progress_bar(quiet=as_json) as progress:
        progress("reading", 0, 3)
        recording = without_own_points(read_recording(file))
        chosen = model_from_text(model)
        if isinstance(chosen, str):
            chosen = built_in_model(chosen)
        if chosen is None:
            raise BadArgument("--model names no model")
        progress("labelling", 1, 3)
        labelled = give_labels(recording, chosen, settings.labelling)
        refuse_nothing(labelled, file)
        progress("writing", 2, 3)
        write(labelled, output)
        with replacing(page) as temporary:
            text = labelling_html(labelled, chosen, file.name)
            temporary.write_text(text, encoding="utf-8", newline="\n")
        write_label_table(labelled, table)
    summary = {
        "file": str(file),
        "output": str(output),
        "page": str(page),
        "table": str(table),
        **describe(labelled),
    }
    if as_json:
        print_json(summary)
        return
    show(summary)
    stdout().print(f"\nLabelled: {output}\nReport: {page}\nTable: {table}", soft_wrap=True)


def refuse_nothing(recording: "Recording", file: Path) -> None:
    """Raise BadRecording, with the reason, where no label was given: there is nothing to write."""
    from kinesphere.errors import BadRecording

    step = recording.history[-1]
    if step.findings.get("labels_given") == 0:
        raise BadRecording(f"{file}: {'; '.join(step.warnings)}")


def describe(recording: "Recording") -> dict[str, Any]:
    """Return what labelling found, for machines."""
    step = recording.history[-1]
    return {
        "model": step.settings["model"],
        "method": step.settings["method"],
        **step.findings,
        "warnings": list(step.warnings),
    }


def show(summary: dict[str, Any]) -> None:
    """Print what labelling found, for people."""
    from kinesphere.cli.console import print_table, print_title, print_warnings, stdout
    from kinesphere.labelling.findings import said_of

    console = stdout()
    if "checked" in summary:
        head = f"{summary['checked']} labels checked, {len(summary['disagree'])} disagree"
        if summary["not_judged"]:
            head += f", {len(summary['not_judged'])} could not be judged"
        print_title(console, Path(summary["file"]).name, head)
        print_warnings(console, summary["warnings"])
        return
    head = (
        f"{summary['labels_given']} of {summary['labels_known']} labels of {summary['model']} "
        f"given, {summary['points_left_unlabelled']} pieces left unlabelled"
    )
    if kept := sum(bool(row.get("kept")) for row in summary["labels"].values()):
        head += f", {kept} kept and not checked"
    print_title(console, Path(summary["file"]).name, head)
    rows = []
    for name, row in sorted(
        summary["labels"].items(), key=lambda item: (item[1]["confidence"] or 0.0, item[0])
    ):
        sure = None if row.get("kept") else row["confidence"]
        said = "kept" if row.get("kept") else "not given" if sure is None else said_of(sure)
        rows.append(
            (
                name,
                said,
                "–" if sure is None else f"{sure:.2f}",
                f"{row['share']:.0%}",
                str(row["pieces"]),
            )
        )
    header = ("label", "", "confidence", "of the time", "pieces")
    print_table(console, header, rows, "llrrr", doubtful=("look", "not given"))
    print_warnings(console, summary["warnings"])
