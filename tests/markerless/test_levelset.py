"""Level sets on pictures whose regions are known."""

import cv2
import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal

from kinesphere.markerless.kernels.evolution import band_runs_kernel, evolve_kernel
from kinesphere.markerless.kernels.levelset import (
    contour_kernel,
    ratios_kernel,
    recount_kernel,
    region_counts_kernel,
)
from kinesphere.markerless.kernels.votes import match_kernel, vote_kernel
from kinesphere.markerless.levelset import (
    features_of,
    from_mask,
    mask_of,
    near_distance,
    segment,
    signed_distance,
)
from kinesphere.markerless.settings import TrackSettings

pytestmark = pytest.mark.slow  # in plain Python

H, W = 120, 150


def disc(x, y, r):
    row, col = np.mgrid[:H, :W]
    return (col - x) ** 2 + (row - y) ** 2 < r * r


def picture(mask, rng, inside=(150, 80, 70), outside=(90, 110, 120), noise=12):
    image = np.where(mask[..., None], inside, outside) + rng.normal(scale=noise, size=(H, W, 3))
    return np.clip(image, 0, 255).astype(np.uint8)


def overlap(a, b):
    return (a & b).sum() / (a | b).sum()


@pytest.mark.parametrize("features", ["grey", "colour", "texture"])
def test_a_disc_is_found_from_another_beside_it(rng, features):
    truth, start = disc(75, 60, 25), disc(82, 55, 22)
    settings = TrackSettings(method="level-set", features=features, rounds=8)
    image = picture(truth, rng, inside=(190, 120, 110), outside=(70, 100, 110))
    found = segment(image, start, settings)
    assert overlap(start, truth) < 0.7
    assert overlap(mask_of(found, truth), truth) > 0.95


def test_regions_that_look_alike_move_nothing(rng):
    start = disc(75, 60, 25)
    image = picture(start, rng, inside=(100, 100, 100), outside=(100, 100, 100), noise=3)
    settings = TrackSettings(method="level-set", length=0.0)
    assert overlap(mask_of(segment(image, start, settings), start), start) > 0.9


def test_the_shape_term_holds_a_contour_that_the_image_pulls_away(rng):
    person, distraction = disc(60, 60, 25), disc(95, 60, 20)
    image = picture(person | distraction, rng)
    free = mask_of(segment(image, person, TrackSettings(method="level-set", rounds=10)), person)
    held = mask_of(
        segment(image, person, TrackSettings(method="coupled", rounds=10), shape=0.3), person
    )
    assert overlap(held, person) > overlap(free, person) + 0.05


def test_given_ratios_stand_in_for_estimated_densities(rng):
    truth, start = disc(75, 60, 25), disc(82, 55, 22)
    misleading = picture(start, rng)  # the image itself would hold the contour where it is
    ratios = np.where(truth, 3.0, -3.0).astype(np.float32)
    settings = TrackSettings(method="coupled", rounds=8)
    found = segment(misleading, start, settings, known=ratios)
    assert overlap(mask_of(found, truth), truth) > 0.97
    assert overlap(mask_of(segment(misleading, start, settings), truth), start) > 0.9


def test_a_coarse_contour_goes_farther_in_as_many_steps(rng):
    truth, start = disc(70, 60, 40), disc(70, 60, 15)
    ratios = np.where(truth, 3.0, -3.0).astype(np.float32)
    settings = TrackSettings(method="coupled")
    image = picture(truth, rng)
    reached = [
        overlap(mask_of(segment(image, start, settings, known=ratios, scale=s), truth), truth)
        for s in (1, 2, 4)
    ]
    assert reached[0] < 0.4
    assert reached[1] > reached[0] + 0.05
    assert reached[2] > reached[1] + 0.2


def test_ratios_are_the_sum_over_features_within_the_band(rng):
    features = rng.integers(0, 256, (20, 30, 3)).astype(np.uint8)
    phi = rng.uniform(-16, 16, (20, 30)).astype(np.float32)
    table = rng.normal(size=(3, 256))
    force = np.full((20, 30), 7.0, dtype=np.float32)
    ratios_kernel(features, band_runs_kernel(phi, 8.0), table, force)
    wanted = sum(table[k][features[..., k]] for k in range(3))
    band = np.zeros((20, 30), dtype=bool)
    band[1:-1, 1:-1] = np.abs(phi[1:-1, 1:-1]) < 8
    assert_allclose(force, np.where(band, wanted, 7.0), rtol=1e-6)


def test_counts_brought_up_to_date_are_counts_made_anew(rng):
    features = rng.integers(0, 256, (20, 30, 3)).astype(np.uint8)
    phi = rng.uniform(-16, 16, (20, 30)).astype(np.float32)
    runs, inside, counts = band_runs_kernel(phi, 8.0), phi > 0, np.empty((2, 3, 256))
    region_counts_kernel(features, inside, counts)
    for row, first, end in runs:
        phi[row, first:end] *= rng.choice([-1, 1], end - first)
    anew = np.empty_like(counts)
    region_counts_kernel(features, phi > 0, anew)
    assert not np.array_equal(counts, anew)
    recount_kernel(features, phi, runs, inside, counts)
    assert_array_equal(counts, anew)
    assert_array_equal(inside, phi > 0)


def test_a_step_is_the_equation_in_the_band_and_nothing_beyond():
    # a naive twin in double precision: equation 4 as the energy's own derivative
    mask = disc(75, 60, 25)
    prior, phi = (
        signed_distance(disc(70, 62, 25).astype(np.uint8)),
        signed_distance(mask * np.uint8(1)),
    )
    row, col = np.mgrid[:H, :W]
    force = (8 * np.sin(row / 5) * np.cos(col / 7)).astype(np.float32)
    wanted = phi.astype(float)
    for _ in range(2):
        py, px = np.gradient(wanted)
        pyy, pxx = (np.roll(wanted, 1, a) + np.roll(wanted, -1, a) - 2 * wanted for a in (0, 1))
        pxy = np.gradient(py, axis=1)
        slope = px**2 + py**2 + 1e-6
        bend = np.clip((pxx * py**2 - 2 * px * py * pxy + pyy * px**2) / slope**1.5, -1, 1)
        delta = np.exp(-0.5 * (wanted / 2) ** 2) / (2 * np.sqrt(2 * np.pi))
        drive = delta * (np.clip(force, -6, 6) + 1.5 * bend) + 2 * 0.03 * (prior - wanted)
        wanted = wanted + np.where(np.abs(phi) < 8, 0.7 * drive, 0)
    moved = phi.copy()
    evolve_kernel(moved, band_runs_kernel(phi, 8.0), force, 1.5, 0.03, prior, False, 2.0, 0.7, 2)
    assert np.abs(moved - phi).max() > 0.5
    assert_allclose(moved, wanted, atol=2e-5)


def test_length_shortens_a_contour_where_nothing_else_acts():
    mask = disc(75, 60, 25)
    mask[58:62, 95:125] = True  # a thorn
    phi = signed_distance(mask.astype(np.uint8))
    flat = np.zeros((H, W), dtype=np.float32)
    args = (4.0, 0.0, phi.copy(), False, 2.0, 0.7, 150)
    before = (phi > 0)[:, 100:].sum()
    evolve_kernel(phi, band_runs_kernel(phi, 8.0), flat, *args)
    assert (phi > 0)[:, 100:].sum() < 0.5 * before
    assert (phi > 0).sum() > 0.8 * disc(75, 60, 25).sum()


def test_signed_distance_is_a_distance():
    phi = signed_distance(disc(75, 60, 25).astype(np.uint8))
    row, col = np.mgrid[:H, :W]
    exact = np.clip(25 - np.hypot(col - 75, row - 60), -60, 60)
    assert np.abs(phi - exact).max() < 1.2  # px; pixels are squares


@pytest.mark.parametrize("reach", [3, 10, 40])
def test_near_the_edge_it_is_the_same_distance(rng, reach):
    speckled = rng.uniform(size=(H, W)) < 0.02
    rest = np.zeros((H, W), dtype=bool)
    for mask in (disc(75, 60, 25), disc(5, 3, 12), speckled, ~speckled, rest, ~rest):
        whole = signed_distance(mask.astype(np.uint8))
        near = near_distance(mask, reach)
        close = np.abs(whole) < reach - 0.5
        assert_allclose(near[close], whole[close], atol=1e-5)
        assert_array_equal(near[~close], np.where(mask, reach, -reach)[~close])


def test_no_model_in_the_image_is_no_silhouette(rng):
    nobody = np.zeros((H, W), dtype=bool)
    assert segment(picture(nobody, rng), nobody, TrackSettings()) is None


def test_contour_points_lie_on_the_circle_and_normals_point_outward():
    mask = cv2.circle(np.zeros((H, W), np.uint8), (75, 60), 25, 255, -1)
    phi = from_mask(mask).phi
    taken = np.zeros((H // 3 + 1, W // 3 + 1), dtype=bool)
    points, normals = np.empty((taken.size, 2)), np.empty((taken.size, 2))
    n = contour_kernel(phi, 3, points, normals, taken)
    out = points[:n] - [75, 60]
    radius = np.linalg.norm(out, axis=1)
    assert 40 < n < 120
    assert np.abs(radius - 25.3).max() < 1.0
    assert ((out / radius[:, None] * normals[:n]).sum(axis=1) > 0.95).all()


def test_votes_go_to_the_limb_of_the_many_near_rim_points():
    rim = np.array([[10.0, 1.0], [10, 2], [10, 3], [13, 2.2]])
    limbs = np.array([0, 0, 0, 1], dtype=np.int32)
    normals = np.tile([1.0, 0.0], (4, 1))
    points = np.array([[11.0, 2.0], [11.0, 2.0], [40.0, 2.0]])
    looks = np.array([[1.0, 0.0], [-1.0, 0.0], [1.0, 0.0]])
    match, far = np.empty(3, dtype=np.int32), np.empty(3)
    back, far_back = np.empty(4, dtype=np.int32), np.empty(4)
    vote_kernel(points, looks, rim, normals, limbs, 8.0, 0.5, match, back, far, far_back)
    assert match.tolist() == [1, -1, -1]  # the nearest of limb 0; looks away; too far
    assert far[0] == pytest.approx(1.0)
    assert np.isnan(far[1:]).all()
    assert back.tolist() == [0, 0, 0, 0]
    assert_allclose(far_back, np.hypot(*(rim - points[0]).T))


def test_votes_both_ways_are_those_of_a_naive_twin(rng):
    n, m, radius = 60, 40, 9.0
    points, rim = rng.uniform(0, 60, (n, 2)), rng.uniform(0, 60, (m, 2))
    normals, looks = (
        np.stack([np.cos(a), np.sin(a)], 1) for a in rng.uniform(0, 6.3, (2, max(n, m)))
    )
    normals, looks = normals[:n], looks[:m]
    limbs = rng.integers(0, 3, m).astype(np.int32)
    match, far = np.empty(n, dtype=np.int32), np.empty(n)
    back, far_back = np.empty(m, dtype=np.int32), np.empty(m)
    vote_kernel(points, normals, rim, looks, limbs, radius, 0.5, match, back, far, far_back)
    apart = np.linalg.norm(points[:, None] - rim, axis=2)
    fits = (apart <= radius) & (normals @ looks.T >= 0.5)
    nearest = np.where(fits, apart, np.inf)
    votes = np.where(fits, 1 / (1 + (apart / (0.25 * radius)) ** 2) ** 2, 0)
    for i in range(n):
        chosen = np.argmax([votes[i, limbs == k].sum() for k in range(3)])
        wanted = np.where(limbs == chosen, nearest[i], np.inf)
        assert match[i] == (wanted.argmin() if fits[i].any() else -1)
    assert 10 < (match >= 0).sum() < n
    assert_array_equal(back, np.where(fits.any(axis=0), nearest.argmin(axis=0), -1))
    assert_allclose(far_back[back >= 0], nearest.min(axis=0)[back >= 0])


def test_pairs_far_apart_are_left_out():
    rim = np.array([[10.0, 10], [10, 20], [10, 30]])
    normals, limbs = np.tile([1.0, 0], (3, 1)), np.array([0, 1, 2], dtype=np.int32)
    points = rim + np.array([[0.5, 0], [1, 0], [8, 0]])
    which, target = match_kernel(points, normals, rim, normals, limbs, 9.0, 0.5, 3.0)
    assert which.tolist() == target.tolist() == [0, 1, 0, 1]
    nowhere = np.empty((0, 2))
    which, _ = match_kernel(points, normals, nowhere, nowhere, limbs[:0], 9.0, 0.5, 3.0)
    assert len(which) == 0


def test_features_have_the_channels_their_name_says(rng):
    image = picture(disc(75, 60, 25), rng)
    counts = {kind: features_of(image, kind).shape[2] for kind in ("grey", "colour", "texture")}
    assert counts == {"grey": 1, "colour": 3, "texture": 4}
    flat = np.full((H, W, 3), 90, np.uint8)
    assert_allclose(features_of(flat, "texture")[..., 3], 0, atol=1)
