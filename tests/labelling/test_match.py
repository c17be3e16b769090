"""Labels brought to a model: spelling, subjects, people; what is refused and why."""

from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_array_equal

from kinesphere.data import Recording, Segment, TopologicalModel
from kinesphere.errors import BadRecording
from kinesphere.labelling import (
    built_in_model,
    choose_model,
    coverage,
    find_subjects,
    match_labels,
)

FRAMES = 5
CMU = built_in_model("cmu41")
GAIT = built_in_model("plugin-gait")


def recording_of(rng, labels):
    """Return a recording whose markers are anywhere: matching looks at labels only."""
    markers = rng.normal(size=(FRAMES, len(labels), 3))
    return Recording(markers=markers, labels=tuple(labels), rate=100.0)


def prefixed(subject, labels, joint=":"):
    return tuple(f"{subject}{joint}{label}" for label in labels)


def findings(recording):
    return recording.history[-1].findings


def marker(recording, label):
    return recording.markers[:, recording.labels.index(label)]


@pytest.mark.parametrize("joint", [":", "_"])
def test_a_prefix_goes_and_the_markers_stay(rng, joint):
    file = recording_of(rng, prefixed("Justin", CMU.labels, joint))
    assert find_subjects(file) == ("Justin",)
    matched = match_labels(file, CMU)
    assert matched.labels == CMU.labels
    assert_array_equal(matched.markers, file.markers)
    assert findings(matched)["subject"] == "Justin"
    assert findings(matched)["required_found"] == 41
    assert matched.history[-1].warnings == ()


def test_everything_before_the_last_colon_is_the_subject(rng):
    file = recording_of(rng, prefixed("Lab 2:Anna B", CMU.labels))
    assert find_subjects(file) == ("Lab 2:Anna B",)
    assert match_labels(file, CMU).labels == CMU.labels


def test_a_subjects_own_name_may_hold_underscores(rng):
    file = recording_of(rng, prefixed("Anna_B", CMU.labels, "_"))
    assert find_subjects(file) == ("Anna_B",)
    assert match_labels(file, CMU).labels == CMU.labels


@pytest.mark.parametrize("label", ["L_IAS", "Knee_Marker1", "R_LTOE"])
def test_an_underscore_alone_is_no_prefix(rng, label):
    file = recording_of(rng, (*CMU.labels, label))
    assert find_subjects(file) == ()
    assert label in match_labels(file, CMU).labels


def test_an_underscore_ends_a_prefix_in_a_learnt_model_as_well(rng):
    labels = tuple(f"site_{i}" for i in range(12))
    model = TopologicalModel("mine", (Segment("limb_01", labels),), (), "limb_01")
    matched = match_labels(recording_of(rng, prefixed("Anna", labels, "_")), model)
    assert matched.labels == labels
    assert findings(match_labels(recording_of(rng, labels), model))["subject"] == ""


@pytest.mark.parametrize(("n", "subjects"), [(9, ()), (10, ("Anna",))])
def test_few_labels_with_an_underscore_may_be_chance(rng, n, subjects):
    assert find_subjects(recording_of(rng, prefixed("Anna", CMU.labels[:n], "_"))) == subjects


def test_a_known_word_is_never_split(rng):
    """A model learnt from labels that were never stripped."""
    labels = prefixed("Rig", CMU.labels, "_")
    model = TopologicalModel("mine", (Segment("limb_01", labels),), (), "limb_01")
    assert match_labels(recording_of(rng, labels), model).labels == labels


def test_no_prefix_no_subject(rng):
    file = recording_of(rng, GAIT.required)
    assert find_subjects(file) == ()
    assert findings(match_labels(file, GAIT))["subject"] == ""


def test_case_and_aliases_are_brought_to_the_model(rng):
    spelled = {"LFHD": "LfHd", "RBAC": "RBAK", "LHEE": "Lheel"}
    file = recording_of(rng, [spelled.get(label, label) for label in CMU.labels])
    matched = match_labels(file, CMU)
    assert matched.labels == CMU.labels
    assert findings(matched)["respelled"] == {v: k for k, v in spelled.items()}


def test_an_exact_label_beats_its_alias(rng):
    file = recording_of(rng, ("RBAK", *CMU.labels))
    matched = match_labels(file, CMU)
    assert_array_equal(marker(matched, "RBAC"), marker(file, "RBAC"))
    assert_array_equal(marker(matched, "RBAK"), marker(file, "RBAK"))
    assert findings(matched)["extra"] == ["RBAK"]


def test_a_label_beats_the_alias_it_is_in_another_model(rng):
    """LMT5 is a label of cmu41 and an alias of plugin-gait's LTOE5."""
    assert "LMT5" in match_labels(recording_of(rng, CMU.labels), CMU).labels
    file = recording_of(rng, (*GAIT.required, "LMT5"))
    assert "LTOE5" in match_labels(file, GAIT).labels


def test_two_markers_for_one_label_are_a_clash(rng):
    labels = [label for label in CMU.labels if label != "LHEE"]
    file = recording_of(rng, (*labels, "LHEEL", "LHEL"))
    with pytest.raises(BadRecording, match="LHEEL and LHEL both stand for LHEE of model cmu41"):
        match_labels(file, CMU)


def test_a_bare_twin_of_a_prefixed_marker_is_a_clash(rng):
    file = recording_of(rng, (*prefixed("A", CMU.labels), "LFWT"))
    with pytest.raises(BadRecording, match="A:LFWT and LFWT both stand for LFWT"):
        match_labels(file, CMU)


def test_a_bare_twin_beside_two_people_is_a_clash(rng):
    both = (*prefixed("A", CMU.labels), *prefixed("B", CMU.labels))
    with pytest.raises(BadRecording, match="A:LFWT and LFWT would both be called LFWT"):
        match_labels(recording_of(rng, (*both, "LFWT")), CMU, "A")


@pytest.mark.parametrize("n", [30, 41])
def test_a_body_without_prefix_beside_one_with_is_another_person(rng, n):
    file = recording_of(rng, (*prefixed("A", CMU.labels), *CMU.labels[:n]))
    matched = match_labels(file, CMU, "A")
    assert matched.labels == CMU.labels
    assert_array_equal(matched.markers, file.markers[:, :41])
    assert findings(matched)["other_people"] == [""]
    assert_array_equal(match_labels(file, CMU, "").markers, file.markers[:, 41:])


def test_missing_and_extra_markers_are_told_and_tolerated(rng):
    labels = [label for label in GAIT.required if label not in ("LHEE", "RHEE")]
    file = recording_of(rng, (*labels, "C2", "*12"))
    matched = match_labels(file, GAIT)
    assert findings(matched)["missing"] == ["LHEE", "RHEE"]
    assert findings(matched)["extra"] == ["C2"]
    assert {"C2", "*12"} <= set(matched.labels)
    assert coverage(file, GAIT) == pytest.approx(33 / 35)
    assert matched.history[-1].warnings == ()


def test_much_missing_is_a_warning(rng):
    matched = match_labels(recording_of(rng, CMU.labels[:30]), CMU)
    (warning,) = matched.history[-1].warnings
    assert warning.startswith("only 30 of 41 markers of model cmu41 are there; missing: ")


def test_a_marker_never_seen_is_named(rng):
    file = recording_of(rng, CMU.labels)
    markers = file.markers.copy()
    markers[:, CMU.labels.index("LTHI"), 1] = np.nan
    assert findings(match_labels(replace(file, markers=markers), CMU))["never_seen"] == ["LTHI"]


def test_none_of_the_models_markers_is_an_error(rng):
    file = recording_of(rng, [f"M{i:03}" for i in range(9)])
    with pytest.raises(BadRecording, match=r"no marker of model cmu41 is there; .* M007, …"):
        match_labels(file, CMU)


def test_residuals_stay_with_their_markers(rng):
    file = recording_of(rng, (*prefixed("A", CMU.labels), *prefixed("B", CMU.labels)))
    file = replace(file, residuals=rng.random((FRAMES, 82)))
    matched = match_labels(file, CMU, "B")
    assert_array_equal(matched.residuals, file.residuals[:, 41:])


class TestTwoPeople:
    """Two people, a prop and unlabelled points in one file."""

    @pytest.fixture
    def file(self, rng):
        both = (*prefixed("Ann", CMU.labels), *prefixed("Bob", reversed(CMU.labels)))
        return recording_of(rng, (*both, "Wand:tip", "Wand:LTOE", "*7"))

    def test_subjects_are_listed(self, file):
        assert find_subjects(file) == ("Ann", "Bob", "Wand")
        assert choose_model(file).name == "cmu41"

    def test_without_a_pick_it_is_refused_with_their_names(self, file):
        with pytest.raises(BadRecording, match=r"Ann \(100%\), Bob \(100%\); pick a subject"):
            match_labels(file, CMU)

    def test_it_is_told_how_to_pick(self, rng, file):
        with pytest.raises(BadRecording, match=r"\(--subject NAME\)$"):
            match_labels(file, CMU)
        both = recording_of(rng, (*CMU.labels, *prefixed("Bob", CMU.labels)))
        with pytest.raises(BadRecording, match=r'\(--subject NAME, "" is who has no prefix\)$'):
            match_labels(both, CMU)

    @pytest.mark.parametrize(("subject", "other"), [("Ann", "Bob"), ("Bob", "Ann")])
    def test_the_picked_one_is_kept_with_props_and_unlabelled(self, file, subject, other):
        matched = match_labels(file, CMU, subject)
        assert set(matched.labels) == {*CMU.labels, "Wand:tip", "Wand:LTOE", "*7"}
        for label in CMU.labels:
            assert_array_equal(marker(matched, label), marker(file, f"{subject}:{label}"))
        assert findings(matched)["other_people"] == [other]
        assert matched.history[-1].warnings == (f"markers of other people were dropped: {other}",)

    def test_an_unknown_subject_is_answered_with_the_known_ones(self, file):
        with pytest.raises(BadRecording, match="subject 'Eve'; subjects are 'Ann', 'Bob', 'Wand'"):
            match_labels(file, CMU, "Eve")

    def test_coverage_is_by_subject(self, file):
        assert coverage(file, CMU) == 1
        assert coverage(file, CMU, "Wand") == pytest.approx(1 / 41)
        assert choose_model(file, "Wand") is None


def test_one_person_and_a_prop_need_no_pick(rng):
    file = recording_of(rng, (*prefixed("Ann", CMU.labels), "Wand:tip", "Wand:top"))
    matched = match_labels(file, CMU)
    assert matched.labels == (*CMU.labels, "Wand:tip", "Wand:top")


@pytest.mark.parametrize("n", [18, 41])
def test_a_prop_with_a_prefix_does_not_own_bare_names(rng, n):
    file = recording_of(rng, (*CMU.labels[:n], "Wand:tip"))
    matched = match_labels(file, CMU)
    assert findings(matched)["subject"] == ""
    assert matched.labels == (*CMU.labels[:n], "Wand:tip")


def test_bare_names_beside_one_prefix_are_that_persons_too(rng):
    file = recording_of(rng, (*prefixed("Ann", CMU.labels[:30]), *CMU.labels[30:]))
    matched = match_labels(file, CMU)
    assert findings(matched)["subject"] == "Ann"
    assert matched.labels == CMU.labels


def test_an_extra_keeps_its_prefix_where_its_bare_name_is_taken(rng):
    file = recording_of(rng, (*prefixed("A", CMU.labels), "A:C2", "C2"))
    assert match_labels(file, CMU).labels[-2:] == ("A:C2", "C2")


def test_the_order_of_markers_changes_nothing_but_the_order(rng):
    file = recording_of(rng, (*prefixed("A", CMU.labels), "A:C2", "*1"))
    order = rng.permutation(file.n_markers)
    shuffled = replace(
        file, markers=file.markers[:, order], labels=tuple(file.labels[i] for i in order)
    )
    straight, other = match_labels(file, CMU), match_labels(shuffled, CMU)
    assert other.labels == tuple(straight.labels[i] for i in order)
    assert_array_equal(other.markers, straight.markers[:, order])


def test_matching_twice_changes_nothing_more(rng):
    once = match_labels(recording_of(rng, prefixed("A", CMU.labels)), CMU)
    assert match_labels(once, CMU).labels == once.labels


@pytest.mark.parametrize("model", [CMU, GAIT], ids=lambda model: model.name)
def test_a_layout_is_recognised_to_nine_tenths(rng, model):
    n = len(model.required)
    few = int(n * 0.1)  # as many may be missing
    kept = rng.permutation(n)[few:]
    file = recording_of(rng, [model.required[i] for i in kept])
    assert choose_model(file).name == model.name
    one_less = recording_of(rng, [model.required[i] for i in kept[1:]])
    assert choose_model(one_less) is None


def test_of_two_layouts_the_better_covered_one_is_chosen(rng):
    both = dict.fromkeys((*CMU.labels, *GAIT.required))
    for lost, chosen in (("LPSI", "cmu41"), ("LBWT", "plugin-gait")):
        file = recording_of(rng, [label for label in both if label != lost])
        assert choose_model(file).name == chosen


def test_of_two_layouts_that_are_all_there_the_larger_one_is_chosen(rng):
    both = dict.fromkeys((*CMU.labels, *GAIT.labels))
    assert len(GAIT.labels) > len(CMU.labels)
    assert choose_model(recording_of(rng, both)).name == "plugin-gait"


def test_a_recording_without_markers_wears_nothing():
    empty = Recording(markers=np.empty((FRAMES, 0, 3)), labels=(), rate=100.0)
    assert choose_model(empty) is None
    assert coverage(empty, CMU) == 0
    with pytest.raises(BadRecording, match="no marker of model cmu41"):
        match_labels(empty, CMU)


def test_a_model_that_requires_nothing_counts_all_its_labels(rng):
    wand = TopologicalModel("wand", (Segment("limb_01", ("a", "b", "c")),), (), "limb_01")
    file = recording_of(rng, ("a", "c", "z"))
    assert coverage(file, wand) == pytest.approx(2 / 3)
    assert findings(match_labels(file, wand))["missing"] == ["b"]
