"""Spoilers do what they say, no more, and leave their input alone."""

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal

from kinesphere.errors import BadRecording, BadSetting
from kinesphere.synthetic import (
    make_performance,
    spoil_with_gaps,
    spoil_with_ghosts,
    spoil_with_noise,
    spoil_with_soft_tissue,
    spoil_with_swaps,
    spoil_with_turned_camera,
    spoil_with_wrong_unit,
)

EXACT = 1e-12  # m; sums of numbers of a few metres


@pytest.fixture(scope="module")
def performance():
    return make_performance(np.random.default_rng(11), rate=50, calibration_s=20, free_s=20)


@pytest.fixture(scope="module")
def short():
    return make_performance(np.random.default_rng(12), rate=10, calibration_s=10, free_s=10)


@pytest.fixture(scope="module")
def recording(performance):
    return performance.recording


SPOILERS = {
    "noise": spoil_with_noise,
    "gaps": spoil_with_gaps,
    "swaps": spoil_with_swaps,
    "ghosts": spoil_with_ghosts,
    "turned camera": spoil_with_turned_camera,
}


@pytest.mark.parametrize("what", SPOILERS)
def test_each_is_remembered_repeatable_and_leaves_its_input(recording, what):
    before = recording.markers.copy()
    one, two = (SPOILERS[what](recording, np.random.default_rng(5)) for _ in range(2))
    assert_array_equal(one.markers, two.markers)
    assert_array_equal(recording.markers, before)
    assert one.history[:-1] == recording.history
    assert one.history[-1].name == f"spoil: {what}"
    other = SPOILERS[what](recording, np.random.default_rng(6))
    assert not np.array_equal(one.markers, other.markers, equal_nan=True)


def test_noise_is_white_and_of_the_size_asked_for(recording, rng):
    noise = spoil_with_noise(recording, rng, deviation=0.003).markers - recording.markers
    assert noise.std() == pytest.approx(0.003, rel=0.02)
    assert abs(noise.mean()) < 3e-5
    neighbours = np.corrcoef(noise[:-1].ravel(), noise[1:].ravel())[0, 1]
    assert abs(neighbours) < 0.01


def test_noise_keeps_gaps(recording, rng):
    gappy = spoil_with_gaps(recording, rng)
    assert_array_equal(spoil_with_noise(gappy, rng).seen, gappy.seen)


@pytest.mark.parametrize("share", [0.02, 0.3, 0.8])
def test_gaps_hide_their_share_in_runs_of_their_length(recording, rng, share):
    gappy = spoil_with_gaps(recording, rng, share=share, gap_s=0.4)
    hidden = ~gappy.seen
    n_runs = (np.diff(hidden.astype(int), axis=0) == 1).sum() + hidden[0].sum()
    assert hidden.mean() == pytest.approx(share, rel=0.25)
    assert hidden.sum() / n_runs / 50 == pytest.approx(0.4, rel=0.25)
    assert_array_equal(gappy.markers[gappy.seen], recording.markers[gappy.seen])


def test_no_share_no_gap(recording, rng):
    assert spoil_with_gaps(recording, rng, share=0).seen.all()


def test_swaps_exchange_labels_and_nothing_else(recording, rng):
    swapped = spoil_with_swaps(recording, rng, n_swaps=4, swap_s=0.5)
    assert swapped.labels == recording.labels
    order = np.lexsort(np.moveaxis(recording.markers, -1, 0))
    swapped_order = np.lexsort(np.moveaxis(swapped.markers, -1, 0))
    assert_array_equal(  # in every frame the same points
        np.take_along_axis(swapped.markers, swapped_order[..., None], axis=1),
        np.take_along_axis(recording.markers, order[..., None], axis=1),
    )
    told = np.zeros(recording.seen.shape, dtype=bool)
    for swap in swapped.history[-1].findings["swaps"]:
        frames = slice(round(swap["start_s"] * 50), round(swap["end_s"] * 50))
        told[frames, recording.columns(tuple(swap["markers"]))] = True
    changed = (swapped.markers != recording.markers).any(axis=2)
    assert changed.any()
    assert not (changed & ~told).any()


def test_a_swap_confuses_neighbours(recording, rng):
    swapped = spoil_with_swaps(recording, rng, n_swaps=1, swap_s=0.2)
    (swap,) = swapped.history[-1].findings["swaps"]
    frame = recording.markers[round(swap["start_s"] * 50)]
    one, other = recording.columns(tuple(swap["markers"]))
    distances = np.linalg.norm(frame - frame[one], axis=1)
    assert distances[other] == np.sort(distances)[1]


def test_ghosts_are_added_short_lived_and_unlabelled(recording, rng):
    haunted = spoil_with_ghosts(recording, rng, n_ghosts=7, ghost_s=0.3)
    n = recording.n_markers
    assert haunted.labels == (*recording.labels, *(f"*{k}" for k in range(7)))
    assert_array_equal(haunted.markers[:, :n], recording.markers)
    seen = haunted.seen[:, n:].sum(axis=0) / 50
    assert (seen > 0).all()
    assert seen.mean() < 1.0
    ghosts = haunted.markers[:, n:]
    assert np.nanmax(np.linalg.norm(np.diff(ghosts, axis=0), axis=2)) <= 1.0 / 50 + EXACT
    for g in range(7):
        first = np.flatnonzero(haunted.seen[:, n + g])[0]
        off = np.linalg.norm(recording.markers[first] - ghosts[first, g], axis=1)
        assert 0.001 < off.min() <= 0.3 + EXACT
    again = spoil_with_ghosts(haunted, rng, n_ghosts=1)
    assert again.labels[-1] == "*7"


def test_a_turned_camera_moves_all_rigidly(recording, rng):
    turned = spoil_with_turned_camera(recording, rng, claimed_up="-x")
    findings = turned.history[-1].findings
    turn, shift = np.array(findings["turn"]), np.array(findings["shift_m"])
    assert_allclose(turn @ turn.T, np.eye(3), atol=EXACT)
    assert np.linalg.det(turn) == pytest.approx(1)
    assert_allclose((turned.markers - shift) @ turn, recording.markers, atol=EXACT)
    assert np.abs(turn[:, 1]).max() == pytest.approx(1)  # up is an axis again
    assert turned.up == "-x"


def test_a_mirrored_export_is_left_handed(recording, rng):
    turned = spoil_with_turned_camera(recording, rng, mirrored=True)
    assert np.linalg.det(turned.history[-1].findings["turn"]) == pytest.approx(-1)


def test_a_wrong_unit_scales_everything(recording):
    assert_allclose(spoil_with_wrong_unit(recording).markers, 1000 * recording.markers)


def test_soft_tissue_follows_the_pose(performance, recording, rng):
    """Without wobble the slide in the limb's frame is a linear function of the angles."""
    spoiled = spoil_with_soft_tissue(recording, rng, performance, wobble=0)
    i = performance.skeleton.limb_names.index("left_shank")
    columns = recording.columns(performance.skeleton.limbs[i].markers)
    moved = (spoiled.markers - recording.markers)[:, columns]
    slide = np.swapaxes(performance.motion.rotations[:, i, None], -1, -2) @ moved[..., None]
    joints = [performance.skeleton.joint_names.index(f"left_{n}") for n in ("knee", "ankle")]
    angles = np.c_[
        performance.parameters.angles[:, joints].reshape(len(moved), -1),
        performance.parameters.twists[:, joints],
    ]
    angles = angles[:, np.isfinite(angles).all(axis=0)]
    flat = slide.reshape(len(moved), -1)
    fitted, *_ = np.linalg.lstsq(angles, flat, rcond=None)
    assert_allclose(angles @ fitted, flat, atol=EXACT)
    assert 0.001 < np.abs(flat).max() < 0.1


def test_soft_tissue_slides_most_near_a_joint(short):
    """Over many draws: near its joint by the rms asked for, elsewhere by what distance leaves."""
    performance, recording = short, short.recording
    limb = performance.skeleton.limb("head")
    j = performance.skeleton.joint_names.index("neck")
    joint = performance.skeleton.joints[j]
    parameters = performance.parameters
    angles = np.c_[parameters.angles[:, j, : joint.n_axes], parameters.twists[:, j]]
    columns = recording.columns(limb.markers)
    squares = np.zeros(len(columns))
    n_draws = 150
    for seed in range(n_draws):
        generator = np.random.default_rng(seed)
        spoiled = spoil_with_soft_tissue(
            recording, generator, performance, per_radian=0.01, reach=0.1, wobble=0, shared=0.3
        )
        moved = (spoiled.markers - recording.markers)[:, columns]
        squares += (moved**2).sum(axis=2).mean(axis=0) / n_draws
    distance = np.linalg.norm(limb.marker_positions - joint.centre_in_child, axis=1)
    expected = 0.01 * np.exp(-distance / 0.1) * np.sqrt((angles**2).sum(axis=1).mean())
    assert_allclose(np.sqrt(squares), expected, rtol=0.2)


def test_soft_tissue_wobbles_by_its_deviation_and_slowly(performance, recording, rng):
    spoiled = spoil_with_soft_tissue(
        recording, rng, performance, per_radian=0, wobble=0.004, time_constant=0.2, shared=0
    )
    moved = spoiled.markers - recording.markers
    assert moved.std() == pytest.approx(0.004, rel=0.05)
    assert moved[0].std() == pytest.approx(0.004, rel=0.25)  # from the first frame on
    lag = 10  # frames, one time constant
    product = (moved[lag:] * moved[:-lag]).mean() / moved.var()
    assert product == pytest.approx(np.exp(-1), abs=0.08)


def test_shared_soft_tissue_moves_the_whole_body(performance, recording, rng):
    spoiled = spoil_with_soft_tissue(recording, rng, performance, per_radian=0, shared=1)
    columns = recording.columns(performance.skeleton.limbs[0].markers)
    moved = (spoiled.markers - recording.markers)[:, columns]
    assert_allclose(moved, moved[:, :1].repeat(len(columns), axis=1), atol=EXACT)


def test_soft_tissue_needs_its_own_performance(performance, recording, rng):
    shorter = make_performance(rng, rate=50, calibration_s=5, free_s=0).recording
    with pytest.raises(BadRecording, match="250 frames, its performance 2000"):
        spoil_with_soft_tissue(shorter, rng, performance)


@pytest.mark.parametrize(
    ("spoiler", "wrong"),
    [
        (spoil_with_noise, {"deviation": -1.0}),
        (spoil_with_gaps, {"share": 1.0}),
        (spoil_with_gaps, {"gap_s": 0.0}),
        (spoil_with_swaps, {"n_swaps": -1}),
        (spoil_with_ghosts, {"ghost_s": float("nan")}),
    ],
)
def test_settings_out_of_range_are_refused(recording, rng, spoiler, wrong):
    with pytest.raises(BadSetting, match=next(iter(wrong))):
        spoiler(recording, rng, **wrong)
