"""Hips by motion and anatomy on known actors, as the results page has them."""

import numpy as np
import pytest
from benchmarks.accuracy.bodies.hips import MOTIONS, PEOPLE, Moved, hips_of
from benchmarks.accuracy.bodies.hips_page import hip_bars, hip_section
from benchmarks.accuracy.bodies.worn_pelvis import HIPS, wear_pelvis

from kinesphere.skeleton.anatomy import in_plane
from kinesphere.skeleton.body import Body
from kinesphere.synthetic import make_performance

SHORT = Moved("short", calibration_s=0.0, free_s=3.0)


def test_spines_tell_hips_as_far_off_as_is_said():
    performance = make_performance(np.random.default_rng(3), calibration_s=0, free_s=0.1)
    for times, misplaced in ((0.0, 0.0), (1.0, 0.0), (3.0, 0.010)):
        rng = np.random.default_rng(4)
        dressed = wear_pelvis(performance, rng, times=times, misplaced=misplaced)
        limb = dressed.performance.skeleton.limbs[0]
        body = Body(limb.name, None, limb.markers, limb.marker_positions, np.zeros(1))
        body.rotations, body.shifts = np.eye(3)[None], np.zeros((1, 3))
        own = zip(limb.markers, limb.marker_positions, strict=True)
        sample = {label: at[None] for label, at in own}
        for name, sign in zip(HIPS, (1.0, -1.0), strict=True):
            hip = performance.skeleton.joint(name).centre_in_parent
            found = in_plane(dressed.landmarks[name], body, sample, sign)
            off = 1e3 * np.linalg.norm(found - hip)
            # the book goes back at right angles to the pair, the landmark towards those behind
            close = 2.0 if misplaced else 1e-9
            assert off == pytest.approx(dressed.expected_mm[name], abs=close)
            if times == 0:
                assert off < 3  # but for the actor's own unevenness


@pytest.mark.slow
def test_anatomy_helps_where_motion_tells_little_and_costs_nothing_where_it_tells_much():
    by_name = {one.name: one for one in MOTIONS}
    people = PEOPLE[0]
    still, well = (
        [row for seed in (1100, 1101) for row in hips_of(by_name[name], people, seed)]
        for name in ("hips at rest", "hips well moved, noise alone")
    )
    assert all(row.both_mm < row.alone_mm / 2 for row in still)
    assert all(row.both_mm < row.both_told_mm for row in still)
    assert all(row.observability == "undetermined" for row in still)
    assert all(row.both_mm < row.alone_mm + 0.1 for row in well)
    assert all(row.observability == "determined" for row in well)


def test_the_page_says_what_was_found():
    rows = [vars(row) for people in PEOPLE for row in hips_of(SHORT, people, 1100)]
    for row in rows:
        row["motion"] = "hips well moved"
    page = hip_section(rows)
    assert page.count("| hips well moved |") == len(PEOPLE)
    lost, more, ratio = hip_bars(rows)
    usual = [row for row in rows if row["people"] == "as published"]
    both, alone = (
        np.sqrt(np.mean([row[key] ** 2 for row in usual])) for key in ("both_mm", "alone_mm")
    )
    assert lost[1] == f"{both / alone:.2f}"
    assert lost[3] == (both / alone <= 1.05)
    assert more[3]
    assert "to" in ratio[2]
