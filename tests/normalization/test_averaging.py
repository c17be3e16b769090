"""The mean of rotations that outliers do not move."""

import numpy as np
from numpy.testing import assert_allclose
from scipy.optimize import minimize
from scipy.spatial.transform import Rotation

from kinesphere.geometry.rotations import nearest_rotation, rotation_angle
from kinesphere.normalization.averaging import robust_mean_rotations

EXACT = 1e-9


def around(rng, centre, n, sigma):
    return centre @ Rotation.from_rotvec(rng.normal(scale=sigma, size=(n, 3))).as_matrix()


def test_outliers_hardly_move_it(rng):
    centre = Rotation.random(rng=rng).as_matrix()
    good = around(rng, centre, 80, 0.02)
    bad = around(rng, Rotation.random(rng=rng).as_matrix(), 20, 0.02)
    mean = robust_mean_rotations(np.concatenate([good, bad])[:, None])[0]
    assert rotation_angle(centre.T @ mean) < 0.02
    chordal = Rotation.from_matrix(np.concatenate([good, bad])).mean().as_matrix()
    assert rotation_angle(centre.T @ chordal) > 0.1


def test_it_turns_with_its_rotations_from_both_sides(rng):
    rotations = around(rng, np.eye(3), 31, 0.4)[:, None]
    left, right = Rotation.random(2, rng=rng).as_matrix()
    mean = robust_mean_rotations(rotations)[0]
    assert_allclose(
        robust_mean_rotations(left @ rotations @ right)[0], left @ mean @ right, atol=EXACT
    )


def test_one_is_its_own_mean_and_gaps_are_left_out(rng):
    rotations = Rotation.random(10, rng=rng).as_matrix().reshape(5, 2, 3, 3)
    rotations[1:, 0] = np.nan
    means = robust_mean_rotations(rotations)
    assert_allclose(means[0], rotations[0, 0], atol=EXACT)
    assert_allclose(means[1], robust_mean_rotations(rotations[:, 1:])[0], atol=EXACT)
    assert np.isnan(robust_mean_rotations(rotations[1:])[0]).all()


def test_many_are_nearer_to_the_truth_than_one(rng):
    centre = Rotation.random(rng=rng).as_matrix()
    rotations = around(rng, centre, 400, np.deg2rad(5))
    assert rotation_angle(centre.T @ robust_mean_rotations(rotations[:, None])[0]) < np.deg2rad(1)


def test_of_normal_errors_hardly_anything_is_wasted(rng):
    """A plain mean is the best there is; a median would be 8 % worse (Oja 2010, section 6)."""
    centre = Rotation.random(rng=rng).as_matrix()
    columns = around(rng, centre, 12 * 4000, 0.05).reshape(12, 4000, 3, 3)
    plain = nearest_rotation(columns.sum(axis=0))
    errors = [
        np.sqrt((rotation_angle(centre.T @ means) ** 2).mean())
        for means in (robust_mean_rotations(columns), plain)
    ]
    assert errors[0] < 1.05 * errors[1]


def test_it_is_the_likeliest_centre_of_a_t_distribution_of_five_degrees(rng):
    """By minimizing what its docstring says, from the median on, without any iteration of ours."""
    rotations = around(rng, Rotation.random(rng=rng).as_matrix(), 15, 0.3)
    rotations[:2] = around(rng, rotations[5], 2, 0.8)
    chordal = Rotation.from_matrix(rotations).mean()

    def best(cost):
        def of(vector):
            apart = rotation_angle(
                (chordal * Rotation.from_rotvec(vector)).as_matrix().T @ rotations
            )
            return cost(apart)

        found = minimize(of, np.zeros(3), method="Nelder-Mead", options={"xatol": 1e-9, "fatol": 0})
        centre = (chordal * Rotation.from_rotvec(found.x)).as_matrix()
        return centre, rotation_angle(centre.T @ rotations)

    _, apart = best(np.sum)
    deviation = np.median(apart) / 1.538172  # of the length of a normal vector in space
    centre, _ = best(lambda d: np.log1p(d**2 / (5 * deviation**2)).sum())
    mean = robust_mean_rotations(rotations[:, None])[0]
    assert rotation_angle(centre.T @ mean) < 2e-4
