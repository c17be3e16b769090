"""``kinesphere track``: cameras and images in, the usual solved folder out."""

from contextlib import suppress
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from kinesphere.cli.interruptions import Interruptions, interruptions
from kinesphere.cli.options import (
    BadArgument,
    JsonOption,
    SetOption,
    SettingsOption,
    calibration_from_text,
    settings_from_options,
)
from kinesphere.errors import Interrupted

if TYPE_CHECKING:
    from kinesphere.pipeline.track import TrackedSolution

STRIP = "overlays.jpg"
VIDEO = "overlays.mp4"
TABLE = "tracking.csv"


def track(
    file: Annotated[
        Path,
        typer.Argument(
            metavar="SCENE.toml",
            help="Cameras, their calibration and images, and what is known of the person.",
        ),
    ],
    output: Annotated[
        Path,
        typer.Option("-o", "--output", metavar="DIR", help="Folder for everything that is found."),
    ],
    calibration: Annotated[
        str | None,
        typer.Option(
            "--calibration",
            metavar="START:END",
            help="Where the main movements are made, in seconds from the first frame.",
        ),
    ] = None,
    calibration_from: Annotated[
        list[Path] | None,
        typer.Option(
            "--calibration-from",
            metavar="DIR",
            help="Take axes and rest positions from a solved recording of the same person, by "
            "markers or without; may be given again, as for 'kinesphere solve'.",
        ),
    ] = None,
    facing: Annotated[
        str | None,
        typer.Option("--facing", metavar="WAY", help="As for 'kinesphere solve'."),
    ] = None,
    video: Annotated[
        bool,
        typer.Option(
            "--video/--no-video", help="Whether to make overlays.mp4; as long as the tracking."
        ),
    ] = True,
    assignments: SetOption = None,
    settings_file: SettingsOption = None,
    as_json: JsonOption = False,
) -> None:
    """Measure motion without markers, from several calibrated cameras.

    docs/markerless.md shows how a scene is written. The folder holds what 'kinesphere solve'
    writes, the model drawn over every camera (overlays.mp4, overlays.jpg), and overlap and support
    of every limb in every frame (tracking.csv).

    Example: [bold]kinesphere track SCENE.toml -o squat[/bold]
    """
    if calibration is not None and calibration_from:
        raise BadArgument("--calibration and --calibration-from exclude each other; give one")
    span = calibration_from_text(calibration)

    from kinesphere.cli.console import print_json, print_warnings, progress_bar, stdout
    from kinesphere.cli.describe_solution import describe_solution, show_solution
    from kinesphere.cli.files import REPORT, check_apart, read_all_solved
    from kinesphere.io import check_solution_place
    from kinesphere.io.images import opencv
    from kinesphere.io.scene import read_scene

    opencv()  # says how to get it, before anything else needs it
    from kinesphere.cli.describe_tracking import describe_tracking, show_tracking
    from kinesphere.pipeline.track import solve_scene

    check_apart(output, file, *(calibration_from or ()), settings_file)
    settings = settings_from_options(assignments, settings_file)
    check_solution_place(output, [REPORT, STRIP, VIDEO, TABLE])
    with progress_bar(quiet=as_json) as progress, interruptions(progress.say) as stops:
        scene = read_scene(file)
        found = solve_scene(
            scene,
            calibration=span,
            calibration_from=read_all_solved(calibration_from or ()),
            facing=facing,  # type: ignore[arg-type]  # normalize names what it knows
            settings=settings,
            progress=progress,
            notice=progress.say,
            after_tracking=stops.finish_first,
        )
        report = write_tracked(found, output, stops, video=video, progress=progress)
    solution = found.solution
    summary = {
        "file": str(file),
        "output": str(output),
        **describe_solution(solution),
        "tracking": describe_tracking(found.tracked, [c.name for c in scene.cameras]),
    }
    if as_json:
        print_json(summary)
    else:
        if found.tracked.start_doubt:
            print_warnings(stdout(), [found.tracked.start_doubt])
        show_solution(summary, solution)
        show_tracking(summary["tracking"])
        stdout().print(f"\nReport: {report}", soft_wrap=True)
    if (reached := found.tracked.n_reached) is not None:
        raise Interrupted(
            f"interrupted after {reached} of {scene.n_frames} frames; they are kept in {output}"
        )


def write_tracked(
    found: "TrackedSolution",
    output: Path,
    stops: Interruptions,
    *,
    video: bool = True,
    progress: Any = None,
) -> Path:
    """Write the solved folder with pictures, table and report; return where the report is.

    An interruption leaves out the video, which takes long, and nothing else.
    """
    from kinesphere.cli.files import REPORT
    from kinesphere.io import write_solution
    from kinesphere.io.images import encoded_image
    from kinesphere.report import report_html
    from kinesphere.report.overlay_film import overlay_film
    from kinesphere.report.strip import overlay_strip
    from kinesphere.report.tracking import tracking_section, tracking_table

    strip, frames = overlay_strip(found.scene, found.tracked, progress=progress)
    files: dict[str, str | bytes] = {
        STRIP: encoded_image(strip),
        TABLE: tracking_table(found.scene, found.tracked),
    }
    poster = b""
    if video and not stops.asked:
        with suppress(KeyboardInterrupt):  # who will not wait for it keeps the rest
            stops.at_once()
            files[VIDEO], first = overlay_film(found.scene, found.tracked, progress)
            poster = encoded_image(first)
        stops.finish_first()
    section = tracking_section(
        found.scene,
        found.tracked,
        encoded_image(strip),
        frames,
        VIDEO if VIDEO in files else None,
        poster,
    )
    files[REPORT] = report_html(found.solution, found.scene.name, section)
    write_solution(found.solution, output, files)
    return output / REPORT
