"""The program: runs one command; whatever goes wrong becomes one clear line and exit code 2."""

import os
import sys
import traceback
import warnings
from typing import NoReturn

from kinesphere.errors import KinesphereError

FAILED = 2
_INTERRUPTED = 130  # what typer hands back after Ctrl-C
_CLOSED_PIPE = 128 + 13  # SIGPIPE


def main() -> NoReturn:
    """Run ``kinesphere`` with the words of the command line; never returns."""
    words = sys.argv[1:]
    debug = "--debug" in words
    words = [word for word in words if word != "--debug"]
    for stream in (sys.stdout, sys.stderr):
        if hasattr(stream, "reconfigure"):  # a terminal that has no "°" shows "?" instead
            stream.reconfigure(errors="replace")
    if not debug:  # a library's warning to programmers is no news for a user
        warnings.simplefilter("ignore")
    sys.exit(run(words, debug=debug))


def run(words: list[str], *, debug: bool = False) -> int:
    """Run one command and return the exit code: 0, or 2 after one line on stderr.

    Who stops reading, as ``head`` does, is told nothing: 141, as the shell has it for all programs.
    """
    from kinesphere.cli.app import app

    try:
        code = app(words, standalone_mode=False, prog_name="kinesphere")
        sys.stdout.flush()
        if code == _INTERRUPTED:
            raise KeyboardInterrupt
    except SystemExit as end:  # typer's own way out when nobody reads stdout any more
        return _nobody_reads() if end.code else 0
    except BrokenPipeError:
        return _nobody_reads()
    except (Exception, KeyboardInterrupt) as error:
        if debug:
            traceback.print_exc()
        return _failed(line_from_error(error))
    return int(code) if isinstance(code, int) else 0


def _nobody_reads() -> int:
    # Python flushes stdout once more at exit and would complain.
    os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
    return _CLOSED_PIPE


def line_from_error(error: BaseException) -> str:
    """Return what one line tells a user about an error: what was found, what would be right."""
    if isinstance(error, KinesphereError):
        return str(error)
    if isinstance(error, KeyboardInterrupt) or type(error).__name__ == "Abort":
        return "interrupted; no file was left half-written"
    if hasattr(error, "format_message"):  # typer's usage errors, of whichever click it carries
        return f"{error.format_message()} (see 'kinesphere --help')"
    if isinstance(error, OSError) and error.strerror:
        where = f"{error.filename}: " if error.filename else ""
        return f"{where}{error.strerror[0].lower()}{error.strerror[1:]}"
    if isinstance(error, MemoryError):
        return "not enough memory for this recording"
    return (
        f"{type(error).__name__}: {error} (a fault of Kinesphere; --debug shows where, "
        "please report it)"
    )


def _failed(message: str) -> int:
    from kinesphere.cli.console import on_one_line, stderr

    console = stderr()
    console.print("error:", style="bold red", end=" ")
    console.print(on_one_line(message), markup=False, highlight=False, soft_wrap=True)
    return FAILED
