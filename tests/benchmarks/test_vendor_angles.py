"""Clinical angles beside the vendor's: the alignment, and the bar on one real recording."""

import numpy as np
import pytest
from benchmarks.accuracy.vendor_angles import BAR_DEG, aligned_frames, vendor_rows
from scipy.spatial.transform import Rotation


def test_constant_turns_of_both_frames_are_found(rng):
    ours = Rotation.from_rotvec(rng.normal(0, 0.5, (60, 3)))
    p, c = Rotation.from_rotvec([0.3, -0.2, 0.5]), Rotation.from_rotvec([-0.4, 0.1, 0.2])
    found = aligned_frames((p * ours * c).as_matrix(), ours.as_matrix())
    np.testing.assert_allclose(found[0], p.as_matrix(), atol=1e-6)
    np.testing.assert_allclose(found[1], c.as_matrix(), atol=1e-6)


@pytest.mark.real
def test_hips_and_knees_of_a_walk_agree_with_the_vendor(recordings):
    path = recordings / "plugin-gait" / "PiG_Motion-FlatFoot-Full.c3d"
    rows = {row.joint: row for row, _ in vendor_rows(path)}
    assert len(rows) == 6
    for joint, row in rows.items():
        assert row.range > 25
        assert row.after_offset < BAR_DEG, joint
        if not joint.endswith("ankle"):
            assert row.aligned[0] < 2.0, joint
            # the signs are the vendor's: any of them turned round and this would be tens of degrees
            assert max(row.aligned) < 3.0, joint
