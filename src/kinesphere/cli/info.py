"""``kinesphere info``: what is in a file, and what is wrong with it."""

from pathlib import Path
from typing import Annotated

import typer

from kinesphere.cli.options import BadArgument, JsonOption, SubjectOption


def info(
    file: Annotated[
        Path,
        typer.Argument(
            help="A recording, a motion, a solved folder, or a file of one; a model, a mesh."
        ),
    ],
    subject: SubjectOption = None,
    as_json: JsonOption = False,
) -> None:
    """Tell what is in a file, and what is wrong with it.

    Example: [bold]kinesphere info walk.c3d[/bold]
    """
    from kinesphere.cli.console import print_json
    from kinesphere.cli.describe_mesh import describe_mesh, show_mesh
    from kinesphere.cli.describe_model import (
        describe_model,
        describe_skeleton,
        show_model,
        show_skeleton,
    )
    from kinesphere.cli.describe_motion import (
        describe_figure,
        describe_motion,
        show_motion,
        show_rig,
    )
    from kinesphere.cli.describe_recording import describe_recording, show_recording
    from kinesphere.cli.describe_solution import describe_solution, show_solution
    from kinesphere.data import (
        Motion,
        Parameters,
        Recording,
        Skeleton,
        Solution,
        Surface,
        TopologicalModel,
    )
    from kinesphere.io import read

    found = read(file)
    if isinstance(found, Recording):
        summary = describe_recording(found, subject)
    elif isinstance(found, Solution):
        summary = describe_solution(found)
    elif isinstance(found, Motion):
        summary = describe_motion(found)
    elif isinstance(found, TopologicalModel):
        summary = describe_model(found)
    elif isinstance(found, Surface):
        summary = describe_mesh(found, file)
    elif isinstance(found, Skeleton | Parameters):
        skeleton = found if isinstance(found, Skeleton) else found.skeleton
        summary = {**describe_skeleton(skeleton), **describe_figure(skeleton)}
    else:
        raise BadArgument(f"{file} holds a {type(found).__name__}, which info cannot describe")
    summary = {"file": str(file), **summary}
    if as_json:
        print_json(summary)
    elif isinstance(found, Recording):
        show_recording(summary)
    elif isinstance(found, Solution):
        show_solution(summary, found)
    elif isinstance(found, Motion):
        show_motion(summary)
    elif isinstance(found, Surface):
        show_mesh(summary)
    elif isinstance(found, Skeleton) and not any(joint.n_axes for joint in found.joints):
        show_rig(summary)
    elif summary["kind"] == "skeleton":
        show_skeleton(summary)
    else:
        show_model(summary)
