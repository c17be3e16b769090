"""The table of limb frames, against the motion it was written from."""

from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal
from scipy.spatial.transform import Rotation

from kinesphere.cli.main import run
from kinesphere.data import PoseFlag
from kinesphere.io import write, write_solution
from kinesphere.io.csv import read_columns
from kinesphere.pipeline import solve
from kinesphere.synthetic import make_performance

PRINTED = 1e-9  # m; twelve decimals of a quaternion, nine of a metre
POSE = ("x_m", "y_m", "z_m", "qx", "qy", "qz", "qw", "flag")


@pytest.fixture(scope="module")
def performance():
    return make_performance(np.random.default_rng(4), rate=10.0, calibration_s=8.0, free_s=1.0)


def read_back(path):
    table = read_columns(path)
    return dict(zip(table.names, table.values.T, strict=True))


def test_the_table_holds_every_frame_of_every_limb(performance, tmp_path):
    motion = performance.motion
    flags, rotations = np.array(motion.flags), np.array(motion.rotations)
    origins = np.array(motion.origins)
    flags[5:9, 2], rotations[5:9, 2], origins[5:9, 2] = PoseFlag.UNSEEN, np.nan, np.nan
    motion = replace(motion, flags=flags, rotations=rotations, origins=origins)
    write(motion, tmp_path / "a.limbs.csv")
    found = read_back(tmp_path / "a.limbs.csv")
    names = motion.skeleton.limb_names
    assert list(found) == ["time_s", *(f"{limb}.{what}" for limb in names for what in POSE)]
    assert_allclose(found["time_s"], motion.times, atol=PRINTED)
    for i, limb in enumerate(names):
        pose = np.stack([found[f"{limb}.{what}"] for what in POSE], axis=1)
        assert_array_equal(pose[:, 7], flags[:, i])
        assert_allclose(pose[:, :3], origins[:, i], atol=PRINTED)
        seen = flags[:, i] != PoseFlag.UNSEEN
        assert np.isnan(pose[~seen, :7]).all()
        assert (pose[seen, 6] >= 0).all()
        turns = Rotation.from_quat(pose[seen, 3:7]).as_matrix()
        assert_allclose(turns, rotations[seen, i], atol=PRINTED)


@pytest.mark.slow
def test_a_solved_folder_gives_limbs_or_parameters_by_the_name_asked_for(performance, tmp_path):
    solution = solve(performance.recording, performance.model)
    write_solution(solution, tmp_path / "solved")
    for name in ("frames.limbs.csv", "angles.csv"):
        assert run(["convert", str(tmp_path / "solved"), str(tmp_path / name)]) == 0
    limbs, angles = (read_back(tmp_path / n) for n in ("frames.limbs.csv", "angles.csv"))
    assert "left_shank.qw" in limbs
    assert "left_knee.axis1_deg" in angles
    with np.load(tmp_path / "solved/solution.npz", allow_pickle=False) as arrays:
        shank = list(arrays["limbs"]).index("left_shank")
        origins, rotations = arrays["motion.origins"], arrays["motion.rotations"]
    assert_allclose(limbs["left_shank.y_m"], origins[:, shank, 1], atol=PRINTED)
    markers = solution.skeleton.limb("left_shank")
    placed = np.einsum("fij,mj->fmi", rotations[:, shank], markers.marker_positions)
    column = solution.recording.labels.index(markers.markers[0])
    assert_allclose(
        placed[:, 0] + origins[:, shank], solution.recording.markers[:, column], atol=1e-4
    )
