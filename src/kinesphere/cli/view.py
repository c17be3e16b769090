"""``kinesphere view``: a recording or a solved folder in the browser, to look at and to edit."""

from pathlib import Path
from typing import Annotated

import typer

from kinesphere.cli.options import BadArgument, JsonOption


def view(
    path: Annotated[
        Path, typer.Argument(metavar="FILE|DIR", help="A recording, a motion, or a solved folder.")
    ],
    edits: Annotated[
        Path | None,
        typer.Option(
            "--edits",
            metavar="EDITS.toml",
            help="Where edits are saved, and read from if it is there; by default beside the "
            "solved folder, DIR.edits.toml.",
        ),
    ] = None,
    port: Annotated[
        int | None,
        typer.Option("--port", min=1, max=65535, help="By default the first free from 8080 on."),
    ] = None,
    host: Annotated[
        str,
        typer.Option(
            "--host",
            help="Address to listen at. Other than this machine's: whoever reaches it "
            "can edit and save.",
        ),
    ] = "127.0.0.1",
    no_open: Annotated[bool, typer.Option("--no-open", help="Open no browser.")] = False,
    dark: Annotated[bool, typer.Option("--dark", help="A dark page.")] = False,
    as_json: JsonOption = False,
) -> None:
    """Look at a motion in the browser, and change it: until Ctrl-C.

    A recording shows its markers, a motion (BVH, ASF/AMC) its skeleton. A solved folder shows
    both, with limb frames and movement axes; pick a limb, turn it about its own axes at a frame,
    over a range or throughout, undo, and save what `kinesphere edit` applies.

    Example: [bold]kinesphere view walk[/bold]
    """
    import time
    import webbrowser

    from kinesphere.cli.console import plain, print_json, stdout
    from kinesphere.io import check_file_place, read, read_edits, write_edits
    from kinesphere.viewer import serve, take_from

    take = take_from(read(path), str(path))
    if take.solution is None and edits is not None:
        raise BadArgument(f"{path} is no solved folder: nothing can be edited; solve it first")
    resolved = path.resolve()
    saved = edits if edits is not None else resolved.with_name(f"{resolved.name}.edits.toml")
    if edits is not None:
        check_file_place(edits)
    before = read_edits(saved) if take.solution is not None and saved.exists() else ()
    server, viewer = serve(take, resolved.name, saved, before, host=host, port=port, dark=dark)
    try:
        address = f"http://{server.get_host()}:{server.get_port()}"
        if as_json:
            print_json({"address": address, "edits": str(saved) if take.solution else None})
        else:
            stdout().print(f"{plain(path)} is at {address}  (Ctrl-C ends it)", soft_wrap=True)
        if not no_open:
            webbrowser.open(address)
        while True:
            time.sleep(0.5)
    except KeyboardInterrupt:
        pass
    finally:
        viewer.stop()
        server.stop()
    if viewer.unsaved:
        kept = saved.with_name(f"{saved.stem}.unsaved.toml")
        write_edits(viewer.unsaved, kept)
        stdout().print(f"\nEdits that were not saved are kept in {kept}", soft_wrap=True)
