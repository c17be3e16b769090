"""The unlabelled arm of 4, 2 and 3 markers: its bodies, and its joints in halves of the trial."""

from dataclasses import replace

import numpy as np

from benchmarks.accuracy.bodies.arm_twin import twin_figures
from benchmarks.accuracy.bodies.cases import folder, hidden
from kinesphere import read
from kinesphere.data import Skeleton
from kinesphere.skeleton import discover, fit_skeleton
from kinesphere.skeleton.settings import SkeletonSettings


def arm_figures() -> dict[str, object]:
    """Return the sizes of the bodies and how far joint centres of the halves are apart, mm.

    Centres are compared in the frame of the joint's better-marked limb, the halves' shapes laid on
    each other by its own markers: a body of two markers has no frame of its own.
    """
    recording = hidden(read(folder() / "rigid-bodies" / "arm-4-2-3.c3d"))
    found = discover(recording)
    middle = recording.n_frames // 2
    parts = [
        replace(recording, markers=np.array(part))
        for part in (recording.markers[:middle], recording.markers[middle:])
    ]
    halves = [fit_skeleton(part, found.model).skeleton for part in parts]
    alone = SkeletonSettings(link_limbs=False)
    limb_by_limb = [fit_skeleton(part, found.model, alone).skeleton for part in parts]
    whole = fit_skeleton(recording, found.model)
    return {
        "sizes": sorted(len(segment.markers) for segment in found.model.segments),
        "joints": len(found.model.joints),
        "halves_mm": _apart(*halves),
        "limb_by_limb_mm": _apart(*limb_by_limb),
        "told_mm": {
            joint.name: 1e3 * float(np.sqrt(np.trace(joint.covariance + other.covariance)))
            for joint, other in zip(halves[0].joints, halves[1].joints, strict=True)
        },
        "twins": twin_figures(
            recording, whole, lambda twin: fit_skeleton(twin, found.model), _apart
        ),
    }


def _apart(first: Skeleton, second: Skeleton) -> dict[str, float]:
    """Return joint → how far apart its centres are in its better-marked limb, mm."""
    apart = {}
    for joint in first.joints:
        ends = [first.limb(name) for name in (joint.parent, joint.child)]
        better = max(ends, key=lambda limb: len(limb.markers)).name
        centres = []
        for half in (first, second):
            here = half.joint(joint.name)
            centre = here.centre_in_parent if better == here.parent else here.centre_in_child
            centres.append((half.limb(better).marker_positions, centre))
        apart[joint.name] = 1e3 * float(np.linalg.norm(_laid_on(*centres)))
    return apart


def _laid_on(first, second) -> np.ndarray:
    """Return the second centre minus the first, shapes laid on each other by their markers."""
    (a, centre_a), (b, centre_b) = first, second
    middle_a, middle_b = a.mean(axis=0), b.mean(axis=0)
    u, _, vt = np.linalg.svd((b - middle_b).T @ (a - middle_a))
    turn = u @ np.diag([1, 1, np.sign(np.linalg.det(u @ vt))]) @ vt
    return (centre_b - middle_b) @ turn - (centre_a - middle_a)
