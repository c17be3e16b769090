"""The commands by name. Each lives in its own file and imports what it needs when it runs."""

from typing import Annotated

import typer

from kinesphere.cli.compare import compare
from kinesphere.cli.convert import convert
from kinesphere.cli.demo import demo
from kinesphere.cli.edit import edit
from kinesphere.cli.info import info
from kinesphere.cli.label import label
from kinesphere.cli.learn import model
from kinesphere.cli.retarget import retarget
from kinesphere.cli.settings import settings
from kinesphere.cli.solve import solve
from kinesphere.cli.track import track
from kinesphere.cli.view import view

app = typer.Typer(
    name="kinesphere",
    add_completion=False,
    rich_markup_mode="rich",
    pretty_exceptions_enable=False,
    context_settings={"help_option_names": ["-h", "--help"]},
)


def _version(wanted: bool) -> None:
    if wanted:
        from kinesphere import __version__

        typer.echo(f"kinesphere {__version__}")
        raise typer.Exit


@app.callback(invoke_without_command=True)
def kinesphere(
    context: typer.Context,
    version: Annotated[  # noqa: ARG001 - the callback does it
        bool,
        typer.Option("--version", callback=_version, is_eager=True, help="Show the version."),
    ] = False,
    debug: Annotated[  # noqa: ARG001 - main() looks for it before anything else runs
        bool, typer.Option("--debug", help="Show where an error came from.")
    ] = False,
) -> None:
    """Optical motion capture in, a measured skeleton and its joint parameters out.

    Start with [bold]kinesphere demo[/bold], or [bold]kinesphere info FILE[/bold] on a recording of
    yours, then [bold]kinesphere solve FILE -o DIR[/bold].
    """
    if context.invoked_subcommand is None:
        typer.echo(context.get_help())


for command in (
    demo, info, label, solve, track, view, edit, retarget, compare, convert, model, settings,
):  # fmt: skip
    app.command()(command)
