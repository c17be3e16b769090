"""Closed forms against brute force: least squares, dense grids, finite differences."""

from itertools import pairwise

import numpy as np
import pytest
from numpy.testing import assert_allclose
from scipy.optimize import least_squares
from scipy.spatial.transform import Rotation

from kinesphere.geometry.chain import joint_rotations
from kinesphere.geometry.rotations import rotation_about, rotation_angle
from kinesphere.parameterization.angles import solve_angles
from kinesphere.parameterization.kernels import (
    APART,
    MOST_CHANGE,
    smoothest_branches,
    two_axis_solutions,
)
from kinesphere.parameterization.settings import AngleSettings, TwistSettings
from kinesphere.parameterization.twist import closed_twist

DISTANCE = 1e-9  # chord; the optimizer's own tolerance
STARTS = np.array([[a, b] for a in (-2.0, 0.0, 2.0) for b in (-1.5, 1.5)])


def draw(rng):
    axes = Rotation.random(2, rng=rng).apply([1, 0, 0])
    return axes, Rotation.random(rng=rng).as_matrix(), Rotation.random(rng=rng).apply([1, 0, 0])


def reach(axes, rest, long_axis, angles):
    swung = rotation_about(axes[0], np.array(angles[0])) @ rest @ long_axis
    return rotation_about(axes[1], np.array(angles[1])) @ swung


def searched(axes, rest, long_axis, target):
    """Return the least distance that a numerical search from several starts finds."""

    def miss(angles):
        return reach(axes, rest, long_axis, angles) - target

    return min(np.sqrt(2 * least_squares(miss, start, xtol=1e-15).cost) for start in STARTS)


def test_no_two_angles_come_closer_than_the_closed_form(rng):
    compared = 0
    while compared < 12:
        axes, rest, long_axis = draw(rng)
        if abs(axes[0] @ axes[1]) > 0.9:
            continue
        pose = Rotation.random(rng=rng).as_matrix()
        target = pose @ long_axis
        solutions, _, excess = two_axis_solutions(pose[None], *axes, rest, long_axis)
        nearest = searched(axes, rest, long_axis, target)
        for branch in range(2):
            closed = np.linalg.norm(reach(axes, rest, long_axis, solutions[0, branch]) - target)
            assert closed <= nearest + DISTANCE
            assert closed == pytest.approx(2 * np.sin(excess[0] / 2), abs=1e-7)
        compared += 1


def test_no_twist_of_a_dense_grid_is_better(rng):
    model, actual = Rotation.random(2, rng=rng).as_matrix()
    long_axis = Rotation.random(rng=rng).apply([1, 0, 0])
    best = closed_twist(model[None], actual[None], long_axis)

    def apart(twists):
        return rotation_angle(actual.T @ model @ rotation_about(long_axis, twists))

    assert apart(best)[0] <= apart(np.linspace(-np.pi, np.pi, 7201)).min() + 1e-12


def test_singular_exactly_where_the_jacobian_loses_rank(rng):
    axes, rest, long_axis = draw(rng)
    angles = rng.uniform(-2, 2, (9, 2))
    twists = rng.uniform(-1, 1, 9)
    rotations = joint_rotations(axes, rest, long_axis, angles, twists)
    _, sines, _ = two_axis_solutions(rotations, *axes, rest, long_axis)
    step = 1e-6
    for i in range(9):
        columns = []
        for k in range(3):
            plus = np.array([*angles[i], twists[i]])
            plus[k] += step
            moved = joint_rotations(axes, rest, long_axis, plus[None, :2], plus[2:])[0]
            spin = (moved @ rotations[i].T - np.eye(3)) / step
            columns.append([spin[2, 1], spin[0, 2], spin[1, 0]])
        volume = abs(np.linalg.det(np.array(columns)))
        assert volume == pytest.approx(
            sines[i] * np.linalg.norm(np.cross(*axes)), abs=1e-5
        )  # forward differences


@pytest.mark.parametrize(("spread", "nearby"), [(0.3, 1), (0.4, 2)])
def test_the_smoothest_path_is_the_cheapest_of_all(rng, spread, nearby):
    n, leap = 9, 2.0
    # two branches that lie apart now and then, and change places
    sides = np.where(rng.random((n, 1, 1)) < 0.5, 1.0, -1.0) * np.array([[[-1.6], [1.6]]])
    solutions = (1 - spread) * sides + spread * rng.uniform(-np.pi, np.pi, (n, 2, 3))
    solutions[4] = np.nan
    known = rng.random(n) > 0.3
    own = rng.uniform(0, 1, (n, 2))
    chosen = smoothest_branches(solutions, known, own, leap, nearby)
    leaps = 0

    def changed(a, b, i, j):
        parts = 3 if known[a] and known[b] else 2
        change = solutions[b, j, :parts] - solutions[a, i, :parts]
        return np.abs(np.angle(np.exp(1j * change))).sum()

    def step(a, b, i, j):
        nonlocal leaps
        keeping = (changed(a, b, 0, 0) + changed(a, b, 1, 1)) / 2
        crossing = (changed(a, b, 0, 1) + changed(a, b, 1, 0)) / 2
        dearer = (keeping - crossing) * (1 if i == j else -1)
        far = dearer > (APART if known[a] and known[b] else APART * 2 / 3)
        far = far and b - a <= nearby
        leaps += far
        return min(changed(a, b, i, j), MOST_CHANGE) + (leap if far else 0)

    def cost(path):
        seen = [f for f in range(n) if f != 4]
        total = sum(own[f, path[f]] for f in seen)
        return total + sum(step(a, b, path[a], path[b]) for a, b in pairwise(seen))

    cheapest = min(cost([(code >> f) & 1 for f in range(n)]) for code in range(2**n))
    assert leaps > 0
    assert cost(chosen) == pytest.approx(cheapest, abs=1e-9)


def test_the_kernels_agree_with_plain_numpy(rng):
    axes, rest, long_axis = draw(rng)
    rotations = Rotation.random(6, rng=rng).as_matrix()
    known = np.ones(6, dtype=bool)
    solved = solve_angles(
        rotations,
        axes,
        rest,
        long_axis,
        known,
        AngleSettings(branch="default-sign"),
        TwistSettings(),
    )
    a1, a2 = axes
    k, n, r = a1 @ a2, np.cross(a1, a2), rest @ long_axis
    psi, phi = np.arccos(k), np.arccos(a1 @ r)
    low, high = abs(psi - phi), min(psi + phi, 2 * np.pi - psi - phi)
    for i, q in enumerate(rotations):
        p = q @ long_axis
        h = np.clip(a2 @ p, np.cos(high), np.cos(low))
        alpha, beta = (a1 @ r - k * h) / (n @ n), (h - k * (a1 @ r)) / (n @ n)
        gamma = np.sqrt(max(0, (1 - alpha**2 - beta**2 - 2 * alpha * beta * k) / (n @ n)))
        x = alpha * a1 + beta * a2 + np.sign(r @ n) * gamma * n
        one = np.arctan2(a1 @ np.cross(r, x), r @ x - (a1 @ r) * (a1 @ x))
        two = np.arctan2(a2 @ np.cross(x, p), x @ p - (a2 @ x) * (a2 @ p))
        assert_allclose(solved.angles[i, :2], [one, two], atol=1e-6)  # arccos near the rim
