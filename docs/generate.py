"""``python -m docs.generate``: the pages that the program writes about itself."""

import inspect
import re
from collections.abc import Callable, Iterable, Iterator
from pathlib import Path
from typing import Any, get_type_hints

from typer.models import ArgumentInfo, OptionInfo

from kinesphere.cli.app import app, kinesphere
from kinesphere.cli.settings import allowed_in_words, setting_rows, value_in_words
from kinesphere.pipeline import Settings

FOLDER = Path(__file__).parent


def main() -> None:
    """Write every page."""
    for name, text in pages().items():
        (FOLDER / name).write_text(text, encoding="utf-8")


def pages() -> dict[str, str]:
    """Return file name → Markdown."""
    return {"cli.md": _cli_page(), "settings.md": _settings_page()}


# --- commands ---


def _cli_page() -> str:
    commands = {str(c.callback.__name__): c.callback for c in app.registered_commands if c.callback}
    lines = [
        "# Command line",
        "",
        "Written by `make docs` from the program itself; `kinesphere COMMAND --help` says it too.",
        "",
        "Results go to stdout, progress and errors to stderr. Whatever goes wrong is one line that "
        "says what was found and what would be right, and the exit code is 2; `--debug` before the "
        "command shows where it came from.",
        "",
        "| command | |",
        "|---|---|",
        *(f"| [`{name}`](#{name}) | {_first_line(run)} |" for name, run in commands.items()),
        "",
        "## Every command",
        "",
        *_table(("option", ""), _options(kinesphere)),
        "| `-h`, `--help` | Show what there is. |",
        "",
    ]
    for name, run in commands.items():
        rows = [*_arguments(run), *_options(run)]
        lines += [f"## {name}", "", f"`{_usage(name, run)}`", "", *_prose(run), ""]
        lines += [*_table(("argument or option", ""), rows), ""]
    return "\n".join(lines).rstrip() + "\n"


def _first_line(run: Callable[..., Any]) -> str:
    return (inspect.getdoc(run) or "").partition("\n")[0]


def _prose(run: Callable[..., Any]) -> Iterator[str]:
    text = re.sub(r"\[/?bold\]", "`", inspect.getdoc(run) or "")
    for paragraph in text.split("\n\n"):
        if paragraph.startswith("Example"):
            _, _, examples = paragraph.partition(":")
            yield from ("```", *re.findall(r"`([^`]+)`", " ".join(examples.split())), "```")
        else:
            yield from (" ".join(paragraph.split()), "")


def _parameters(run: Callable[..., Any]) -> Iterator[tuple[str, Any, Any]]:
    """Yield (name, what typer is told of it, default); ``inspect.Parameter.empty`` for none."""
    hints = get_type_hints(run, include_extras=True)
    for name, parameter in inspect.signature(run).parameters.items():
        for told in getattr(hints[name], "__metadata__", ()):
            yield name, told, parameter.default


def _arguments(run: Callable[..., Any]) -> Iterator[tuple[str, str]]:
    for name, told, _ in _parameters(run):
        if isinstance(told, ArgumentInfo):
            yield f"`{_argument_name(name, told).strip('[]')}`", str(told.help)


def _options(run: Callable[..., Any]) -> Iterator[tuple[str, str]]:
    for _, told, default in _parameters(run):
        if not isinstance(told, OptionInfo):
            continue
        text = ", ".join(f"`{word}`" for word in _spelt(told))
        text += f" `{told.metavar}`" if told.metavar else ""
        given = default not in (inspect.Parameter.empty, None, False)
        said = str(told.help) + (f" Default: `{default}`." if given else "")
        yield text, said + (" Required." if default is inspect.Parameter.empty else "")


def _spelt(told: OptionInfo) -> list[str]:
    # within Annotated, typer keeps the first spelling where otherwise the default stands
    return [word for word in (told.default, *(told.param_decls or ())) if isinstance(word, str)]


def _usage(name: str, run: Callable[..., Any]) -> str:
    words = ["kinesphere", name]
    for parameter, told, default in _parameters(run):
        if isinstance(told, ArgumentInfo):
            words.append(_argument_name(parameter, told))
        elif default is inspect.Parameter.empty:
            words += [_spelt(told)[0], told.metavar]
    return " ".join([*words, "[OPTIONS]"])


def _argument_name(name: str, told: ArgumentInfo) -> str:
    return told.metavar or name.upper()


# --- settings ---


def _settings_page() -> str:
    lines = [
        "# Settings",
        "",
        "Written by `make docs` from the program itself; `kinesphere settings STAGE` says the "
        "same. Change one with `--set STAGE.KEY=VALUE`, several with `--settings FILE.toml`:",
        "",
        "```toml",
        "[axes]",
        'method = "direction-joining"',
        "```",
        "",
    ]
    for stage, rows in setting_rows(Settings()).items():
        lines += [f"## {stage}", ""]
        cells = (
            (
                f"`{row['key']}`",
                f"`{value_in_words(row['value'])}`" + (f" {row['unit']}" if row["unit"] else ""),
                allowed_in_words(row),
                row["doc"],
                row["source"],
            )
            for row in rows
        )
        lines += [*_table(("setting", "default", "allowed", "what", "source"), cells), ""]
    return "\n".join(lines).rstrip() + "\n"


def _table(header: Iterable[str], rows: Iterable[Iterable[str]]) -> Iterator[str]:
    header = tuple(header)
    yield f"| {' | '.join(header)} |"
    yield "|" + "---|" * len(header)
    for row in rows:
        yield "| " + " | ".join(cell.replace("|", "\\|") for cell in row) + " |"


if __name__ == "__main__":
    main()
