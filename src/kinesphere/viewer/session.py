"""What a person has changed so far, with undo and redo: plain values, no viewer in sight."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

from kinesphere.data.edits import Axis, Edit


@dataclass(frozen=True)
class Scope:
    """Which frames an edit is about, and how softly it comes and goes."""

    frames: tuple[int, int] | None = None
    """First and last frame, both included, numbered as in the file; None for all."""
    blend_s: float = 0.0
    """s before the first and after the last frame."""


@dataclass(frozen=True)
class Target:
    """What one slider changes."""

    joint: str
    """Name of the joint, or ``root``."""
    axis: Axis
    scope: Scope = Scope()


@dataclass(frozen=True)
class Session:
    """Edits in their order, those before them and those undone.

    A slider that is dragged makes one step to undo, however many values it passes: changes of one
    target follow each other in the same step until ``settled``.
    """

    edits: tuple[Edit, ...] = ()
    past: tuple[tuple[Edit, ...], ...] = ()
    """Earlier states, the newest last."""
    future: tuple[tuple[Edit, ...], ...] = ()
    """States that were undone, the next to redo last."""
    held: Target | None = None
    """What is being changed right now."""

    def amount(self, target: Target) -> float:
        """Return by how much a target is changed, deg or m; 0 where it is not."""
        at = self._place(target)
        if at is None:
            return 0.0
        edit = self.edits[at]
        return float((edit.add_m if edit.add_m is not None else edit.add_deg) or 0.0)

    def changed(self, target: Target, amount: float) -> "Session":
        """Return the session with a target changed by so much in all, deg or m.

        Nothing is left of a target that is changed by 0.
        """
        edits, at = list(self.edits), self._place(target)
        new = [] if amount == 0 else [_edit(target, amount)]
        if at is None:
            edits += new
        else:
            edits[at : at + 1] = new
        if tuple(edits) == self.edits:
            return self
        past = self.past if self.held == target else (*self.past, self.edits)
        return Session(tuple(edits), past, (), target)

    def settled(self) -> "Session":
        """Return the session at the end of a gesture: the next change is a step of its own."""
        return replace(self, held=None)

    def undone(self) -> "Session":
        """Return the session before its last step; itself where there is none."""
        if not self.past:
            return self
        return Session(self.past[-1], self.past[:-1], (*self.future, self.edits))

    def redone(self) -> "Session":
        """Return the session with the last undone step done again; itself where there is none."""
        if not self.future:
            return self
        return Session(self.future[-1], (*self.past, self.edits), self.future[:-1])

    def cleared(self) -> "Session":
        """Return the session without edits; that can be undone."""
        return Session((), (*self.past, self.edits), ()) if self.edits else self

    def _place(self, target: Target) -> int | None:
        """Return where the last edit stands that says this target, if one does."""
        places = [i for i, edit in enumerate(self.edits) if _target(edit) == target]
        return places[-1] if places else None


def session_from_edits(edits: Sequence[Edit]) -> Session:
    """Return a session that goes on from edits that were saved."""
    return Session(tuple(edits))


def _target(edit: Edit) -> Target | None:
    """Return the target of an edit; None of one that no slider makes."""
    if edit.set_deg is not None or edit.seconds is not None:
        return None
    return Target(edit.joint, edit.axis, Scope(edit.frames, edit.blend_s))


def _edit(target: Target, amount: float) -> Edit:
    by = {"add_m": amount} if target.axis in ("x", "y", "z") else {"add_deg": amount}
    return Edit.model_validate(
        {
            "joint": target.joint,
            "axis": target.axis,
            "frames": target.scope.frames,
            "blend_s": target.scope.blend_s,
            **by,
        }
    )
