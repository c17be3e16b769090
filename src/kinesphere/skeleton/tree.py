"""What of a model is there to be measured: limbs with markers in the recording."""

from dataclasses import dataclass

import numpy as np

from kinesphere.data import JointModel, Recording, TopologicalModel
from kinesphere.errors import BadRecording


@dataclass(frozen=True)
class Tree:
    """The limbs of a model that a recording shows, parents first."""

    root: str
    joints: tuple[JointModel, ...]
    markers: dict[str, tuple[str, ...]]
    """Limb → labels it owns that are in the recording and seen at least once."""
    warnings: tuple[str, ...]

    @property
    def limbs(self) -> tuple[str, ...]:
        """Names of the limbs, root first."""
        return (self.root, *(joint.child for joint in self.joints))

    def parent(self, limb: str) -> str | None:
        """Return the limb's parent; None for the root."""
        return next((joint.parent for joint in self.joints if joint.child == limb), None)

    def children(self, limb: str) -> tuple[str, ...]:
        """Return the limbs that hang from a limb."""
        return tuple(joint.child for joint in self.joints if joint.parent == limb)

    def joint_columns(self, recording: Recording) -> list[tuple[list[int], list[int]]]:
        """Return of each joint the columns of the markers of either limb."""
        own = {limb: list(recording.columns(labels)) for limb, labels in self.markers.items()}
        return [(own[joint.parent], own[joint.child]) for joint in self.joints]


def find_tree(recording: Recording, model: TopologicalModel) -> Tree:
    """Return the limbs of the model that the recording shows.

    A limb without a single marker is left out with all it carries, aloud.

    Raises
    ------
    BadRecording
        If the root has fewer than three markers.
    """
    ever = np.asarray(recording.seen.any(axis=0))
    there = {label for label, once in zip(recording.labels, ever, strict=True) if once}
    markers = {
        segment.name: tuple(label for label in segment.markers if label in there)
        for segment in model.segments
    }
    if len(markers[model.root]) < 3:
        needed = model.segment(model.root).markers
        raise BadRecording(
            f"the root {model.root} of model {model.name} needs at least three of the markers "
            f"{', '.join(needed)}; the recording shows {', '.join(markers[model.root]) or 'none'}"
        )
    kept, warnings = {model.root}, []
    joints = []
    for joint in model.joints_from_root:
        if joint.parent in kept and markers[joint.child]:
            kept.add(joint.child)
            joints.append(joint)
            continue
        wanted = ", ".join(model.segment(joint.child).markers) or "no marker"
        why = (
            f"none of its markers ({wanted}) is seen"
            if joint.parent in kept
            else f"it hangs from {joint.parent}, which is left out"
        )
        warnings.append(f"limb {joint.child} is left out: {why}")
    return Tree(model.root, tuple(joints), {n: markers[n] for n in kept}, tuple(warnings))
