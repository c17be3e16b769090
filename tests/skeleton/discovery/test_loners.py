"""Markers at joints, lonely markers and loose ones."""

import numpy as np
import pytest

from kinesphere.skeleton.discovery.belonging import Belonging, measure_belonging
from kinesphere.skeleton.discovery.joint_costs import JointCosts
from kinesphere.skeleton.discovery.joint_tree import find_forest
from kinesphere.skeleton.discovery.loners import resettle
from kinesphere.skeleton.discovery.rigidity import measure_rigidity
from kinesphere.skeleton.discovery.steadiness import owners, steadiness, usual_wander

RATIO, CHAIN = 2.0, 3.0


def leg(rng, n=400, noise=0.0005):
    """Pelvis 0–3, thigh 4, knee 5, shin 6, ankle 7, foot 8–10, in a plane that turns."""
    t = np.linspace(0, 14, n)
    hip, knee, ankle = 0.5 * np.sin(t), 0.6 + 0.6 * np.sin(1.7 * t), 0.4 * np.sin(2.3 * t)

    def along(angle):
        return np.stack([np.sin(angle), -np.cos(angle), 0 * angle], axis=1)

    thigh, shank = along(hip), along(hip - knee)
    knee_at = 0.42 * thigh
    ankle_at = knee_at + 0.42 * shank
    toes = along(hip - knee + ankle + np.pi / 2)
    side = np.array([0.0, 0.0, 0.05])
    points = [
        *(np.tile(p, (n, 1)) for p in rng.normal(scale=0.08, size=(4, 3))),
        0.2 * thigh + side + [0.0, 0.0, 0.03],
        knee_at + side,
        knee_at + 0.2 * shank + side,
        ankle_at + side,
        ankle_at - 0.05 * toes - side,
        ankle_at + 0.15 * toes - side,
        ankle_at + 0.12 * toes + side,
    ]
    cloud = np.stack(points, axis=1)
    return cloud + rng.normal(scale=noise, size=cloud.shape)


def settled(points, bodies):
    rigidity = measure_rigidity(points)
    kept, loose = resettle(rigidity, bodies, JointCosts(points), RATIO, CHAIN)
    return [members.tolist() for members in kept], loose


def test_a_lonely_shin_takes_the_ankle_from_the_foot(rng):
    bodies = [np.arange(4), np.array([4, 5]), np.array([6]), np.array([7, 8, 9, 10])]
    kept, loose = settled(leg(rng), bodies)
    assert kept == [[0, 1, 2, 3], [4, 5], [6, 7], [8, 9, 10]]
    assert loose == []


def test_a_marker_of_a_body_that_was_cut_off_joins_it_again(rng, moving_bodies):
    points, _ = moving_bodies(rng, (4, 4), apart=0.1, noise=0.0005)
    kept, loose = settled(points, [np.array([0, 1, 2]), np.array([3]), np.arange(4, 8)])
    assert kept == [[0, 1, 2, 3], [4, 5, 6, 7]]
    assert loose == []


def test_cloth_belongs_to_nobody(rng, moving_bodies):
    points, _ = moving_bodies(rng, (4, 4), apart=0.1, noise=0.0005)
    cloth = points[:, :1] + 0.1 + np.cumsum(rng.normal(scale=0.01, size=(200, 1, 3)), axis=0)
    points = np.concatenate([points, cloth], axis=1)
    alone = [np.arange(4), np.arange(4, 8), np.array([8])]
    inside = [np.array([0, 1, 2, 3, 8]), np.arange(4, 8)]
    for bodies in (alone, inside):
        kept, loose = settled(points, bodies)
        assert kept == [[0, 1, 2, 3], [4, 5, 6, 7]]
        assert loose == [8]


def test_a_marker_over_a_joint_is_seen_to_be_at_it(rng):
    points = leg(rng)
    bodies = [np.arange(4), np.array([4, 5]), np.array([6, 7]), np.array([8, 9, 10])]
    forest = find_forest(JointCosts(points), bodies)
    rigidity = measure_rigidity(points)
    belonging = measure_belonging(rigidity, bodies, forest, 0.003, 0.008)
    shared = belonging.shared(usual_wander(rigidity.wander, bodies), RATIO)
    assert {5, 7} <= set(shared.tolist())
    assert not {0, 1, 2, 3} & set(shared.tolist())
    assert belonging.neighbour[5] == 2
    assert belonging.neighbour[7] == 3


def test_confidence_is_half_on_a_tie_and_one_without_neighbours():
    belonging = Belonging(
        own=np.array([0.01, 0.001, np.nan, 0.001]),
        next=np.array([0.01, 0.1, 0.0, np.inf]),
        neighbour=np.array([1, 1, 0, -1]),
    )
    tie, sure, loner, alone = belonging.confidence(1e-9)
    assert tie == pytest.approx(0.5)
    assert sure > 0.999
    assert loner < 0.6
    assert alone == 1


def test_steadiness_is_the_rms_of_wanders(rng):
    wander = np.abs(rng.normal(size=(6, 6)))
    wander += wander.T
    np.fill_diagonal(wander, 0)
    wander[0, 2] = wander[2, 0] = np.nan
    bodies = [np.array([0, 1, 2]), np.array([3, 5])]
    steady = steadiness(wander, bodies)
    assert steady[4, 1] == pytest.approx(np.sqrt((wander[4, 3] ** 2 + wander[4, 5] ** 2) / 2))
    assert steady[0, 0] == pytest.approx(wander[0, 1])
    assert steady[3, 1] == pytest.approx(wander[3, 5])
    assert owners(bodies, 6).tolist() == [0, 0, 0, 1, -1, 1]
