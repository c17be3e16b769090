"""Left and right of one part of the body exchanged, heels called toes: told, no more."""

from dataclasses import replace

import numpy as np
import pytest

from kinesphere.quality import check_recording, orient
from kinesphere.synthetic import make_performance

FIRST = 101
LEGS, ARMS = ("KNE", "ANK", "HEE", "TOE"), ("ELB", "WRA")
PELVIS, SHOULDERS, HEAD = ("FWT", "BWT"), ("SHO",), ("FHD", "BHD")
ROTATION = np.array([[0.0, 0, 1], [1, 0, 0], [0, 1, 0]])


def renamed(recording, others):
    """Return the recording with labels exchanged, ``others``: label → what it is called."""
    labels = tuple(others.get(label, label) for label in recording.labels)
    return replace(recording, labels=labels, first_frame=FIRST)


def exchanged(recording, names):
    """Return the recording with left and right of these names exchanged."""
    return renamed(recording, {a + n: b + n for n in names for a, b in ("LR", "RL")})


def found(recording, *rules):
    return [f for f in check_recording(recording) if f.rule in (rules or ("sides", "heels"))]


def markers_of(*parts):
    return {side + name for part in parts for name in part for side in "LR"}


def test_a_walker_is_put_together_rightly(walker):
    assert found(walker) == []


@pytest.mark.parametrize(
    "turn", [np.eye(3), ROTATION, -np.eye(3)], ids=["as is", "turned", "mirror"]
)
@pytest.mark.parametrize(
    ("names", "part"),
    [(LEGS, "legs"), (ARMS, "arms"), (HEAD, "head")],
    ids=["legs", "arms", "head"],
)
def test_what_lies_on_the_wrong_side_of_the_trunk_is_told(walker, names, part, turn):
    """In a mirror image it is the rest that has the sides of the world: both say the same."""
    spoilt = exchanged(replace(walker, markers=walker.markers @ turn.T), names)
    told = found(spoilt)
    if np.linalg.det(turn) > 0:
        (finding,) = told
        assert set(finding.markers) == markers_of(names)
        assert f"left and right labels of the {part} are exchanged: " in finding.what
        assert "in 100% of the frames" in finding.what
        assert finding.remedy == "exchange the two labels of each of these pairs"
        assert (finding.severity, finding.frame) == ("warning", FIRST)
    # following the advice leaves nothing to say
    mended = exchanged(spoilt, {label[1:] for finding in told for label in finding.markers})
    assert told
    assert found(mended) == []


@pytest.mark.parametrize("lower_alone", [False, True])
def test_a_pelvis_against_all_others_is_the_one_that_is_wrong(walker, lower_alone):
    spoilt = exchanged(walker, PELVIS)
    if lower_alone:
        few = [c for c, label in enumerate(walker.labels) if label in markers_of(LEGS, PELVIS)]
        spoilt = replace(
            spoilt, markers=spoilt.markers[:, few], labels=tuple(spoilt.labels[c] for c in few)
        )
    (finding,) = found(spoilt)
    assert set(finding.markers) == markers_of(PELVIS)


def test_a_whole_upper_body_is_told_part_by_part(walker):
    told = found(exchanged(walker, (*SHOULDERS, *ARMS, *HEAD)))
    assert [set(f.markers) for f in told] == [markers_of(p) for p in (SHOULDERS, HEAD, ARMS)]


@pytest.mark.parametrize("mirrored", [False, True])
def test_a_mirror_image_is_no_matter_of_one_part(walker, mirrored):
    """Nor is a person all of whose labels are exchanged: left and right agree among themselves."""
    person = replace(walker, markers=walker.markers * [1, 1, -1]) if mirrored else walker
    assert found(person) == []
    assert found(exchanged(person, (*LEGS, *ARMS, *PELVIS, *SHOULDERS, *HEAD))) == []


def test_one_pair_alone_is_named_alone(walker):
    (finding,) = found(exchanged(walker, ("KNE",)))
    assert set(finding.markers) == {"LKNE", "RKNE"}


def test_where_other_markers_of_the_same_knees_lie_rightly_legs_may_be_crossed(walker):
    inner = walker.markers[:, [walker.labels.index(label) for label in ("RKNE", "LKNE")]]
    seated = replace(
        walker,
        markers=np.concatenate([walker.markers, inner + 0.01], axis=1),
        labels=(*walker.labels, "LKNI", "RKNI"),
    )
    (finding,) = found(seated)
    assert "left and right labels of the legs may be exchanged: LKNI and RKNI" in finding.what
    (finding,) = found(exchanged(seated, ("KNE",)))
    assert "labels of the legs are exchanged" in finding.what


@pytest.mark.parametrize("names", [("ANK", "HEE", "TOE"), ("WRA",)], ids=["feet", "hands"])
def test_crossed_feet_and_hands_are_no_exchange(walker, names):
    """By where they are that is the same thing, and people do it."""
    assert found(exchanged(walker, names), "sides") == []


@pytest.mark.parametrize(("share", "told"), [(0.4, None), (0.7, "may be"), (1.0, "are")])
def test_only_what_lasts_is_told_and_only_what_nobody_does_for_certain(walker, share, told):
    markers, n = walker.markers.copy(), round(share * walker.n_frames)
    pair = [walker.labels.index(label) for label in ("LKNE", "RKNE")]
    markers[:n, pair] = markers[:n, pair[::-1]]
    findings = found(replace(walker, markers=markers))
    assert [f"labels of the legs {told} exchanged" in f.what for f in findings] == [True] * bool(
        told
    )


@pytest.mark.parametrize("seed", range(4))
def test_an_actor_whose_joints_go_to_their_limits_is_put_together_rightly(seed):
    """The knees of one of these cross in 4 % of the frames."""
    actor = make_performance(
        np.random.default_rng(seed), layout="cmu41", rate=20.0, calibration_s=20.0, free_s=10.0
    ).recording
    assert found(actor) == []
    legs = ("THI", "KNE", "SHN", "ANK", "HEE", "TOE", "MT5")
    (finding,) = found(exchanged(actor, legs))
    assert {label[1:] for label in finding.markers} == set(legs)


class TestHeels:
    @pytest.mark.parametrize("sides", ["L", "R", "LR"])
    @pytest.mark.parametrize("mirrored", [False, True])
    def test_what_is_called_toe_at_the_heel_is_told_and_no_mirror_image(
        self, walker, sides, mirrored
    ):
        few = [c for c, label in enumerate(walker.labels) if label in markers_of(LEGS, PELVIS)]
        legs = replace(
            walker,
            markers=walker.markers[:, few] * [1, 1, -1 if mirrored else 1],
            labels=tuple(walker.labels[c] for c in few),
        )
        pairs = [
            (side + a, side + b) for side in sides for a, b in (("HEE", "TOE"), ("TOE", "HEE"))
        ]
        spoilt = renamed(legs, dict(pairs))
        (finding,) = found(spoilt)
        assert set(finding.markers) == {label for pair in pairs for label in pair}
        assert "labels of heel and toe are exchanged: " in finding.what
        oriented = orient(spoilt).history[-1]
        # the feet alone tell a mirror image here: what is left of them still does, rightly
        assert oriented.findings["mirrored"] == (mirrored and len(sides) == 1)
        assert not any("mixed up" in warning for warning in oriented.warnings)

    @pytest.mark.parametrize("other", ["TOE", "HEE"])
    def test_an_ankle_elsewhere_is_no_matter_of_heel_and_toe(self, walker, other):
        pair = {"LANK": f"L{other}", f"L{other}": "LANK"}
        assert found(renamed(walker, pair), "heels") == []
