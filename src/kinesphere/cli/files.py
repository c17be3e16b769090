"""What commands read and write, with an error that names what was expected."""

from collections import Counter
from collections.abc import Iterable
from pathlib import Path

from kinesphere.cli.options import BadArgument
from kinesphere.data import Recording, Solution
from kinesphere.io import check_file_place, check_solution_place, read, write_solution
from kinesphere.io.bvh_settings import BvhSettings
from kinesphere.report import report_html

REPORT = "report.html"


def read_recording(path: Path) -> Recording:
    """Return the recording in a file; BadArgument for a solution, a model or anything else."""
    found = read(path)
    if isinstance(found, Solution):
        raise BadArgument(f"{path} is solved already; name the recording it was made from")
    if not isinstance(found, Recording):
        raise BadArgument(f"{path} holds a {type(found).__name__}; a recording is wanted")
    return found


def read_solved(path: Path) -> Solution:
    """Return the solution in a folder; BadArgument for anything else."""
    found = read(path)
    if not isinstance(found, Solution):
        raise BadArgument(f"{path} holds a {type(found).__name__}; a solved folder is wanted")
    return found


def read_all_solved(folders: Iterable[Path]) -> dict[str, Solution]:
    """Return the solutions in folders by the folders' names; by their ways where names are alike.

    A folder that is named twice counts once.
    """
    ways = {folder.resolve(): folder for folder in folders}
    often = Counter(way.name for way in ways)
    return {
        way.name if often[way.name] == 1 else str(folder): read_solved(folder)
        for way, folder in ways.items()
    }


def check_apart(output: Path, *sources: Path | None) -> None:
    """Raise if the result would be written over something it is made from.

    That is itself, or a folder it lies in: solved folders are replaced as a whole.
    """
    there = output.resolve()
    for source in sources:
        if source is None or not output.exists() or not source.exists():
            continue
        if output.samefile(source) or there in source.resolve().parents:
            raise BadArgument(f"{output} is read from; name another place for the result")


def check_target(target: Path) -> None:
    """Raise unless a file, or for a name without suffix a solved folder, can be written there."""
    if target.suffix and not target.is_dir():
        check_file_place(target)
    else:
        check_solution_place(target, [REPORT])


def write_solved(
    solution: Solution, directory: Path, title: str, bvh: BvhSettings | None = None
) -> Path:
    """Write a solved folder with its report; return where the report is."""
    write_solution(solution, directory, {REPORT: report_html(solution, title)}, bvh)
    return directory / REPORT
