"""The unlabelled arm of 4, 2 and 3 markers: its bodies, and its joints in halves of the trial."""

from dataclasses import replace

import numpy as np

from benchmarks.accuracy.bodies.apart import apart, apart_in_whole, told
from benchmarks.accuracy.bodies.arm_twin import twin_figures
from benchmarks.accuracy.bodies.cases import folder, hidden
from kinesphere import read
from kinesphere.skeleton import discover, fit_skeleton
from kinesphere.skeleton.settings import SkeletonSettings


def arm_figures() -> dict[str, object]:
    """Return the sizes of the bodies and how far joint centres of the halves are apart, mm.

    Two readings of "in the better-marked limb's frame": shapes of the halves laid on each other,
    and the limb as the whole trial has it posed.
    """
    recording = hidden(read(folder() / "rigid-bodies" / "arm-4-2-3.c3d"))
    found = discover(recording)
    middle = recording.n_frames // 2
    parts = slice(middle), slice(middle, None)
    solved = []
    for settings in (SkeletonSettings(), SkeletonSettings(link_limbs=False)):
        solved.append(
            [
                fit_skeleton(
                    replace(recording, markers=np.array(recording.markers[part])),
                    found.model,
                    settings,
                )
                for part in parts
            ]
        )
    halves, alone = solved
    whole = fit_skeleton(recording, found.model)
    return {
        "sizes": sorted(len(segment.markers) for segment in found.model.segments),
        "joints": len(found.model.joints),
        "halves_mm": apart(*(half.skeleton for half in halves)),
        "posed_by_whole_mm": apart_in_whole((halves[0], halves[1]), whole, parts),
        "limb_by_limb_mm": apart(*(half.skeleton for half in alone)),
        "told_mm": told(*(half.skeleton for half in halves)),
        "twins": twin_figures(
            recording, whole, lambda twin: fit_skeleton(twin, found.model), apart
        ),
    }
