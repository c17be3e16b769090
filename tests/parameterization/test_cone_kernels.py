"""The inner loops of the likeliest axis against plain ways to compute the same."""

import numpy as np
import pytest
from numpy.testing import assert_allclose
from scipy.spatial.transform import Rotation

from kinesphere.parameterization.axes.cone_and_twist import ConeAndTwist
from kinesphere.parameterization.axes.cone_kernels import centred, equations, weighted_median
from kinesphere.parameterization.samples import JointSamples

PHASES = ((0, 30), (40, 90))
ROUNDING = 1e-12
NORMAL = 1e12  # degrees of freedom, at which all frames count alike
TILT = 1e-6  # rad
DERIVATIVE = 1e-3  # of numerical derivatives


@pytest.mark.parametrize("n", [1, 2, 7, 8])
def test_a_weighted_median_is_that_of_repeated_values(rng, n):
    values, times = rng.normal(size=n), rng.integers(1, 5, size=n)
    found = weighted_median(values, times.astype(float))
    assert_allclose(found, np.median(np.repeat(values, times)), rtol=ROUNDING)


def test_a_weighted_median_takes_equal_values_together():
    assert weighted_median(np.array([2.0, 1.0, 2.0, 2.0]), np.array([1.0, 2.0, 0.5, 0.5])) == 1.5


def test_centred_values_have_no_mean_in_any_phase(rng):
    phase = np.repeat([0, 1, 2], [1, 4, 6])
    values, weights = rng.normal(size=11), rng.uniform(0.1, 2, size=11)
    found = centred(values, weights, phase)
    for k in range(3):
        mine = phase == k
        assert_allclose(np.average(found[mine], weights=weights[mine]), 0.0, atol=ROUNDING)
        assert_allclose(np.ptp(found[mine] - values[mine]), 0.0, atol=ROUNDING)


@pytest.mark.parametrize("one_cone", [True, False])
def test_columns_are_how_errors_change(rng, one_cone):
    rotations = Rotation.from_rotvec(0.5 * rng.normal(size=(90, 3))).as_matrix()
    limb = np.array([0.6, 0.0, -0.8])
    samples = JointSamples(rotations, rotations @ limb, PHASES, 50.0, limb)
    joint = ConeAndTwist.of(samples, PHASES, 1000)

    def told(axis, coupled=0.0):
        beside = joint.vectors_beside, joint.numbers_beside, joint.phase, joint.weights
        scaled = np.stack([joint.weights, joint.weights])
        basis, columns, errors, spreads, opening = equations(
            axis, *beside, scaled, 1.0, NORMAL, one_cone, coupled
        )
        units = np.repeat(spreads, len(joint.weights))
        moved = np.repeat([opening, 0.0], len(joint.weights))
        return basis, columns * units, errors * units + moved

    axis = np.array([0.0, 0.6, 0.8])
    basis, columns, errors = told(axis)
    assert_allclose(basis @ basis.T, np.eye(2), atol=ROUNDING)
    assert_allclose(basis @ axis, 0.0, atol=ROUNDING)
    for k in range(2):
        tilted = axis + TILT * basis[k]
        change = (told(tilted / np.linalg.norm(tilted))[2] - errors) / TILT
        assert_allclose(columns[k], change, atol=DERIVATIVE)
    assert_allclose(columns[3], (told(axis, 0.1)[2] - errors) / 0.1, atol=DERIVATIVE)
