"""Pose edits by joint parameter, a list to be replayed (Sar Dessai et al. 2006, figure 5)."""

from typing import Annotated, Literal

from pydantic import BaseModel, ConfigDict, Field, StringConstraints, model_validator

Angle = Annotated[float, Field(allow_inf_nan=False, ge=-3600.0, le=3600.0)]
Length = Annotated[float, Field(allow_inf_nan=False, ge=0.0)]


class Edit(BaseModel):
    """One change of one angle of one joint, over some frames."""

    model_config = ConfigDict(extra="forbid", frozen=True, strict=True)

    joint: Annotated[str, StringConstraints(min_length=1)]
    """Name of the joint."""
    axis: Literal[1, 2, 3, "twist"]
    """Which of its movement axes, as in the columns of ``parameters.csv``; or the twist."""
    add_deg: Angle | None = None
    """deg, what is added to the angle."""
    set_deg: Angle | None = None
    """deg, what the angle becomes; the shorter way round."""
    frames: tuple[int, int] | None = Field(default=None, strict=False)
    """First and last frame, both included, numbered as in the file the motion came from."""
    seconds: tuple[Length, Length] | None = Field(default=None, strict=False)
    """The same in s since the first stored frame. Neither: every frame."""
    blend_s: Length = 0.0
    """s before the first and after the last frame in which the change comes and goes."""

    @model_validator(mode="after")
    def _means_one_thing(self) -> "Edit":
        if (self.add_deg is None) == (self.set_deg is None):
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
