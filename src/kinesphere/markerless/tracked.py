"""What tracking found: poses, joint centres, and how far to trust each limb in each frame."""

from dataclasses import dataclass, field
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from kinesphere.data import Array, History, Mask, Surface

CHECKS = "scene checks"
"""What the step is called that tells whether the cameras agree."""
CULPRIT = "wrong_camera"
"""Where that step names the camera that does not fit the others."""

DOUBT = "start_doubt"
"""Where the step ``track`` says why its start may be wrong; empty where it may be believed."""


class PosedBody(Protocol):
    """A body model as drawing and reports need it."""

    @property
    def faces(self) -> NDArray[np.int32]:
        """(n_faces, 3) vertex indices, counter-clockwise seen from outside."""
        ...

    @property
    def limb_of_face(self) -> NDArray[np.int32]:
        """(n_faces,) which limb of ``TrackedMotion.limb_names`` a face belongs to."""
        ...

    def vertices(self, parameters: Array) -> Array:
        """Return the skinned surface in the world, (n_parameters,) → (n_vertices, 3) m."""
        ...


@dataclass(frozen=True, eq=False)
class TrackedMotion:
    """Poses of a body model over the frames of a scene; NaN in frames without a pose."""

    body: PosedBody
    """As fitted to the person."""
    parameter_names: tuple[str, ...]
    parameters: Array
    """(n_frames, n_parameters), m and rad."""
    limb_names: tuple[str, ...]
    """Names of the house's limbs, root first, parents before children."""
    limb_parents: tuple[int, ...]
    """Index of each limb's parent; −1 for the root."""
    joint_names: tuple[str, ...]
    """``joint_names[i]`` joins ``limb_names[i + 1]`` to its parent."""
    rotations: Array
    """(n_frames, n_limbs, 3, 3) ``world_from_limb``."""
    origins: Array
    """(n_frames, n_limbs, 3) m: the joint towards the parent, of the root its own origin."""
    ends: Array
    """(n_limbs, 3) m in the limb frame: the far end (next joint, finger tips, toes, crown)."""
    overlap: Array
    """(n_frames, n_cameras) intersection over union of model and person; NaN without image."""
    support: Array
    """(n_frames, n_limbs) 0–1: share of the limb's visible evidence that speaks for its pose; NaN
    where no camera shows enough of the limb to tell."""
    lost: Mask
    """(n_frames, n_limbs) True where a limb is held lost: overlap alone does not notice."""
    rate: float
    """Hz."""
    seconds: dict[str, float] = field(default_factory=dict)
    """Module (decoding, segmentation, rasterizing, …) → time spent."""
    history: History = ()
    surface: Surface | None = None
    """The body in the bind pose, fitted to the person."""
    by_mask: Mask | None = None
    """(n_frames, n_cameras) where a given mask was what ``overlap`` compares with; elsewhere it is
    what colours tell. None where nobody kept account."""
    n_reached: int | None = None
    """How many frames were looked at before tracking was interrupted; None where all were."""

    @property
    def n_frames(self) -> int:
        """Number of frames."""
        return len(self.parameters)

    @property
    def overlap_with_masks(self) -> Array:
        """(n_frames, n_cameras) as ``overlap``, NaN where no mask was given."""
        given = np.zeros(self.overlap.shape, dtype=bool) if self.by_mask is None else self.by_mask
        return np.where(given, self.overlap, np.nan)

    @property
    def start_doubt(self) -> str:
        """Why the first pose may be wrong, and with it all; empty where it may be believed."""
        return next((str(s.findings[DOUBT]) for s in self.history if s.findings.get(DOUBT)), "")

    @property
    def joint_centres(self) -> Array:
        """(n_frames, n_joints, 3) m in the world: where each limb but the root begins."""
        return self.origins[:, 1:]

    @property
    def solved(self) -> Mask:
        """(n_frames,) True where the frame has a pose."""
        solved: Mask = np.asarray(np.isfinite(self.parameters).all(axis=1))
        return solved
