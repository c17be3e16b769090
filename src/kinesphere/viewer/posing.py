"""Pose editing in the viewer: which joint is picked, what its sliders and handles change."""

from collections.abc import Callable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from kinesphere.data.edits import ROOT, Axis, Edit, edit_in_words
from kinesphere.errors import KinesphereError
from kinesphere.io import write_edits
from kinesphere.viewer.handles import Handles
from kinesphere.viewer.panel import ALL, NOTHING, RANGE, Panel
from kinesphere.viewer.poses import EditedPoses, angle_deg, turning_axes
from kinesphere.viewer.session import Scope, Session, Target, session_from_edits
from kinesphere.viewer.stage import Stage
from kinesphere.viewer.wiring import Time, on_change, on_press

if TYPE_CHECKING:
    import viser

_GRAIN = 0.1  # deg; what a dragged arc is rounded to


class Posing:
    """A session of edits, and the controls it is made with."""

    def __init__(
        self,
        server: "viser.ViserServer",
        panel: Panel,
        stage: Stage,
        poses: EditedPoses,
        time: Time,
        edits_file: Path,
        edits: Sequence[Edit],
    ) -> None:
        self._panel, self._stage, self._poses, self._time = panel, stage, poses, time
        self._file, self._saved = edits_file, tuple(edits)
        self._grabbed = 0.0
        self.session = session_from_edits(edits)
        self.joint: int | None = None
        """Index of the picked joint, −1 for the root."""
        self.axes: tuple[Axis, ...] = ()
        """What the sliders change."""
        self.handles = Handles(server, 4, self._dragged)
        poses.edit(self.session.edits)
        self._tell_edits()
        self._connect(server)

    @property
    def unsaved(self) -> tuple[Edit, ...]:
        """Edits that no file holds."""
        return () if self.session.edits == self._saved else self.session.edits

    def settle(self) -> None:
        """End a gesture."""
        self.session = self.session.settled()

    def pick(self, joint: int | None) -> None:
        """Pick a joint by its index, the root by −1, nothing by None."""
        self.joint = joint
        self.settle()
        self.axes = self._panel.offer(joint)
        self._panel.joint.value = self._name() or NOTHING
        self._stage.pick_limb(None if joint is None else joint + 1)
        self.tell(self._time.frame)

    def change(self, k: int, amount: float) -> None:
        """Change what the k-th slider changes, by so much in all."""
        self._take(self.session.changed(self._target(k), amount))

    def undo(self) -> None:
        """Take the last step back."""
        self._take(self.session.undone())

    def redo(self) -> None:
        """Do the last step that was undone again."""
        self._take(self.session.redone())

    def save(self) -> None:
        """Write the edits; an error is said, not raised."""
        if not self.session.edits:
            self._tell_edits("There is nothing to save.")
            return
        try:
            write_edits(self.session.edits, self._file)
        except (KinesphereError, OSError) as error:
            self._tell_edits(f"**Not saved:** {error}")
            return
        self._saved = self.session.edits
        self._tell_edits(f"Saved to `{self._file}`.")

    def tell(self, frame: int) -> None:
        """Let sliders, figures and handles say what is so in a frame."""
        for k in range(len(self.axes)):
            self._panel.sliders[k].value = self.session.amount(self._target(k))
        joint = self.joint
        if joint is None or joint < 0:
            self._panel.tell_angles([])
            self.handles.hide()
            return
        old, new = self._poses.solution.parameters, self._poses.parameters
        self._panel.tell_angles(
            [(axis, angle_deg(old, frame, joint, axis), angle_deg(new, frame, joint, axis))
             for axis in self.axes]
        )  # fmt: skip
        self._place_handles(joint, frame)

    def _name(self) -> str:
        if self.joint is None:
            return ""
        return ROOT if self.joint < 0 else self._poses.solution.skeleton.joint_names[self.joint]

    def _target(self, k: int) -> Target:
        panel = self._panel
        now = self._poses.parameters.first_frame + self._time.frame
        frames: tuple[int, int] | None = (now, now)
        if panel.scope.value == ALL:
            frames = None
        elif panel.scope.value == RANGE:
            first, last = sorted((int(panel.start.value), int(panel.end.value)))
            frames = first, last
        blend = 0.0 if frames is None else float(panel.blend.value)
        return Target(self._name(), self.axes[k], Scope(frames, blend))

    def _take(self, session: Session) -> None:
        if session.edits != self.session.edits:
            self._poses.edit(session.edits)
        self.session = session
        self._tell_edits()
        self._time.draw()

    def _dragged(self, k: int, angle: float, ended: bool) -> None:
        if k >= len(self.axes):
            return
        if self.session.held != self._target(k):
            self._grabbed = self.session.amount(self._target(k))
        self.change(k, round(round((self._grabbed + angle) / _GRAIN) * _GRAIN, 1))
        if ended:
            self.settle()
            self.tell(self._time.frame)

    def _place_handles(self, joint: int, frame: int) -> None:
        figure, skeleton = self._stage.figure, self._poses.solution.skeleton
        if figure is None or not self._panel.handles.value or self._time.playing:
            self.handles.hide()
            return
        rotations, origins, _ = self._poses.at(frame)
        parent = rotations[skeleton.parents[joint + 1]]
        axes = turning_axes(self._poses.parameters, joint, frame) @ parent.T
        self.handles.place(figure.joint_centres(rotations, origins)[joint], axes)

    def _tell_edits(self, said: str = "") -> None:
        session = self.session
        rows = [f"{k}. {edit_in_words(edit)}" for k, edit in enumerate(session.edits, start=1)]
        self._panel.tell_edits(rows, said, bool(session.past), bool(session.future))

    def _connect(self, server: "viser.ViserServer") -> None:
        panel, names = self._panel, self._poses.solution.skeleton.joint_names
        self._stage.on_limb(lambda limb: self.pick(limb - 1))
        on_change(panel.joint, lambda name: self.pick(_joint_called(name, names)))
        on_change(panel.scope, self._set_scope)
        for field in (panel.start, panel.end, panel.blend, panel.handles):
            on_change(field, lambda _: self._set_scope(panel.scope.value))
        for k, slider in enumerate(panel.sliders):
            on_change(slider, self._changer(k))
        for button, call, key, modifier in (
            (panel.undo, self.undo, "Z", "cmd/ctrl"),
            (panel.redo, self.redo, "Z", "cmd/ctrl+shift"),
            (panel.save, self.save, "S", "cmd/ctrl"),
        ):
            on_press(button, call)
            command = server.gui.add_command(
                button.label,
                hotkey=key,  # type: ignore[arg-type]
                modifier=modifier,  # type: ignore[arg-type]
            )
            on_press(command, call)

    def _changer(self, k: int) -> Callable[[float], None]:
        return lambda value: self.change(k, float(value))

    def _set_scope(self, scope: str) -> None:
        self._panel.offer_range(scope)
        self.settle()
        self.tell(self._time.frame)


def _joint_called(name: str, names: tuple[str, ...]) -> int | None:
    if name == ROOT:
        return -1
    return names.index(name) if name in names else None
