"""The line from end to end, and the settings of all its stages."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import settings as trials
from hypothesis import strategies as st
from numpy.testing import assert_array_equal

from kinesphere.errors import (
    AmbiguousFacing,
    BadModel,
    BadRecording,
    BadSetting,
    UnreadableFile,
)
from kinesphere.io import read
from kinesphere.pipeline import (
    STAGES,
    Settings,
    changes_from_text,
    merged,
    model_for,
    read_settings,
    settings_fields,
    settings_from,
    solve,
    stage_settings,
)
from kinesphere.pipeline.values import type_as_text, value_from
from kinesphere.report import rms
from kinesphere.synthetic import HAND, make_performance, together

EVERY = [
    (stage, f, annotation, value)
    for stage, part in stage_settings(Settings()).items()
    for f, annotation, value in settings_fields(part)
]
"""(stage, field, type, default) of every setting there is."""


def small(seed=1, **more):
    """Return an actor that calibrates in half a minute, at a rate that keeps tests quick."""
    return make_performance(
        np.random.default_rng(seed), rate=10.0, calibration_s=20.0, free_s=2.0, **more
    )


@pytest.fixture(scope="module")
def solved():
    """Return a performance, its solution, and the stages that were told of."""
    performance, told = small(), []
    solution = solve(
        performance.recording,
        performance.model,
        calibration=performance.calibration,
        progress=lambda *stage: told.append(stage),
    )
    return performance, solution, told


# --- the line ---


@pytest.mark.slow
def test_the_line_goes_through_every_stage_in_order(solved):
    performance, solution, told = solved
    assert told == [(name, i, len(STAGES)) for i, name in enumerate(STAGES)]
    assert list(solution.seconds) == list(STAGES)
    names = [step.name for step in solution.history]
    assert names == [*(step.name for step in performance.recording.history), *STAGES]
    assert solution.model_name == performance.model.name
    assert solution.motion.n_frames == performance.recording.n_frames
    assert solution.recording.up == "+y"


@pytest.mark.slow
def test_the_line_is_deterministic(solved):
    performance, solution, _ = solved
    again = solve(performance.recording, performance.model, calibration=performance.calibration)
    assert_array_equal(again.parameters.angles, solution.parameters.angles)
    assert_array_equal(again.motion.rotations, solution.motion.rotations)


@pytest.mark.slow
@pytest.mark.parametrize("whole", [True, False])
def test_another_recording_gives_axes_and_rest_positions(solved, whole):
    performance, solution, _ = solved
    again = solve(
        performance.recording,
        performance.model,
        calibration_from=solution if whole else solution.skeleton,
    )
    both = zip(again.skeleton.joints, solution.skeleton.joints, strict=True)
    measured = [pair for pair in both if pair[1].axes_source != "body"]
    assert len(measured) > len(solution.skeleton.joints) / 2
    for joint, before in measured:
        assert joint.axes_source == "reused"
        assert_array_equal(joint.axes, before.axes)
        assert_array_equal(joint.rest, before.rest)


@pytest.mark.slow
def test_settings_reach_their_stage():
    performance = small()
    changed = settings_from({"axes": {"on_doubt": "movement"}, "orientation": {"up": "+y"}})
    solution = solve(performance.recording, performance.model, settings=changed)
    by_name = {step.name: step.settings for step in solution.history}
    assert by_name["orientation"]["up"] == "+y"
    assert by_name["parameterization"]["axes.on_doubt"] == "movement"


@pytest.mark.slow
def test_one_of_two_people_is_solved():
    first, second = (small(seed=seed, layout="cmu41").recording for seed in (1, 2))
    both = replace(
        first,
        markers=np.concatenate([first.markers, second.markers], axis=1),
        labels=tuple(f"{who}:{label}" for who in "AB" for label in first.labels),
    )
    alone = solve(second)
    picked = solve(both, subject="B")
    assert_array_equal(picked.motion.origins, alone.motion.origins)
    with pytest.raises(BadRecording, match=r"A .*B"):
        solve(both)


def test_nothing_seen_is_refused():
    recording = small().recording
    blind = replace(recording, markers=np.full_like(recording.markers, np.nan))
    with pytest.raises(BadRecording, match="no marker position"):
        solve(blind)
    with pytest.raises(BadRecording, match="no marker position"):
        solve(replace(recording, markers=recording.markers[:0], outputs=()))


# --- the model ---


def test_the_layout_chooses_the_model():
    recording = small(layout="cmu41").recording
    assert model_for(recording, None, None).name == "cmu41"
    assert model_for(recording, "plugin-gait", None).name == "plugin-gait"


def test_a_model_that_is_given_is_taken():
    performance = small(layout="cmu41")
    assert model_for(performance.recording, performance.model, None) is performance.model


@pytest.fixture(scope="module")
def person():
    """Return a person whose labels no model knows."""
    return make_performance(np.random.default_rng(7), rate=25, calibration_s=40, free_s=10)


@pytest.mark.parametrize("name", [None, "none"])
def test_without_a_model_the_motion_tells_bodies_and_joints(person, name):
    solution = solve(person.recording, name, calibration=person.calibration)
    assert solution.model_name == "motion alone"
    assert set(solution.skeleton.limb_names) == set(person.skeleton.limb_names)
    assert set(solution.skeleton.joint_names) == set(person.skeleton.joint_names)
    step = next(step for step in solution.history if step.name == "discovery")
    assert "discovery" in solution.seconds
    assert any("no built-in model fits" in text for text in step.warnings) == (name is None)


def test_of_two_people_a_subject_is_solved_alone(person):
    both = together({"Anna": person, "Ben": person})
    away = np.array(both.markers)
    n = person.recording.n_markers
    away[:, n:] = away[::-1, n:] + [2.0, 0.0, 0.0]
    both = replace(both, markers=away)
    solution = solve(both, "none", subject="Ben")
    assert all(label.startswith("Ben:") for label in solution.recording.labels)
    with pytest.raises(BadRecording, match="subjects are Anna, Ben"):
        solve(both, "none", subject="Carl")


def test_what_has_no_front_faces_an_axis_of_the_world_and_says_so():
    performance = make_performance(
        np.random.default_rng(5), plan=HAND, rate=25, calibration_s=90, free_s=10
    )
    solution = solve(performance.recording, "none")
    assert len(solution.skeleton.limbs) == len(HAND.limbs)
    assert any("no front of its own" in text for text in solution.warnings)
    step = next(step for step in solution.history if step.name == "normalization")
    assert step.findings["facing"]["decided_by"].startswith("assumed (")  # not by any user
    with pytest.raises(AmbiguousFacing):
        solve(performance.recording, "none", facing="walking")


def test_hidden_markers_are_filled_where_that_is_asked_for(person):
    markers = np.array(person.recording.markers)
    markers[300:320, 0] = np.nan
    spoilt = replace(person.recording, markers=markers)
    settings = settings_from({"skeleton": {"fill_markers": "true"}})
    solution = solve(spoilt, person.model, settings=settings)
    assert solution.recording.seen.all()
    assert any(step.name == "filling" for step in solution.history)
    assert not solve(spoilt, person.model).recording.seen.all()


def test_an_unknown_model_is_named():
    with pytest.raises(BadModel, match="cmu41"):
        solve(small().recording, "cmu14")


# --- settings ---


@pytest.mark.parametrize(("stage", "field", "annotation", "value"), EVERY)
def test_every_setting_survives_being_written_as_text(stage, field, annotation, value):
    text = "none" if value is None else str(value).lower() if value is True else str(value)
    changed = settings_from(changes_from_text([f"{stage}.{field.name}={text}"]))
    assert changed == Settings()
    assert type_as_text(annotation) not in ("", str(annotation))


@pytest.mark.parametrize(
    ("stage", "field", "annotation", "value"), [e for e in EVERY if e[1].metadata["choices"]]
)
def test_every_choice_can_be_made_and_no_other(stage, field, annotation, value):
    for choice in field.metadata["choices"]:
        changed = settings_from({stage: {field.name: choice}})
        assert getattr(stage_settings(changed)[stage], field.name) == choice
    with pytest.raises(BadSetting, match=rf"{stage}\.{field.name} is .*known are"):
        settings_from({stage: {field.name: "no such choice"}})


def test_every_setting_says_what_it_does():
    assert len(EVERY) > 30
    assert [(stage, f.name) for stage, f, _, _ in EVERY if not f.metadata["doc"]] == []


def test_one_change_leaves_all_else_alone():
    changed = settings_from({"filter": {"window": 0.5}})
    assert stage_settings(changed)["filter"].window == 0.5
    for stage, part in stage_settings(changed).items():
        if stage != "filter":
            assert part == stage_settings(Settings())[stage]


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"axis": {"method": "pca"}}, r"no stage is called 'axis' \(did you mean axes\?\)"),
        ({"axes": {"metod": "pca"}}, r"no setting 'metod' \(did you mean method\?\); known are"),
        ({"zzz": {}}, "no stage is called 'zzz'; known are discovery, labelling, orientation"),
        ({"axes": "pca"}, "axes is a stage"),
        ({"axes": {"restarts": "2.5"}}, "axes.restarts is '2.5'; it must be a whole number"),
        ({"axes": {"restarts": 0}}, "axes.restarts is 0; it must be at least 1"),
        ({"axes": {"cell": "wide"}}, "axes.cell is 'wide'; it must be a number"),
        ({"axes": {"cell": True}}, "axes.cell is True; it must be a number"),
        ({"axes": {"cell": "nan"}}, "axes.cell is nan; it must be at least"),
        ({"axes": {"method": 3}}, "axes.method is 3; it must be a name"),
    ],
)
def test_a_setting_that_cannot_be_meant_is_named(changes, message):
    with pytest.raises(BadSetting, match=message):
        settings_from(changes)


@pytest.mark.parametrize("word", ["axes", "axes.method", "axes=3", ".method=3", "axes.=3", "=", ""])
def test_a_word_that_sets_nothing_is_refused(word):
    with pytest.raises(BadSetting, match=r"write STAGE\.KEY=VALUE"):
        changes_from_text([word])


def test_the_last_word_counts_and_words_win_over_the_file(tmp_path):
    file = tmp_path / "settings.toml"
    file.write_text("[axes]\ncell = 3\nrestarts = 7\n[filter]\nwindow = 0.3\n")
    words = changes_from_text(["axes.cell=4", "axes.cell = 6"])
    parts = stage_settings(settings_from(merged(read_settings(file), words)))
    assert (parts["axes"].cell, parts["axes"].restarts, parts["filter"].window) == (6.0, 7, 0.3)


@pytest.mark.parametrize("content", [b"[axes\n", b"\xff\xfe", b"axes.cell = \n"])
def test_a_settings_file_that_is_none_is_named(tmp_path, content):
    file = tmp_path / "settings.toml"
    file.write_bytes(content)
    with pytest.raises(UnreadableFile, match=r"settings\.toml: not a TOML file"):
        read_settings(file)


def test_a_settings_file_that_is_missing_is_named(tmp_path):
    with pytest.raises(UnreadableFile, match=r"none\.toml: cannot read"):
        read_settings(tmp_path / "none.toml")


@pytest.mark.parametrize(
    ("written", "annotation", "value"),
    [
        ("none", float | None, None),
        ("2.5", float | None, 2.5),
        ("yes", bool, True),
        ("Off", bool, False),
        ("1,2", tuple[float, float], (1.0, 2.0)),
        ([1, 2, 3], tuple[int, ...], (1, 2, 3)),
        (4, float, 4.0),
        (4.0, int, 4),
        ("x", str, "x"),
    ],
)
def test_values_take_the_type_of_their_setting(written, annotation, value):
    found = value_from(written, annotation, "stage.key")
    assert found == value
    assert type(found) is type(value)


@pytest.mark.parametrize(
    ("written", "annotation"),
    [
        ("maybe", bool),
        (1, bool),
        (True, int),
        ("1e999", int),
        ("1,2,3", tuple[float, float]),
        ({}, float),
        ("x", float | None),
    ],
)
def test_values_of_another_type_are_refused(written, annotation):
    with pytest.raises(BadSetting, match=r"stage\.key is .*; it must"):
        value_from(written, annotation, "stage.key")


@given(number=st.floats(allow_nan=False, allow_infinity=False))
@trials(deadline=None, max_examples=50)
def test_numbers_survive_being_written_as_text(number):
    assert value_from(repr(number), float, "stage.key") == number


# --- real recordings ---

FULL_BODY = [
    "cmu41/06_01.c3d",
    "cmu41/02_05.c3d",
    "cmu41/85_02.c3d",
    "cmu41/135_02.c3d",
    "plugin-gait/PiG_Calibration-FlatFoot-Full.c3d",
    "plugin-gait/PiG_Motion-FlatFoot-Full.c3d",
    "plugin-gait/pycgm_static.c3d",
    "plugin-gait/pycgm_movement.c3d",
    "functional/anatomical_posture.c3d",
    "functional/Test_func_lhip.c3d",
    "functional/Test_func_lknee.c3d",
    "functional/Test_func_trunk.c3d",
]
RIGID = 0.02  # m; trunks bend, everything else is far better
SIDES = 0.08  # of the mean length of the two sides
FLEXED = np.deg2rad(40)  # beyond it a knee or an elbow shows which way it bends


def flexion(solution, parent, child):
    """Return how a limb hangs from its parent where the joint is flexed, (n, 3) in the parent."""
    motion, names = solution.motion, solution.skeleton.limb_names
    above, below = names.index(parent), names.index(child)
    limbs = solution.skeleton.limbs
    lower = motion.rotations[:, below] @ limbs[below].long_axis
    lower = np.einsum("fji,fj->fi", motion.rotations[:, above], lower)
    off = np.arccos(np.clip(lower @ limbs[above].long_axis, -1, 1))
    return lower[off > FLEXED]


@pytest.mark.real
@pytest.mark.slow
@pytest.mark.parametrize("file", FULL_BODY)
def test_real_recordings_are_solved_and_bend_as_people_do(file, recordings):
    solution = solve(read(recordings / file))
    motion = solution.motion
    assert solution.model_name == ("cmu41" if file.startswith("cmu41") else "plugin-gait")
    assert rms(motion.residuals) < RIGID
    assert motion.seen.mean() > 0.95
    for side in ("left", "right"):
        knee = flexion(solution, f"{side}_thigh", f"{side}_shank")
        elbow = flexion(solution, f"{side}_upper_arm", f"{side}_forearm")
        assert (knee[:, 0] < 0).mean() > 0.9 if len(knee) else True, "shanks swing backward"
        assert (elbow[:, 0] > 0).mean() > 0.9 if len(elbow) else True, "forearms swing forward"


@pytest.mark.real
@pytest.mark.slow
@pytest.mark.parametrize("file", ["cmu41/85_02.c3d", "cmu41/135_02.c3d"])
def test_left_and_right_are_of_one_length(file, recordings):
    skeleton = solve(read(recordings / file)).skeleton
    for limb in ("upper_arm", "forearm", "thigh", "shank", "foot"):
        left, right = (skeleton.limb(f"{side}_{limb}").length for side in ("left", "right"))
        assert abs(left - right) < SIDES * (left + right) / 2, limb
