"""Sections of the benchmark on small cases whose answer is known."""

import json
import xml.etree.ElementTree as ET
from dataclasses import replace

import numpy as np
import pytest
from benchmarks.axes import __main__ as main
from benchmarks.axes import floor, free_motion, held, held_noise, segments
from benchmarks.axes.angles import run_cross_talk
from benchmarks.axes.estimators import run
from benchmarks.axes.generator import BAND, RATE
from benchmarks.axes.normalization import POSES, PROTOCOLS, RULES, Protocol, record, told
from benchmarks.axes.papers_metrics import joint_rows, measured_rows, pooled, with_random_axes
from benchmarks.axes.repeatability import (
    contradictions,
    functional,
    half_rows,
    mirror_difference,
)
from numpy.testing import assert_allclose

from kinesphere.geometry.rotations import rotation_angle
from kinesphere.normalization import normalize
from kinesphere.parameterization import parameterize
from kinesphere.synthetic import make_actor, make_performance

EXACT = 1e-6  # mm and deg


@pytest.fixture(scope="module")
def performance():
    return make_performance(np.random.default_rng(3), rate=20.0, free_s=5.0)


def test_true_parameters_rebuild_every_pose(performance):
    rows = measured_rows(performance.motion, performance.parameters)
    assert [row["joint"] for row in rows] == list(performance.skeleton.joint_names)
    for row in rows:
        assert row["frames"] == performance.motion.n_frames
        for key in ("position_mm", "sum_deg", "per_axis_deg", "geodesic_deg", "tracked_mm"):
            assert row[key] < EXACT


def test_random_axes_fit_two_axis_joints_but_no_hinges(performance):
    rows = joint_rows(performance.motion, performance.parameters)
    two, one = pooled(rows, 2), pooled(rows, 1)
    assert two["joints"] + one["joints"] == len(rows)
    assert two["position_mm"] < EXACT
    assert two["random_position_mm"] < 10  # mm, of axes that mean nothing
    assert one["random_position_mm"] > 10


def test_an_angle_that_is_wrong_shows_as_what_it_is(performance):
    motion, true = performance.motion, performance.parameters
    j = true.skeleton.joint_names.index("left_knee")
    axis, limb = true.skeleton.joints[j].axes[0], true.skeleton.limbs[j + 1]
    angles = true.angles.copy()
    angles[:, j, 0] += np.deg2rad(7.0)
    shifted = type(true)(**{**vars(true), "angles": angles})
    row = measured_rows(motion, shifted)[j]
    assert row["geodesic_deg"] == pytest.approx(7.0, abs=EXACT)
    across = np.sin(np.arccos((true.skeleton.joints[j].rest @ limb.long_axis) @ axis))
    chord = 1e3 * limb.length / 2 * across * 2 * np.sin(np.deg2rad(3.5))
    assert row["position_mm"] == pytest.approx(chord, rel=1e-3)
    assert row["tracked_mm"] == pytest.approx(chord, rel=1e-3)


def test_random_axes_keep_their_number(performance):
    skeleton = performance.skeleton
    other = with_random_axes(skeleton, np.random.default_rng(0))
    assert [j.n_axes for j in other.joints] == [j.n_axes for j in skeleton.joints]
    assert all((a.axes != b.axes).all() for a, b in zip(skeleton.joints, other.joints, strict=True))


def test_halves_of_the_same_movements_agree():
    """The calibration twice: what halves are said to differ by is what their axes differ by."""
    once = make_performance(np.random.default_rng(5), rate=12.0, free_s=0.0, sway_deg=0.0)
    first = once.motion
    twice = type(first)(
        **{
            **vars(first),
            **{
                name: np.concatenate([getattr(first, name)] * 2)
                for name in ("rotations", "origins", "residuals", "flags")
            },
        }
    )
    rows = half_rows(twice, parameterize(twice))
    knees = [row for row in rows if row["joint"].endswith("knee")]
    assert len(knees) == 2
    for row in knees:
        assert max(row["halves_deg"]) < 0.5
        assert row["held_out_mm"] < 1.0
        assert row["n_axes_by_data"] == 1


def row(joint, **more):
    plain = {
        "joint": joint,
        "source": "movement",
        "n_axes_by_data": 1,
        "doubts": [],
        "remark": None,
        "half_told": False,
        "sources": ["movement"],
        "axes": [[0.0, 0.0, -1.0]],
        "halves_deg": [1.0],
        "enough": True,
        "held_out_mm": 2.0,
        "own_mm": 1.0,
    }
    return {**plain, **more}


def test_contradictions_are_those_that_nobody_told():
    sources = {
        "a": [row("left_knee"), row("neck", halves_deg=[3.0, 40.0])],
        "b": [
            row("neck", halves_deg=[3.0, 40.0], doubts=["halves differ"]),
            row("lumbar", halves_deg=[50.0], source="body"),
            row("left_hip", halves_deg=None),
            row("left_ankle", halves_deg=[30.0], half_told=True, remark="halves differ"),
            row("right_ankle", halves_deg=[20.0], half_told=True, doubts=["of the other axis"]),
            row("right_hip", halves_deg=[70.0], enough=False),
        ],
    }
    found = contradictions(sources)
    assert found["contradicted"] == ["a neck (40°)", "b right_ankle (20°)"]
    assert len(found["given"]) == 7
    assert found["untested"] == ["b left_hip", "b right_hip"]


def test_each_functional_trial_tells_of_its_own_joint():
    tilt = np.deg2rad(12.0)
    sources = {
        "functional/Test_func_lknee.c3d": [row("left_knee"), row("right_knee")],
        "functional/Test_func_rknee.c3d": [
            row("left_knee"),
            row("right_knee", axes=[[np.sin(tilt), 0.0, -np.cos(tilt)]]),
        ],
        "functional/Test_func_lhip.c3d": [row("left_hip"), row("left_knee")],
    }
    rows = functional(sources)
    assert [r["joint"] for r in rows] == ["left_hip", "left_knee", "right_knee"]
    assert mirror_difference(rows) == pytest.approx(12.0)
    assert mirror_difference(rows[:2]) is None


def test_recordings_hold_the_actors_frames(rng):
    skeleton = make_actor(rng).skeleton
    motion, true, _ = record(rng, skeleton, PROTOCOLS["poses of all kinds"])
    turns = np.swapaxes(true, -1, -2) @ motion.rotations
    assert_allclose(turns, np.broadcast_to(turns[0], turns.shape), atol=1e-12)
    lines = motion.rotations @ np.array([x.long_axis for x in motion.skeleton.limbs])[..., None]
    truth = true @ np.array([x.long_axis for x in skeleton.limbs])[..., None]
    assert_allclose(lines, truth, atol=1e-12)


def test_the_default_frames_are_the_same_where_nothing_scatters(rng, monkeypatch):
    monkeypatch.setattr("benchmarks.axes.normalization.SCATTER", 0.0)
    skeleton = make_actor(rng).skeleton
    for rule, settings in RULES.items():
        frames = []
        for _ in range(2):
            motion, true, _ = record(rng, skeleton, Protocol("stands", 2, 0))
            normalized = normalize(motion, settings).rotations[0]
            frames.append(np.swapaxes(true[0], -1, -2) @ normalized)
        assert_allclose(frames[0], frames[1], atol=1e-7, err_msg=rule)


def test_the_oracle_averages_the_stances_and_nothing_else(rng):
    skeleton = make_actor(rng).skeleton
    motion, true, standing = record(rng, skeleton, PROTOCOLS["poses of all kinds"])
    assert standing.sum() == standing.size / 2
    frames = told(motion, true, standing)
    off = rotation_angle(frames)
    assert off[0] < 1e-9  # the root is the body
    assert 0.01 < off[1:].mean() < 0.2
    # other poses may be anything
    others = replace(
        motion, rotations=np.where(standing[:, None, None, None], motion.rotations, np.eye(3))
    )
    assert_allclose(
        motion.rotations[0].swapaxes(1, 2) @ true[0] @ frames,
        others.rotations[0].swapaxes(1, 2) @ true[0] @ told(others, true, standing),
        atol=1e-12,
    )


def test_poses_are_of_joints_that_the_actor_has(rng):
    names = set(make_actor(rng).skeleton.joint_names)
    assert all(set(pose) <= names for pose in POSES)


@pytest.mark.slow
def test_every_estimator_answers():
    errors = run("90°", "clean", 1000)
    assert errors["as delivered"] == pytest.approx(errors["phase-log-pca"], abs=0.3)
    assert max(errors["as delivered"]) < 1.0


@pytest.mark.slow
def test_free_motion_without_twist_and_noise_tells_its_axes():
    assert max(free_motion.run("20 s without twist", "clean", 3000)["universal-joint"]) < 0.1


def test_cross_talk_of_true_axes_is_the_noise():
    found = run_cross_talk(0)
    assert found["sway alone"] == pytest.approx(0.3, abs=0.15)
    assert found["true axes"] > 0.8  # about 1° of noise, more where axes are not square


def test_without_twist_and_noise_least_twist_is_the_truth():
    assert max(floor.run("20 s without twist", "clean", 3000)) < 1e-4
    twisted = floor.run("20 s, ±10° of twist", "clean", 3000)
    assert max(twisted) > 0.1  # chance twist pulls them away


def test_what_free_motion_holds_is_its_noise_over_its_rhythms():
    errors, bounds = held.run("20 s, ±10° of twist", 3000)
    assert 0.2 < min(bounds) <= max(bounds) < 1.5  # 1° of errors with 0.4 s of memory in 20 s
    assert max(errors) < 4 * max(bounds)


@pytest.mark.slow
def test_noise_holds_less_than_rhythms():
    motion = "60 s, ±10° of twist, no rhythm"
    errors, bounds = held_noise.run(motion, 3000)
    _, rhythmic = held.run("60 s, ±10° of twist", 3000)
    assert 2 * max(rhythmic) < min(bounds) <= max(bounds) < 3.0
    assert max(errors) < 3 * max(bounds)


def test_the_band_is_what_noise_is_drawn_from():
    joint = free_motion.make("60 s, ±10° of twist, no rhythm", "clean", 3000)
    own = held_noise._angles_covariance(joint)
    assert_allclose(own[:, 5, 5], joint.angles.var(axis=0))
    values = np.linalg.eigvalsh(own[0])
    inside = 2 * (BAND[1] - BAND[0]) * 60.0  # waves that a band holds in so long a time
    assert values[-round(inside) :].sum() > 0.97 * values.sum()


def test_motion_without_rhythm_keeps_its_band():
    joint = free_motion.make("60 s, ±10° of twist, no rhythm", "clean", 3000)
    power = np.abs(np.fft.rfft(joint.angles * np.hanning(len(joint.angles))[:, None], axis=0)) ** 2
    frequencies = np.fft.rfftfreq(len(joint.angles), 1 / RATE)
    inside = (frequencies > 0.12) & (frequencies < 0.73)  # Hz, what the window widens included
    assert (power[inside].sum(axis=0) > 0.95 * power[1:].sum(axis=0)).all()
    assert_allclose(np.rad2deg(np.abs(joint.angles).max(axis=0)), [45, 40, 10])


def test_figures_survive_the_file():
    found = {"angles": {"a": np.nan, "b": [1.23456789, 2]}, "skipped": {}}
    text = main._lines(main._short(found), depth=2)
    assert json.loads(text) == {"angles": {"a": None, "b": [1.2346, 2]}, "skipped": {}}
    assert len(text.splitlines()) == 7


@pytest.mark.real
def test_a_functional_trial_is_drawn_with_its_movements(recordings):
    task = next(t for t in segments.trials(recordings) if t[0] == "lknee")
    trial = segments.look_at(*task)
    row, svg = segments.row(trial), segments.picture(trial)
    assert (row["joint"], row["axes_from"], row["valley"]) == ("left_knee", "movement", True)
    assert row["movements"] == len(trial.view.movement.phases) == sum(row["about"])
    assert svg.count("<rect x=") == row["movements"]
    assert ET.fromstring(svg).tag.endswith("svg")
    assert f"| {row['movements']} |" in segments.page([row])
    assert segments.page([]) == ""
