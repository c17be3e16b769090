"""A solution whose every number is known: the truth of a synthetic actor, with awkward labels."""

from dataclasses import replace

import numpy as np
import pytest

from kinesphere.data import JointFlag, PoseFlag, Solution, Step
from kinesphere.synthetic import make_performance

HOSTILE = "</script><script>alert(1)</script>"
QUOTED = "</script \"'><img src=x onerror=alert(2)><!--<script "


@pytest.fixture(scope="session")
def solution():
    performance = make_performance(
        np.random.default_rng(3), rate=90.0, calibration_s=4.0, free_s=0.5, repetitions=1
    )
    return solution_from(performance)


def solution_from(performance):
    """Dress the truth up as a solution with gaps, flags, warnings and hostile names."""
    recording, motion = performance.recording, performance.motion
    rng = np.random.default_rng(5)
    markers = np.array(recording.markers)
    markers[10:40, 2] = np.nan
    markers[:, 3] = np.nan
    labels = (HOSTILE, QUOTED, *recording.labels[2:])
    limbs = list(motion.skeleton.limbs)
    limbs[0] = replace(
        limbs[0],
        markers=tuple(
            dict(zip(recording.labels, labels, strict=True))[m] for m in limbs[0].markers
        ),
    )
    skeleton = replace(performance.parameters.skeleton, limbs=tuple(limbs))
    flags, rotations = np.array(motion.flags), np.array(motion.rotations)
    origins = np.array(motion.origins)
    flags[20:30, 4], rotations[20:30, 4], origins[20:30, 4] = PoseFlag.UNSEEN, np.nan, np.nan
    residuals = rng.uniform(0, 0.004, flags.shape)
    joint_flags = np.array(performance.parameters.flags)
    joint_flags[20:30, 3] |= np.uint8(JointFlag.UNSEEN)
    joint_flags[50:52, 3] |= np.uint8(JointFlag.SINGULAR)
    history = (
        Step("read", findings={"format": "C3D", "unit": "mm"}, warnings=(f"label {HOSTILE}",)),
        Step(
            "skeleton",
            settings={"outlier_mm": 3.0, "nested": {"deep": True}},
            findings={"residual_rms_mm": 1.25, "limbs_missing": []},
            warnings=("a warning twice", "a warning twice"),
            version="9.9.9",
        ),
    )
    parameters = replace(
        performance.parameters,
        skeleton=skeleton,
        flags=joint_flags,
        residuals=rng.uniform(0, 0.02, joint_flags.shape),
        history=history,
    )
    return Solution(
        recording=replace(recording, markers=markers, labels=labels),
        motion=replace(
            motion,
            skeleton=skeleton,
            rotations=rotations,
            origins=origins,
            flags=flags,
            residuals=residuals,
        ),
        parameters=parameters,
        model_name="human <bodies>",
        seconds={"skeleton": 1.5},
    )
