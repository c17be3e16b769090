"""What parameterizes one joint, and the figures that are told of it."""

from collections.abc import Mapping
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from kinesphere.data import Array, AxesSource, Json
from kinesphere.data.skeleton import sources_of_axes


@dataclass(frozen=True, eq=False)
class JointFit:
    """What parameterizes one joint."""

    axes: Array
    """(n_axes, 3) unit vectors in the parent, distal first."""
    rest: Array
    """(3, 3) ``parent_from_child`` where all angles are zero."""
    source: AxesSource
    uncertainty: Array
    """(n_axes,) rad; NaN where unknown."""
    findings: Mapping[str, Json]
    doubts: tuple[str, ...]
    """What speaks against axes from the movement, each a clause."""
    kept: str = ""
    """Why axes from the movement serve in spite of doubts, a clause; empty where they do not."""
    added: str = ""
    """How far one axis falls short, where a second was added; empty where none was."""
    assumed: tuple[bool, ...] = ()
    """For each axis whether it was put across those that the movement tells; empty for none."""
    half_told: bool = False
    """Whether a movement tells one axis of the two that move the limb."""
    loose: str = ""
    """How far halves of the movement contradict each other where its axes still serve."""
    reused_from: tuple[str, ...] = ()
    """For each axis the recording it was taken from; empty for this one, or for none at all."""
    misfit: str = ""
    """How far axes from another recording miss the limb of this one, where they do."""
    gave_way: str = ""
    """Why axes from another recording do not serve though there are some, a clause."""

    @property
    def n_told(self) -> int:
        """How many of its axes the movement tells, here or where they are reused from."""
        return 0 if self.source == "body" else len(self.axes) - sum(self.assumed)

    @property
    def sources(self) -> tuple[AxesSource, ...]:
        """Where each axis is from."""
        return sources_of_axes(self.source, len(self.axes), self.assumed, self.reused_from)


def said_of(fit: JointFit) -> str:
    """Return what is doubted of a joint's axes; which axis, where one is told and one put across.

    The remark is about the axis that serves, all else about the one that was found in its place.
    """
    if not fit.half_told:
        return "; ".join(fit.doubts)
    told = fit.assumed.index(False)
    across = max(i for i, put in enumerate(fit.assumed) if put)  # the limb's own line comes first
    remark = fit.findings.get("remark")
    return "; ".join(
        f"axis {(told if doubt == remark else across) + 1}: {doubt}" for doubt in fit.doubts
    )


def angles_between(axes: Array) -> list[Json]:
    """Return the angles in deg between the lines of each axis and the next, (n_axes, 3)."""
    return [float(np.rad2deg(np.arccos(np.clip(abs(a @ b), 0, 1)))) for a, b in pairwise(axes)]


def or_null(values: Array) -> list[Json]:
    """Return figures, (n,), as JSON; null for those that are unknown."""
    return [float(value) if np.isfinite(value) else None for value in values]
