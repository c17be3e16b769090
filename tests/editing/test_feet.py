"""Contacts, pins and the pelvis, each against what it must do."""

import numpy as np
import pytest
from numpy.testing import assert_allclose

from kinesphere.editing.foot_contacts import BALL, HEEL, find_contacts, find_ground, runs
from kinesphere.editing.foot_pins import foot_shifts
from kinesphere.editing.pelvis import pelvis_drop
from kinesphere.editing.retarget_settings import RetargetSettings

RATE = 100.0
EXACT = 1e-12


def steps(n=400):
    """Return heels and balls of two feet that take turns, and when they truly stand."""
    t = np.arange(n) / RATE
    points = np.zeros((n, 2, 2, 3))
    standing = np.zeros((n, 2), dtype=bool)
    for f in range(2):
        phase = (t + 0.5 * f) % 1.0
        swing = phase > 0.6
        share = np.where(swing, (phase - 0.6) / 0.4, 0.0)
        cycle = np.floor(t + 0.5 * f)
        x = 1.2 * (cycle + share - np.sin(2 * np.pi * share) / (2 * np.pi))
        lift = np.where(swing, 0.12 * np.sin(np.pi * share) ** 2, 0.0)
        for k, ahead in ((HEEL, -0.05), (BALL, 0.15)):
            points[:, f, k] = np.stack([x + ahead, lift, np.full(n, 0.1 * f)], axis=1)
        standing[:, f] = ~swing
    return points, standing


def test_standing_feet_are_found_to_a_few_frames():
    points, standing = steps()
    found = find_contacts(points, RATE, 0.85, RetargetSettings())
    for f in range(2):
        for k in range(2):
            assert (found[:, f, k] != standing[:, f]).mean() < 0.1
            assert len(runs(found[:, f, k])) == len(runs(standing[:, f]))


def test_contacts_scale_with_the_body_and_not_with_the_rate():
    points, _ = steps()
    once = find_contacts(points, RATE, 0.85, RetargetSettings())
    # twice as large is twice as fast: the legs say so
    assert (find_contacts(2 * points, RATE, 1.7, RetargetSettings()) == once).all()
    half = find_contacts(points[::2], RATE / 2, 0.85, RetargetSettings())
    assert (half != once[::2]).mean() < 0.03


def test_short_contacts_are_none():
    speed = np.full(400, 2.0)
    speed[150:158] = 0.0  # 80 ms, of which smoothing leaves less
    points = np.zeros((400, 2, 2, 3))
    points[..., 0] = (np.cumsum(speed) / RATE)[:, None, None]
    assert not find_contacts(points, RATE, 0.85, RetargetSettings()).any()
    speed[150:180] = 0.0
    points[..., 0] = (np.cumsum(speed) / RATE)[:, None, None]
    found = find_contacts(points, RATE, 0.85, RetargetSettings())
    assert runs(found[:, 0, HEEL]) == runs(found[:, 1, BALL])
    assert len(runs(found[:, 0, HEEL])) == 1


@pytest.mark.parametrize(("height", "floor"), [(0.08, 0.0), (0.6, 0.5235), (-0.4, -0.4765)])
def test_the_floor_is_zero_unless_ankles_say_otherwise(height, floor):
    ankles = np.zeros((50, 2, 3))
    ankles[..., 1] = height
    ground = find_ground(ankles, 0.85)
    assert ground.floor == pytest.approx(floor)
    assert bool(ground.warnings) == (floor != 0.0)


def slid(n=300):
    """Return heel and ball that slide while they stand: the heel, then both, then the ball."""
    t = np.arange(n) / RATE
    points = np.zeros((n, 2, 3))
    points[:, :, 0] = 0.05 * np.sin(2 * t)[:, None] + [0.0, 0.2]
    points[:, :, 2] = 0.01 * t[:, None] ** 2
    points[:, BALL, 1] = 0.02 * np.cos(t)
    contacts = np.zeros((n, 2), dtype=bool)
    contacts[100:160, HEEL] = True
    contacts[130:200, BALL] = True
    contacts[260:, BALL] = True
    return points, contacts


def test_what_is_held_stands_still_and_nothing_leaps():
    points, contacts = slid()
    levels = np.full((300, 2), 0.005)
    shifts, pins = foot_shifts(points, contacts, levels, RATE, 0.2)
    after = points + shifts[:, None]
    assert [(p, a, b) for p, a, b, _ in pins] == [
        (HEEL, 100, 130),
        (BALL, 130, 200),
        (BALL, 260, 300),
    ]
    for point, a, b, _ in pins:
        assert np.ptp(after[a:b, point], axis=0).max() < EXACT
    assert_allclose(shifts[100:200, [0, 2]].mean(axis=0), 0, atol=EXACT)
    held = np.concatenate([after[100:130, HEEL, 1], after[130:200, BALL, 1]])
    assert held.mean() == pytest.approx(0.005)
    assert_allclose(shifts[:80], 0, atol=EXACT)
    speeds = np.linalg.norm(np.diff(after, axis=0), axis=2) * RATE
    fastest = np.linalg.norm(np.diff(points, axis=0), axis=2).max() * RATE
    assert speeds.max() < fastest + 2 * 0.05 / 0.2, "5 cm come and go within 0.2 s"
    turns = np.linalg.norm(np.diff(shifts, 2, axis=0), axis=1)
    assert turns.max() < 2e-3, "no step in place, and hardly one in speed"


def test_feet_that_never_stand_are_left_alone():
    points, contacts = slid()
    shifts, pins = foot_shifts(points, np.zeros_like(contacts), np.zeros((300, 2)), RATE, 0.2)
    assert not shifts.any()
    assert not pins


def test_the_pelvis_goes_down_as_far_as_needed_and_smoothly():
    n = 200
    hips = np.tile([0.0, 0.9, 0.0], (n, 1, 1)).reshape(n, 1, 3)
    goals = np.zeros((n, 1, 3))
    goals[80:120, 0, 0] = 0.3
    reach = np.full((n, 1), 0.9)
    drop = pelvis_drop(hips, goals, reach, RATE)
    needed = 0.9 - np.sqrt(0.81 - goals[:, 0, 0] ** 2)
    assert (drop >= needed - EXACT).all()
    assert drop.max() == pytest.approx(needed.max())
    assert np.abs(np.diff(drop)).max() < 0.1 * needed.max()
    assert not drop[:30].any()


def test_a_goal_too_far_aside_asks_for_nothing():
    hips, goals = np.tile([0, 0.9, 0], (20, 1, 1)), np.tile([5.0, 0, 0], (20, 1, 1))
    assert not pelvis_drop(hips, goals, np.full((20, 1), 0.9), RATE).any()


def test_a_stutter_of_a_standing_foot_is_passed_over():
    points, standing = steps()
    stance = next(a for a, b in runs(standing[:, 0]) if a > 0 and b - a > 50)
    points[stance + 30 : stance + 32, 0, BALL, 0] += 0.02  # a marker that hops for two frames
    found = find_contacts(points, RATE, 0.85, RetargetSettings())
    assert found[stance + 15 : stance + 45, 0, BALL].all()
