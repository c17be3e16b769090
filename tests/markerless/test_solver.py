"""One step: equations, expectations, limits."""

import numpy as np
import pytest
from numpy.testing import assert_allclose

from kinesphere.markerless.pose import bind_pose, difference, moved
from kinesphere.markerless.prediction import expectation, predicted, rest
from kinesphere.markerless.settings import TrackSettings
from kinesphere.markerless.solver import STEP, Normals, Prior, solve_step


def test_equations_of_a_known_step_give_it(whole, rng):
    chain = whole.chain
    n = chain.n_dofs
    wanted = rng.normal(scale=0.02, size=n)
    low, high = chain.limits
    wanted = np.clip(wanted, low / 2, high / 2)
    equations = Normals.empty(n)
    rows = rng.normal(size=(3 * n, n))
    equations.add(rows, rows @ wanted, rng.uniform(0.5, 2, 3 * n))
    pose, size = solve_step(chain, bind_pose(chain), equations, (), 0.0)
    assert_allclose(difference(chain, bind_pose(chain), pose), wanted, atol=1e-6)
    assert size == pytest.approx(np.abs(wanted).max(), abs=1e-6)


def test_with_no_image_the_expectation_decides(whole, rng):
    chain = whole.chain
    there = moved(chain, bind_pose(chain), rng.uniform(-0.05, 0.05, chain.n_dofs))
    prior = Prior(there, np.full(chain.n_dofs, 0.2))
    pose, _ = solve_step(chain, bind_pose(chain), Normals.empty(chain.n_dofs), (prior,), 1e-3)
    assert_allclose(difference(chain, pose, there), 0, atol=1e-3)


def test_with_nothing_at_all_it_stays(whole):
    chain = whole.chain
    pose, size = solve_step(chain, bind_pose(chain), Normals.empty(chain.n_dofs), (), 1e-3)
    assert size == 0
    assert_allclose(difference(chain, bind_pose(chain), pose), 0, atol=1e-15)


def test_no_step_is_longer_than_allowed(whole):
    chain = whole.chain
    equations = Normals.empty(chain.n_dofs)
    equations.add(np.eye(chain.n_dofs), np.full(chain.n_dofs, 3.0), np.ones(chain.n_dofs))
    _, size = solve_step(chain, bind_pose(chain), equations, (), 0.0)
    assert size == pytest.approx(STEP)


def test_a_joint_at_its_limit_is_held_and_the_others_make_up_for_it(whole):
    chain = whole.chain
    names = list(whole.parameter_names)
    knee, hip = names.index("left_shank.angle1"), names.index("left_thigh.turn3")
    low = chain.limits[0][knee]
    start = bind_pose(chain)
    start.angles[knee] = low
    row = np.zeros((1, chain.n_dofs))
    row[0, [knee, hip]] = 1.0
    equations = Normals.empty(chain.n_dofs)
    equations.add(row, np.array([-0.1]), np.ones(1))
    pose, _ = solve_step(chain, start, equations, (), 1e-6)
    assert pose.angles[knee] == pytest.approx(low)
    assert difference(chain, start, pose)[hip] == pytest.approx(-0.1, abs=1e-3)


def test_prediction_goes_on_by_a_share_of_the_last_step(whole, rng):
    chain = whole.chain
    before = bind_pose(chain)
    step = rng.uniform(-0.05, 0.05, chain.n_dofs)
    last = moved(chain, before, step)
    assert predicted(chain, None, last, 0.8) is last
    ahead = predicted(chain, before, last, 0.5)
    hinges = chain.dof_kinds == 2
    assert_allclose(difference(chain, last, ahead)[hinges], 0.5 * step[hinges], atol=1e-12)


def test_rest_says_nothing_of_the_root(whole):
    chain, settings = whole.chain, TrackSettings()
    prior = rest(chain, settings, bind_pose(chain))
    assert np.isinf(prior.spread[:6]).all()
    assert np.isfinite(prior.spread[6:]).all()
    wide = expectation(chain, bind_pose(chain), settings, widen=2.0).spread
    assert_allclose(wide, 2 * expectation(chain, bind_pose(chain), settings).spread)
