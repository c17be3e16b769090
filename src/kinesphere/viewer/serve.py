"""A server with a viewer in it."""

import socket
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
import rich

from kinesphere.data.edits import Edit
from kinesphere.errors import BadSetting
from kinesphere.viewer.take import Take

if TYPE_CHECKING:
    import viser

    from kinesphere.viewer.viewer import Viewer

LOCAL = "127.0.0.1"
PORT = 8080
_AWAY = np.array([1.6, 0.3, 0.9])  # m from the figure to the eye: forward, up, to the right
_TRIED = 20
"""Ports tried after the usual one, where that is taken."""


def serve(
    take: Take,
    name: str,
    edits_file: Path,
    edits: Sequence[Edit] = (),
    *,
    host: str = LOCAL,
    port: int | None = None,
    dark: bool = False,
) -> "tuple[viser.ViserServer, Viewer]":
    """Show a take to whoever opens the server's page.

    Parameters
    ----------
    take
        As ``take_from`` returns it.
    name
        What the page is called.
    edits_file
        Where edits are saved.
    edits
        Those to go on from.
    host
        Only this machine by default: whoever reaches the port can edit and save.
    port
        The first free one from 8080 on, if None.
    dark
        Whether the page is dark.

    Returns
    -------
    server, viewer
        ``server.stop()`` ends both.

    Raises
    ------
    BadSetting
        If viser is not installed, the port is taken, or an edit means nothing here.
    """
    try:
        import viser
    except ImportError as error:
        raise BadSetting(
            "the viewer needs viser, which is not installed: pip install 'kinesphere[view]'"
        ) from error
    from kinesphere.viewer.viewer import Viewer

    if take.poses is not None:
        take.poses.edit(edits)  # whatever is wrong with them is said before a port is taken
    # viser prints a banner of its own through this console; ours are others
    rich.get_console().quiet = True
    server = viser.ViserServer(host, _free_port(host, port), label=name, verbose=False)
    server.gui.configure_theme(
        dark_mode=dark, show_logo=False, show_share_button=False, control_width="large",
        brand_color=(59, 91, 219),
    )  # fmt: skip
    server.gui.set_panel_label(name)
    middle = take.middle()
    server.initial_camera.look_at = tuple(middle)
    server.initial_camera.position = tuple(middle + take.facing() @ _AWAY)
    server.initial_camera.up = (0.0, 1.0, 0.0)
    return server, Viewer(server, take, edits_file, edits, dark=dark)


def _free_port(host: str, port: int | None) -> int:
    """Return a port nobody listens on; BadSetting where the one asked for is taken."""
    for one in range(PORT, PORT + _TRIED) if port is None else (port,):
        with socket.socket(socket.AF_INET6 if ":" in host else socket.AF_INET) as test:
            test.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
            try:
                test.bind((host, one))
            except OSError as error:
                last = error
                continue
            return one
    asked = f"port {port}" if port is not None else f"ports {PORT} to {PORT + _TRIED - 1}"
    raise BadSetting(f"{asked} of {host} cannot be used ({last}); choose another by --port")
