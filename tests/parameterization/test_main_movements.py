"""Main movements: told from free motion, cut where one runs into the next."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from kinesphere.parameterization.main_movements import best_cut, long_phases, main_movements
from kinesphere.parameterization.samples import JointSamples
from kinesphere.parameterization.settings import AxesSettings

RATE = 50.0


def about(vectors):
    return Rotation.from_rotvec(vectors)


def samples(rotations, phases):
    long_axis = np.array([0.0, 0.0, 1.0])
    matrices = rotations.as_matrix()
    return JointSamples(matrices, matrices @ long_axis, phases, RATE, long_axis)


def swing(n, degrees):
    return np.deg2rad(degrees) * np.sin(np.linspace(0, 2 * np.pi, n))


def one_after_the_other(twist=0.0):
    """Two seconds about x, then three about y, and all the while some rad of twist."""
    first = np.outer(swing(100, 40), [1.0, 0, 0])
    then = np.outer(swing(150, 40), [0, 1.0, 0])
    turns = twist * np.sin(np.linspace(0, 31, 250))[:, None] * [0, 0, 1.0]
    return about(np.concatenate([first, then])) * about(turns)


@pytest.mark.parametrize("twist", [0.0, 0.9])
def test_the_cut_is_where_the_axis_changes(twist):
    assert best_cut(samples(one_after_the_other(twist), ((0, 250),)), (0, 250)) == pytest.approx(
        100, abs=5
    )


def test_a_short_phase_is_not_cut():
    assert best_cut(samples(one_after_the_other(), ((60, 135),)), (60, 135)) is None


def test_two_movements_without_a_rest_are_two():
    found, *_ = main_movements(samples(one_after_the_other(), ((0, 250),)), AxesSettings())
    (a, cut), (same, b) = found
    assert (a, b) == (0, 250)
    assert cut == same == pytest.approx(100, abs=5)


def test_free_motion_comes_after_what_is_pure():
    t = np.linspace(0, 10, 500)
    free = np.stack([0.7 * np.sin(2.1 * t), 0.7 * np.sin(3.4 * t + 1), 0 * t], axis=1)
    both = Rotation.concatenate([one_after_the_other(), about(free)])
    phases = ((0, 100), (100, 250), (250, 750))
    sets = list(main_movements(samples(both, phases), AxesSettings()))
    assert sets[0] == phases[:2]
    assert sets[-1] == phases


def test_a_small_movement_is_no_main_movement():
    small = samples(about(np.outer(swing(100, 4), [1.0, 0, 0])), ((0, 100),))
    assert next(iter(main_movements(small, AxesSettings()))) == ()
    assert next(iter(main_movements(small, AxesSettings(smallest_range=5.0)))) == ((0, 100),)


def test_long_movements_are_told_from_short_ones():
    edges = ((0, 49), (60, 160), (160, 260))
    found = long_phases(samples(one_after_the_other(), edges))
    assert found == tuple((a, b) for a, b in edges if b - a >= 2 * RATE)
    assert 0 < len(found) < 3
