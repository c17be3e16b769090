"""``kinesphere demo``: a synthetic actor down the whole line, compared with the truth."""

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from kinesphere.cli.options import (
    JsonOption,
    SetOption,
    SettingsOption,
    settings_from_options,
)

if TYPE_CHECKING:
    from kinesphere.synthetic import TruthRow

FOLDER = Path("kinesphere-demo")


def demo(
    output: Annotated[
        Path, typer.Option("-o", "--output", metavar="DIR", help="Folder for everything found.")
    ] = FOLDER,
    seed: Annotated[int, typer.Option("--seed", help="Which actor.", min=0)] = 1,
    assignments: SetOption = None,
    settings_file: SettingsOption = None,
    as_json: JsonOption = False,
) -> None:
    """Solve a synthetic actor and compare with the truth.

    Takes some seconds; the first time about a minute, while kernels compile.

    Example: [bold]kinesphere demo -o demo[/bold]
    """
    import dataclasses
    import time

    import numpy as np

    from kinesphere import pipeline
    from kinesphere.cli.console import print_json, progress_bar, stdout
    from kinesphere.cli.describe_solution import describe_solution, show_solution
    from kinesphere.cli.files import REPORT, write_solved
    from kinesphere.io import check_solution_place
    from kinesphere.synthetic import compare_with_truth, make_performance

    settings = settings_from_options(assignments, settings_file)
    check_solution_place(output, [REPORT])
    start = time.perf_counter()
    with progress_bar(quiet=as_json) as progress:
        progress("actor", 0, 1)
        performance = make_performance(np.random.default_rng(seed))
        solution = pipeline.solve(
            performance.recording,
            performance.model,
            calibration=performance.calibration,
            settings=settings,
            progress=progress,
        )
        progress("truth", len(pipeline.STAGES), len(pipeline.STAGES) + 2)
        rows = compare_with_truth(performance, solution)
        progress("writing", len(pipeline.STAGES) + 1, len(pipeline.STAGES) + 2)
        report = write_solved(solution, output, "Synthetic actor")
    summary = {"file": f"synthetic actor {seed}", **describe_solution(solution)}
    if as_json:
        truth = [dataclasses.asdict(row) for row in rows]
        print_json({**summary, "output": str(output), "truth": truth})
        return
    show_solution(summary, solution)
    show_truth(rows)
    stdout().print(f"\nReport: {report}  ({time.perf_counter() - start:.0f} s)", soft_wrap=True)


def show_truth(rows: "Sequence[TruthRow]") -> None:
    """Print truth against estimate: of every measure of a stage, the typical and the worst."""
    import numpy as np

    from kinesphere.cli.console import print_table, print_title, stdout
    from kinesphere.report import number_in_words

    grouped: dict[tuple[str, str], list[TruthRow]] = {}
    for row in rows:
        grouped.setdefault((row.stage, row.measure), []).append(row)
    table = []
    for (stage, measure), group in grouped.items():
        known = [row for row in group if np.isfinite(row.error)]
        unit = "°" if group[0].unit == "deg" else group[0].unit
        worst = max(known, key=lambda row: row.error, default=None)
        table.append(
            (
                stage,
                measure,
                str(len(known)) + ("" if len(known) == len(group) else f" of {len(group)}"),
                number_in_words(float(np.median([r.error for r in known])), unit) if known else "–",
                number_in_words(worst.error, unit) if worst else "–",
                worst.of if worst else "",
            )
        )
    console = stdout()
    print_title(console, "Truth against estimate", "errors; the actor knows what is true")
    header = ("stage", "what", "number", "typical", "worst", "at")
    print_table(console, header, table, "llrrrl")
