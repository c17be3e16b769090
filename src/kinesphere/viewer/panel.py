"""The controls beside the scene. Which there are; what they do is the viewer's business."""

from typing import TYPE_CHECKING, Any

import numpy as np

from kinesphere.data import Skeleton
from kinesphere.data.edits import ROOT, Axis

if TYPE_CHECKING:
    import viser

NOTHING = "nothing"
THIS_FRAME, RANGE, ALL = "this frame", "from – to", "all frames"
SPEEDS = ("0.1", "0.25", "0.5", "1", "2", "4")
TURN, SHIFT = 180.0, 2.0
"""deg and m; how far a slider reaches either way."""
JOINT_AXES: tuple[Axis, ...] = (1, 2, 3)
ROOT_AXES: tuple[Axis, ...] = (1, 2, 3, "x", "y", "z")
_ROOT_LABELS = ("roll (°)", "turn (°)", "pitch (°)", "shift x (m)", "shift y (m)", "shift z (m)")
_KINDS = {
    "markers": "Markers",
    "skeleton": "Skeleton",
    "mesh": "Body",
    "axes": "Movement axes",
    "frames": "Limb frames",
}


class Panel:
    """Handles of everything a person can press, slide or type."""

    # viser makes the properties of its handles at run time: no type checker sees them
    play: Any
    frame: Any
    speed: Any
    joint: Any
    scope: Any
    start: Any
    end: Any
    blend: Any
    handles: Any
    undo: Any
    redo: Any
    save: Any
    sliders: list[Any]

    def __init__(
        self,
        server: "viser.ViserServer",
        frames: tuple[int, int, float],
        skeleton: Skeleton | None,
        notes: tuple[str, ...],
        kinds: dict[str, bool],
    ) -> None:
        """Make the panel.

        Parameters
        ----------
        frames
            Number of the first frame, how many there are, and their rate in Hz.
        skeleton
            None of a bare recording: no pose can be edited then.
        notes
            Sentences to show.
        kinds
            What can be shown, and whether it is.
        """
        self._gui = gui = server.gui
        first, n_frames, rate = frames
        last = first + n_frames - 1
        self.play = gui.add_button("Play", hint="Space")
        self.frame = gui.add_slider("Frame", first, max(last, first + 1), 1, first)
        self._clock = gui.add_markdown("")
        self.speed = gui.add_dropdown("Speed", SPEEDS, initial_value="1")
        with gui.add_folder("Show"):
            self.kinds = {
                name: gui.add_checkbox(_KINDS[name], shown) for name, shown in kinds.items()
            }
            self._marker = gui.add_markdown("", visible=False)
        for note in notes:
            gui.add_markdown(f"*{plain(note)}*")
        self._skeleton = skeleton
        if skeleton is not None:
            with gui.add_folder("Pose"):
                self._add_pose(skeleton, first, last, n_frames / rate)

    def _add_pose(self, skeleton: Skeleton, first: int, last: int, duration: float) -> None:
        gui = self._gui
        names = (NOTHING, ROOT, *skeleton.joint_names)
        self.joint = gui.add_dropdown("Joint", names, hint="Or click a bone")
        self.scope = gui.add_dropdown("Change", (THIS_FRAME, RANGE, ALL))
        self.start = gui.add_number("from", first, min=first, max=last, step=1, visible=False)
        self.end = gui.add_number("to", last, min=first, max=last, step=1, visible=False)
        self.blend = gui.add_number(
            "Blend (s)", 0.0, min=0.0, max=max(duration, 0.1), step=0.05,
            hint="How long a change takes to come and to go",
        )  # fmt: skip
        self.sliders = [
            gui.add_slider(f"slider {k}", -TURN, TURN, 0.5, 0.0, visible=False)
            for k in range(len(ROOT_AXES))
        ]
        self.handles = gui.add_checkbox(
            "Handles", True, hint="Rings in the scene; drag one to turn the limb about that axis"
        )
        self._angles = gui.add_markdown("", visible=False)
        self.undo = gui.add_button("Undo", hint="Ctrl Z", disabled=True)
        self.redo = gui.add_button("Redo", hint="Ctrl Shift Z", disabled=True)
        self.save = gui.add_button("Save edits", hint="Ctrl S")
        self._told = gui.add_markdown("", visible=False)

    def offer(self, joint: int | None) -> tuple[Axis, ...]:
        """Show the sliders of a joint, −1 for the root, None for none; return what they change."""
        axes: tuple[Axis, ...] = ()
        labels: tuple[str, ...] = ()
        if joint is not None and self._skeleton is not None:
            axes, labels = ROOT_AXES, _ROOT_LABELS
            if joint >= 0:
                axes = (*JOINT_AXES[: self._skeleton.joints[joint].n_axes], "twist")
                labels = tuple(f"{axis_in_words(axis)} (°)" for axis in axes)
        for k, slider in enumerate(self.sliders):
            slider.visible = k < len(axes)
            if k < len(axes):
                slider.label = labels[k]
                reach = SHIFT if axes[k] in ("x", "y", "z") else TURN
                slider.min, slider.max = -reach, reach
                slider.step, slider.precision = (0.005, 3) if reach == SHIFT else (0.5, 1)
        return axes

    def offer_range(self, scope: str) -> None:
        """Show the fields that a scope needs."""
        self.start.visible = self.end.visible = scope == RANGE
        self.blend.visible = scope != ALL

    def tell_frame(self, frame: int, rate: float, first: int, pace: float | None) -> None:
        """Tell which frame is on view, and how many a second are."""
        shown = "" if pace is None else f" · {pace:.0f} frames a second"
        self._clock.content = f"**{(frame - first) / rate:.2f} s** · frame {frame}{shown}"

    def tell_marker(self, label: str) -> None:
        """Tell which marker was clicked."""
        _say(self._marker, plain(label))

    def tell_angles(self, rows: list[tuple[Axis, float, float]]) -> None:
        """Tell the angles of the picked joint: axis, measured and edited, deg."""
        lines = ["| | measured | now |", "|---|--:|--:|"]
        lines += [
            f"| {axis_in_words(a)} | {_degrees(old)} | {_degrees(new)} |" for a, old, new in rows
        ]
        _say(self._angles, "\n".join(lines) if rows else "")

    def tell_edits(self, rows: list[str], said: str, undo: bool, redo: bool) -> None:
        """List the edits, say something, and tell which way there are steps."""
        _say(self._told, "\n".join([*rows, "", said]).strip())
        self.undo.disabled, self.redo.disabled = not undo, not redo


def axis_in_words(axis: Axis) -> str:
    """Return what a slider or a row is called."""
    return f"axis {axis}" if isinstance(axis, int) else axis


def plain(text: Any) -> str:
    """Return text from a file as markdown that means nothing but itself."""
    words = " ".join(str(text).split())
    return "".join(f"\\{c}" if c in "\\`*_{}[]()#+-.!<>|~$&" else c for c in words)


def _say(handle: Any, content: str) -> None:
    handle.content = content
    handle.visible = bool(content)


def _degrees(value: float) -> str:
    return f"{value:.1f}°" if np.isfinite(value) else "–"
