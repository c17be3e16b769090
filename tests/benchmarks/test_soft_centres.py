"""Centres under soft tissue beside plain least squares, as the results page has them."""

import numpy as np
import pytest
from benchmarks.accuracy.bodies.centres import _plain, _rows, centres_section

from kinesphere.geometry.rotations import rotation_exp


def test_plain_least_squares_finds_the_point_two_limbs_share(rng):
    rotations = rotation_exp(rng.normal(size=(20, 3)))
    centre, inner = np.array([0.1, -0.3, 0.05]), np.array([0.02, 0.25, -0.01])
    shifts = centre - rotations @ inner
    shifts[3] = np.nan
    np.testing.assert_allclose(_plain(rotations, shifts), centre, atol=1e-12)


@pytest.mark.slow
@pytest.mark.parametrize("seed", [900, 912])
def test_an_ankle_that_hardly_turns_is_found_about_as_well_as_by_plain_least_squares(seed):
    """These were 104 and 54 mm off: drawn to midway between the markers of shank and foot."""
    ankles = [row for row in _rows(seed) if row.joint.endswith("ankle")]
    assert len(ankles) == 2
    for row in ankles:
        assert row.ours_mm < 20
        assert row.ours_mm < row.plain_mm + 10


def test_the_section_has_a_line_a_kind_of_joint():
    joints = [f"left_{k}" for k in ("ankle", "knee", "hip", "shoulder", "elbow")] + ["neck"]
    rows = [
        {"actor": seed, "joint": joint, "ours_mm": off, "plain_mm": 2.0}
        for seed, off in ((1, 3.0), (2, 4.0))
        for joint in joints
    ]
    text = centres_section(rows)
    assert text.count("| 2 | 3.5 mm | 3.5 mm | 4.0 mm | 2.0 mm | 2.0 mm | 2.0 mm |") == 6
