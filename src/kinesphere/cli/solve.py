"""``kinesphere solve``: the whole line on one recording."""

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from kinesphere.cli.options import (
    BadArgument,
    JsonOption,
    SetOption,
    SettingsOption,
    SubjectOption,
    calibration_from_text,
    settings_from_options,
)

if TYPE_CHECKING:
    from kinesphere.data import TopologicalModel


def solve(
    file: Annotated[Path, typer.Argument(help="A recording, labelled or not.")],
    output: Annotated[
        Path,
        typer.Option("-o", "--output", metavar="DIR", help="Folder for everything that is found."),
    ],
    model: Annotated[
        str | None,
        typer.Option(
            "--model",
            metavar="MODEL",
            help="A model file or the name of a built-in one; without it, the built-in one that "
            "the labels cover, if any. 'none' takes bodies and joints from motion alone.",
        ),
    ] = None,
    subject: SubjectOption = None,
    calibration: Annotated[
        str | None,
        typer.Option(
            "--calibration",
            metavar="START:END",
            help="Where the main movements are made, in seconds from the first stored frame.",
        ),
    ] = None,
    calibration_from: Annotated[
        list[Path] | None,
        typer.Option(
            "--calibration-from",
            metavar="DIR",
            help="Take axes and rest positions from a solved recording of the same person, as they "
            "lie beside the markers. Given several times (a functional trial for each joint or "
            "axis), in any order, every axis comes from where it is known best, and contradictions "
            "are told. Axes that are doubtful there, or plainly wrong here, give way to the "
            "recording's own where those are better, and that is said.",
        ),
    ] = None,
    facing: Annotated[
        str | None,
        typer.Option(
            "--facing",
            metavar="WAY",
            help="Where the person looks while standing, in the world (+x, -z, …; y is up), if "
            "nothing in the recording tells; or what to believe: feet, knees, elbows, walking.",
        ),
    ] = None,
    assignments: SetOption = None,
    settings_file: SettingsOption = None,
    as_json: JsonOption = False,
) -> None:
    """Measure skeleton, motion and joint parameters.

    Examples: [bold]kinesphere solve walk.c3d -o walk[/bold],
    [bold]kinesphere solve range.c3d --calibration 0:60 -o range[/bold],
    [bold]kinesphere solve walk.c3d --calibration-from range -o walk[/bold],
    [bold]kinesphere solve raw.c3d --model none -o raw[/bold]
    """
    if calibration is not None and calibration_from:
        raise BadArgument("--calibration and --calibration-from exclude each other; give one")
    span = calibration_from_text(calibration)

    from kinesphere import pipeline
    from kinesphere.cli.console import print_json, progress_bar, stdout
    from kinesphere.cli.describe_solution import describe_solution, show_solution
    from kinesphere.cli.files import (
        REPORT,
        check_apart,
        read_all_solved,
        read_recording,
        write_solved,
    )
    from kinesphere.io import check_solution_place

    model_file = Path(model) if model is not None and Path(model).is_file() else None
    check_apart(output, file, *(calibration_from or ()), model_file, settings_file)
    settings = settings_from_options(assignments, settings_file)
    check_solution_place(output, [REPORT])
    with progress_bar(quiet=as_json) as progress:
        recording = read_recording(file)
        solution = pipeline.solve(
            recording,
            model_from_text(model),
            subject=subject,
            calibration=span,
            calibration_from=read_all_solved(calibration_from or ()),
            facing=facing,  # type: ignore[arg-type]  # normalize names what it knows
            settings=settings,
            progress=progress,
        )
        progress("writing", len(pipeline.STAGES), len(pipeline.STAGES) + 1)
        report = write_solved(solution, output, file.name, settings.bvh)
    summary = {"file": str(file), "output": str(output), **describe_solution(solution)}
    if as_json:
        print_json(summary)
        return
    show_solution(summary, solution)
    stdout().print(f"\nReport: {report}", soft_wrap=True)


def model_from_text(text: str | None) -> "TopologicalModel | str | None":
    """Return the model in a file, or the name of a built-in one as it is."""
    if text is None:
        return None
    from kinesphere.data import TopologicalModel
    from kinesphere.io import read
    from kinesphere.labelling import built_in_models
    from kinesphere.pipeline import MOTION_ALONE

    if text == MOTION_ALONE or (text in built_in_models() and not Path(text).exists()):
        return text
    if not Path(text).exists():
        raise BadArgument(
            f"--model {text}: neither a file nor a built-in model; built in are "
            f"{', '.join(built_in_models())}"
        )
    found = read(text)
    if not isinstance(found, TopologicalModel):
        raise BadArgument(
            f"--model {text} holds a {type(found).__name__}, not a model; 'kinesphere model' "
            "learns one from labelled recordings"
        )
    return found
