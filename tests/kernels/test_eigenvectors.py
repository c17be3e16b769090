"""Eigenvectors of matrices side by side against NumPy's, and one lane does not see another."""

import numpy as np
from numpy.testing import assert_allclose, assert_array_equal

from kinesphere.kernels.eigenvectors import LANES, diagonalize

ROUNDING = 1e-14


def diagonal(matrices):
    """Return eigenvalues, (n, 4), and eigenvectors, (n, 4, 4), of up to LANES matrices."""
    m, v = np.zeros((4, 4, LANES)), np.empty((4, 4, LANES))
    m[:, :, : len(matrices)] = np.moveaxis(matrices, 0, -1)
    diagonalize(m, v)
    lanes = np.arange(len(matrices))
    off = m * (1 - np.eye(4))[:, :, None]
    assert_allclose(off[:, :, lanes], 0.0, atol=ROUNDING)
    return m[range(4), range(4)][:, lanes].T, np.moveaxis(v, -1, 0)[lanes]


def symmetric(rng, n=LANES):
    matrices = rng.normal(size=(n, 4, 4))
    return matrices + np.swapaxes(matrices, 1, 2)


def test_values_are_numpys_and_vectors_belong_to_them(rng):
    matrices = symmetric(rng)
    values, vectors = diagonal(matrices)
    assert_allclose(np.sort(values), np.linalg.eigvalsh(matrices), atol=10 * ROUNDING)
    assert_allclose(matrices @ vectors, vectors * values[:, None], atol=10 * ROUNDING)
    assert_allclose(np.swapaxes(vectors, 1, 2) @ vectors, [np.eye(4)] * LANES, atol=ROUNDING)


def test_a_matrix_alone_is_what_it_is_beside_others(rng):
    matrices = symmetric(rng, 5)
    matrices[3] = np.diag([1.0, 2.0, 2.0, 0.0])
    values, vectors = diagonal(matrices)
    for k in range(5):
        alone = diagonal(matrices[k : k + 1])
        assert_array_equal(alone[0][0], values[k])
        assert_array_equal(alone[1][0], vectors[k])
    assert_array_equal(vectors[3], np.eye(4))


def test_double_and_tiny_values_keep_full_precision(rng):
    turn = np.linalg.qr(rng.normal(size=(4, 4)))[0]
    wanted = np.array([1.0, 1.0, 1e-9, -2.0])
    values, vectors = diagonal((turn * wanted @ turn.T)[None])
    assert_allclose(np.sort(values[0]), np.sort(wanted), atol=ROUNDING)
    assert_allclose(vectors[0] * values[0] @ vectors[0].T, turn * wanted @ turn.T, atol=ROUNDING)


def test_what_is_not_a_number_stays_in_its_lane(rng):
    matrices = symmetric(rng, 3)
    spoiled = matrices.copy()
    spoiled[1] = np.nan
    m, v = np.zeros((4, 4, LANES)), np.empty((4, 4, LANES))
    m[:, :, :3] = np.moveaxis(spoiled, 0, -1)
    diagonalize(m, v)
    _, vectors = diagonal(matrices)
    assert_array_equal(v[:, :, [0, 2]], np.moveaxis(vectors[[0, 2]], 0, -1))
