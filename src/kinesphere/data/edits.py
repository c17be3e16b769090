"""Pose edits by joint parameter, a list to be replayed (Sar Dessai et al. 2006, figure 5)."""

from typing import Annotated, Literal, TypeAlias

from pydantic import BaseModel, ConfigDict, Field, StringConstraints, model_validator

Angle = Annotated[float, Field(allow_inf_nan=False, ge=-3600.0, le=3600.0)]
Length = Annotated[float, Field(allow_inf_nan=False, ge=0.0)]
Shift = Annotated[float, Field(allow_inf_nan=False, ge=-1000.0, le=1000.0)]
Axis: TypeAlias = Literal[1, 2, 3, "twist", "x", "y", "z"]
"""A movement axis of a joint or its twist; of the root, its own axes or the world's x, y, z."""

ROOT = "root"
"""What an edit calls the pose of the whole body."""


class Edit(BaseModel):
    """One change of one angle of one joint, or of the place of the root, over some frames."""

    model_config = ConfigDict(extra="forbid", frozen=True, strict=True)

    joint: Annotated[str, StringConstraints(min_length=1)]
    """Name of the joint; ``root`` for the whole body."""
    axis: Axis
    """Which of its movement axes, as in the columns of ``parameters.csv``; or the twist. The root
    turns in its place about its own axes 1 (forward), 2 (up) and 3 (right), and is shifted along
    the world's ``x``, ``y`` (up) and ``z``."""
    add_deg: Angle | None = None
    """deg, what is added to the angle."""
    set_deg: Angle | None = None
    """deg, what the angle becomes; the shorter way round."""
    add_m: Shift | None = None
    """m, by how much the root is shifted."""
    frames: tuple[int, int] | None = Field(default=None, strict=False)
    """First and last frame, both included, numbered as in the file the motion came from."""
    seconds: tuple[Length, Length] | None = Field(default=None, strict=False)
    """The same in s since the first stored frame. Neither: every frame."""
    blend_s: Length = 0.0
    """s before the first and after the last frame in which the change comes and goes."""

    @model_validator(mode="after")
    def _means_one_thing(self) -> "Edit":
        if self.axis in ("x", "y", "z"):
            if self.joint != ROOT:
                raise ValueError("shifts along x, y or z are for the root; joints turn")
            if self.add_m is None or self.add_deg is not None or self.set_deg is not None:
                raise ValueError(f"along {self.axis} needs add_m, and no angle")
        elif self.add_m is not None:
            raise ValueError("add_m needs axis = 'x', 'y' or 'z'")
        elif self.joint == ROOT and (self.axis == "twist" or self.add_deg is None):
            raise ValueError("the root turns about axis 1, 2 or 3 by add_deg")
        elif (self.add_deg is None) == (self.set_deg is None):
            raise ValueError("needs either add_deg or set_deg, and not both")
        if self.frames is not None and self.seconds is not None:
            raise ValueError("needs either frames or seconds, or neither for all frames")
        for name, span in (("frames", self.frames), ("seconds", self.seconds)):
            if span is not None and span[0] > span[1]:
                raise ValueError(f"{name} must be [first, last], found {list(span)}")
        return self


class Edits(BaseModel):
    """Edits in the order they are applied."""

    model_config = ConfigDict(extra="forbid", frozen=True)

    edit: tuple[Edit, ...] = Field(min_length=1)
    """In a file each is an ``[[edit]]``."""


def change_in_words(edit: Edit) -> str:
    """Return what an edit does as a person reads it: ``+30°``, ``to -5°``, ``+120 mm``."""
    if edit.add_m is not None:
        return f"{1e3 * edit.add_m:+g} mm"
    return f"{edit.add_deg:+g}°" if edit.add_deg is not None else f"to {edit.set_deg:g}°"


def frames_in_words(edit: Edit) -> str:
    """Return where an edit applies as a person reads it."""
    if edit.frames is not None:
        first, last = edit.frames
        return f"frame {first}" if first == last else f"frames {first}–{last}"
    if edit.seconds is not None:
        return f"{edit.seconds[0]:g}–{edit.seconds[1]:g} s"
    return "all frames"


def edit_in_words(edit: Edit) -> str:
    """Return an edit as one line: ``left elbow, axis 1: +30°, frames 100–200``."""
    axis = f"axis {edit.axis}" if isinstance(edit.axis, int) else edit.axis
    name = edit.joint.replace("_", " ")
    return f"{name}, {axis}: {change_in_words(edit)}, {frames_in_words(edit)}"
