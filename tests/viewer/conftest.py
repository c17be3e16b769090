"""A solved actor, and the same with gaps."""

from dataclasses import replace

import numpy as np
import pytest

from kinesphere.data import PoseFlag
from kinesphere.pipeline import solve
from kinesphere.synthetic import make_performance


@pytest.fixture(scope="session")
def solution():
    true = make_performance(np.random.default_rng(3), rate=10.0, calibration_s=12.0, free_s=4.0)
    return solve(true.recording, true.model, calibration=true.calibration)


@pytest.fixture(scope="session")
def gappy(solution):
    motion = solution.motion
    rotations, origins = np.array(motion.rotations), np.array(motion.origins)
    flags = np.array(motion.flags)
    arm = motion.skeleton.limb_names.index("left_upper_arm")  # it carries another
    rotations[7:9, arm], origins[7:9, arm], flags[7:9, arm] = np.nan, np.nan, PoseFlag.UNSEEN
    markers = np.array(solution.recording.markers)
    markers[7:9, 2] = np.nan
    return replace(
        solution,
        motion=replace(motion, rotations=rotations, origins=origins, flags=flags),
        recording=replace(solution.recording, markers=markers),
    )
