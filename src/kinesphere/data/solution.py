"""Everything one run of the line found out about one recording."""

from collections.abc import Mapping
from dataclasses import dataclass, field

from kinesphere.data.history import History
from kinesphere.data.motion import Motion
from kinesphere.data.parameters import Parameters
from kinesphere.data.recording import Recording
from kinesphere.data.skeleton import Skeleton
from kinesphere.data.surface import Surface


@dataclass(frozen=True, eq=False)
class Solution:
    """A recording with its skeleton, motion and parameters."""

    recording: Recording
    """In the world (y up), with the labels of the model."""
    motion: Motion
    """Normalized: limb frames aligned with the body."""
    parameters: Parameters
    """Its skeleton is the final one: axes and rest positions included."""
    model_name: str
    """Which topological model was used; ``none`` where the motion alone served."""
    seconds: Mapping[str, float] = field(default_factory=dict)
    """Stage → how long it took."""
    surface: Surface | None = None
    """What rides on the skeleton, bound in its default position; None where nothing can."""

    @property
    def skeleton(self) -> Skeleton:
        """The final skeleton."""
        return self.parameters.skeleton

    @property
    def history(self) -> History:
        """Every step from the file to the parameters."""
        return self.parameters.history

    @property
    def warnings(self) -> tuple[str, ...]:
        """What was guessed, overridden or doubtful, in the order it came up."""
        return tuple(warning for step in self.history for warning in step.warnings)
