"""``kinesphere track``: cameras and images in, the usual solved folder out."""

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from kinesphere.cli.options import (
    BadArgument,
    JsonOption,
    SetOption,
    SettingsOption,
    calibration_from_text,
    settings_from_options,
)

if TYPE_CHECKING:
    from kinesphere.markerless import TrackedMotion
    from kinesphere.pipeline.track import TrackedSolution

STRIP = "overlays.jpg"
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
        Path | None,
        typer.Option(
            "--calibration-from",
            metavar="DIR",
            help="Take axes and rest positions from a solved recording of the same person.",
        ),
    ] = None,
    facing: Annotated[
        str | None,
        typer.Option("--facing", metavar="WAY", help="As for 'kinesphere solve'."),
    ] = None,
    assignments: SetOption = None,
    settings_file: SettingsOption = None,
    as_json: JsonOption = False,
) -> None:
    """Measure motion without markers, from several calibrated cameras.

    docs/markerless.md shows how a scene is written. The folder holds what 'kinesphere solve'
    writes, the model drawn over every camera (overlays.jpg), and overlap and support of every
    limb in every frame (tracking.csv).

    Example: [bold]kinesphere track SCENE.toml -o squat[/bold]
    """
    if calibration is not None and calibration_from is not None:
        raise BadArgument("--calibration and --calibration-from exclude each other; give one")
    span = calibration_from_text(calibration)

    from kinesphere.cli.console import print_json, progress_bar, stdout
    from kinesphere.cli.describe_solution import describe_solution, show_solution
    from kinesphere.cli.files import REPORT, read_solved
    from kinesphere.io import check_solution_place
    from kinesphere.io.images import opencv
    from kinesphere.io.scene import read_scene

    opencv()  # says how to get it, before anything else needs it
    from kinesphere.pipeline.track import solve_scene

    settings = settings_from_options(assignments, settings_file)
    check_solution_place(output, [REPORT, STRIP, TABLE])
    with progress_bar(quiet=as_json) as progress:
        scene = read_scene(file)
        found = solve_scene(
            scene,
            calibration=span,
            calibration_from=read_solved(calibration_from) if calibration_from else None,
            facing=facing,  # type: ignore[arg-type]  # normalize names what it knows
            settings=settings,
            progress=progress,
        )
        report = write_tracked(found, output, progress)
    solution = found.solution
    summary = {
        "file": str(file),
        "output": str(output),
        **describe_solution(solution),
        "tracking": describe_tracking(found.tracked, [c.name for c in scene.cameras]),
    }
    if as_json:
        print_json(summary)
        return
    show_solution(summary, solution)
    show_tracking(summary["tracking"])
    stdout().print(f"\nReport: {report}", soft_wrap=True)


def write_tracked(found: "TrackedSolution", output: Path, progress: Any = None) -> Path:
    """Write the solved folder with pictures, table and report; return where the report is."""
    from kinesphere.cli.files import REPORT
    from kinesphere.io import write_solution
    from kinesphere.io.images import encoded_image
    from kinesphere.report import report_html
    from kinesphere.report.tracking import overlay_strip, tracking_section, tracking_table

    strip, frames = overlay_strip(found.scene, found.tracked, progress=progress)
    picture = encoded_image(strip)
    section = tracking_section(found.scene, found.tracked, picture, frames)
    write_solution(
        found.solution,
        output,
        {
            REPORT: report_html(found.solution, found.scene.name, section),
            STRIP: picture,
            TABLE: tracking_table(found.scene, found.tracked),
        },
    )
    return output / REPORT


def describe_tracking(tracked: "TrackedMotion", cameras: list[str]) -> dict[str, Any]:
    """Return overlap by camera, and support and lost frames by limb."""
    import numpy as np

    def mean(values: Any) -> float:
        known = values[np.isfinite(values)]
        return float(known.mean()) if len(known) else float("nan")

    def least(values: Any) -> float:
        known = values[np.isfinite(values)]
        return float(known.min()) if len(known) else float("nan")

    return {
        "n_frames": tracked.n_frames,
        "n_solved": int(tracked.solved.sum()),
        "overlap_mean": mean(tracked.overlap),
        "cameras": [
            {"name": name, "overlap_mean": mean(o), "overlap_least": least(o)}
            for name, o in zip(cameras, tracked.overlap.T, strict=True)
        ],
        "limbs": [
            {
                "name": name,
                "support_mean": mean(tracked.support[:, i]),
                "support_least": least(tracked.support[:, i]),
                "frames_lost": int(tracked.lost[:, i].sum()),
            }
            for i, name in enumerate(tracked.limb_names)
        ],
        "seconds": dict(tracked.seconds),
    }


def show_tracking(found: dict[str, Any]) -> None:
    """Print overlap by camera, and the limbs that were lost or hardly supported."""
    from kinesphere.cli.console import print_table, print_title, stdout

    console = stdout()
    print_title(console, "Cameras", f"{found['n_solved']} of {found['n_frames']} frames solved")
    rows = [
        (c["name"], _share(c["overlap_mean"]), _share(c["overlap_least"])) for c in found["cameras"]
    ]
    print_table(console, ("camera", "overlap, mean", "least"), rows, "lrr")
    print_title(console, "Limbs", "support: share of the visible rim that speaks for the pose")
    limbs = [
        (
            limb["name"],
            _share(limb["support_mean"]),
            _share(limb["support_least"]),
            str(limb["frames_lost"] or ""),
        )
        for limb in found["limbs"]
    ]
    print_table(console, ("limb", "support, mean", "least", "frames lost"), limbs, "lrrr")


def _share(value: float) -> str:
    return "–" if value != value else f"{value:.2f}"
