"""write_c3d: nothing lost, and two other readers see what we see."""

import warnings
from dataclasses import replace

import c3d
import ezc3d
import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal
from scipy.spatial.transform import Rotation

from kinesphere.data import Analog, Event, Output, Recording
from kinesphere.errors import BadRecording
from kinesphere.io.c3d import read_c3d, write_c3d
from kinesphere.io.c3d.parameters import Group, Section, words
from kinesphere.io.c3d.points import points_of
from kinesphere.io.c3d.processor import INTEL
from kinesphere.io.c3d.section import bytes_from_section, section_from_bytes

SINGLE = 1.2e-7  # relative; what a 32-bit float loses
STEP = 0.1e-3  # m, of the residuals in files of our own
TURNED = 1e-6  # m; 32-bit floats of some metres, turned there and back


@pytest.fixture
def recording(rng):
    """Return what no file has held yet, with everything a recording can hold."""
    n_frames, n_markers = 11, 4
    markers = rng.normal(size=(n_frames, n_markers, 3))
    markers[2:4, 1] = np.nan
    return Recording(
        markers,
        tuple("ABCD"),
        50.0,
        first_frame=30,
        residuals=np.where(np.isnan(markers[..., 0]), np.nan, 7 * STEP),
        outputs=(
            Output("LKneeAngles", "angle", rng.normal(size=(n_frames, 3)), "deg"),
            Output("Push", "force", rng.normal(size=(n_frames, 3)), "N"),
        ),
        analog=Analog(rng.normal(size=(3 * n_frames, 2)), ("Fx", "Fy"), ("N", "N"), 150.0),
        events=(
            Event(0.125, "Foot Strike", "Left", "Ann", "heel"),
            Event(70.5, "Foot Off", "Right", "Ann"),
        ),
        up="+y",
    )


@pytest.fixture
def rich(c3d_file):
    """Make a file with everything in it that a recording has no name for."""
    points = [
        [(1.0, 2.0, 3.0, 0x0503), (9.0, 8.0, 7.0, -1.0), (4.5, 5.5, 6.5, 0x7F00)],
        [(1.5, 2.5, 3.5, 0x0100), (0.1, 0.2, 0.3, 0x0002), (4.0, 5.0, 6.0, 0.0)],
        [(2.0, 3.0, 4.0, 0.0), (0.7, 0.7, 0.7, 0.0), (3.0, 4.0, 5.0, 1.0)],
    ]
    return c3d_file(
        points=points,
        labels=["A", "B", "A", "spare"],
        first=187,
        analog=[[(1.0, 2.0), (3.0, 4.0)]] * 3,
        events=[(1.9, "RHS")],
        groups={
            "POINT": {"DESCRIPTIONS": ["first", "second", "third"]},
            "ANALOG": {"SCALE": [0.1, 0.0], "OFFSET": [7, 8], "LABELS": ["Fx", "Fy"]},
            "SUBJECTS": {"LABEL_PREFIXES": ["Ann:"], "USES_PREFIXES": [1]},
            "Odd Group": {"lower case": [1.25, 2.5], "Numbers": [1, 2, 3]},
        },
    )


def rewritten(recording, tmp_path):
    path = tmp_path / "written.c3d"
    write_c3d(recording, path)
    return read_c3d(path)


def source(recording):
    return recording.details["c3d"]


def test_a_recording_nobody_changed_comes_back_whole(rich, tmp_path):
    before = read_c3d(rich)
    after = rewritten(before, tmp_path)
    for name in ("labels", "rate", "first_frame", "events", "up"):
        assert getattr(before, name) == getattr(after, name), name
    assert_array_equal(before.markers, after.markers)
    assert_array_equal(before.residuals, after.residuals)
    assert_array_equal(before.analog.values, after.analog.values)
    old, new = source(before), source(after)
    assert_array_equal(old.frames.points, new.frames.points)  # those of unseen points too
    assert_array_equal(old.frames.fourth, new.frames.fourth)  # camera masks too
    assert_array_equal(old.frames.analog, new.frames.analog)  # a channel of scale 0 too
    assert old.layout.section == new.layout.section
    assert old.layout.header.raw[298:] == new.layout.header.raw[298:]  # the events of old


@pytest.mark.parametrize("processor", ["INTEL", "DEC", "MIPS"])
def test_integers_stay_integers_while_they_can(c3d_file, tmp_path, processor):
    path = c3d_file(
        scale=0.3, processor=processor, points=[[(-32768, 2, 3, -32768), (1, 2, 32767)]]
    )
    before = read_c3d(path)
    after = rewritten(before, tmp_path)
    assert after.history[0].findings["encoding"] == "INTEL integer"
    assert_array_equal(source(before).frames.points, source(after).frames.points)
    for beyond in (0.1e-3, 10 * 0.3e-3):  # between two steps; past the largest number of steps
        moved = replace(before, markers=before.markers + beyond)
        after = rewritten(moved, tmp_path)
        assert after.history[0].findings["encoding"] == "INTEL real"
        assert_allclose(after.markers, moved.markers, rtol=SINGLE)


def test_everything_a_recording_of_our_own_holds_comes_back(recording, tmp_path):
    after = rewritten(recording, tmp_path)
    assert_allclose(after.markers, recording.markers, rtol=SINGLE)
    assert_allclose(after.residuals, recording.residuals, rtol=SINGLE)
    assert_allclose(after.analog.values, recording.analog.values, rtol=SINGLE)
    assert after.labels == recording.labels
    assert (after.rate, after.first_frame, after.up) == (50.0, 30, "+y")
    assert (after.analog.labels, after.analog.units, after.analog.rate) == (
        ("Fx", "Fy"), ("N", "N"), 150.0,
    )  # fmt: skip
    for was, now in zip(recording.outputs, after.outputs, strict=True):
        assert (was.label, was.kind, was.unit) == (now.label, now.kind, now.unit)
        assert_allclose(now.values, was.values, rtol=SINGLE)
    for was, now in zip(recording.events, after.events, strict=True):
        assert replace(now, time=was.time) == was
        assert now.time == pytest.approx(was.time, abs=1e-6)
    assert after.history[0].warnings == ()


def test_ezc3d_and_c3d_see_the_same(recording, tmp_path):
    path = tmp_path / "written.c3d"
    write_c3d(recording, path)
    after = read_c3d(path)
    theirs = ezc3d.c3d(str(path))
    points = theirs["data"]["points"][:3].transpose(2, 1, 0)
    assert_array_equal(points[:, :4] * 1e-3, after.markers)
    assert_array_equal(points[:, 4], after.outputs[0].values)
    assert_array_equal(theirs["data"]["analogs"][0].T, after.analog.values)
    assert theirs["parameters"]["POINT"]["LABELS"]["value"][:4] == ["A", "B", "C", "D"]
    assert theirs["header"]["points"]["first_frame"] == 29  # ezc3d counts from 0
    with path.open("rb") as file, warnings.catch_warnings():
        warnings.simplefilter("error")
        reader = c3d.Reader(file)
        pure = [(number, p, a) for number, p, a in reader.read_frames()]
    assert [number for number, _, _ in pure] == list(range(30, 41))
    points = np.array([p for _, p, _ in pure])
    seen = points[..., 3] >= 0
    assert_array_equal(seen[:, :4], after.seen)
    assert_array_equal(
        points[..., :3][:, :4][after.seen], (after.markers * 1e3).astype("f4")[after.seen]
    )
    residuals = np.where(seen, points[..., 3], np.nan)[:, :4]  # ezc3d takes the masks for them
    assert_allclose(residuals, after.residuals * 1e3, rtol=SINGLE)
    analog = np.concatenate([a.T for _, _, a in pure])
    assert_allclose(analog, after.analog.values, rtol=SINGLE)


def test_millimetres_survive_metres_to_the_bit(c3d_file, tmp_path, rng):
    numbers = (rng.normal(size=(3000, 3)) * 10.0 ** rng.integers(-3, 5, (3000, 1))).astype("f4")
    path = c3d_file(points=[[tuple(map(float, row)) for row in numbers]], labels=[])
    after = rewritten(read_c3d(path), tmp_path)
    assert_array_equal(source(after).frames.points[0], numbers)


def test_the_axes_of_the_file_come_back(c3d_file, tmp_path):
    before = read_c3d(c3d_file())
    up_from_z = np.array([[1.0, 0.0, 0.0], [0.0, 0.0, 1.0], [0.0, -1.0, 0.0]])
    turn = Rotation.from_euler("xyz", [0.3, -0.2, 1.1]).as_matrix()
    for matrix, tolerance in ((up_from_z, 0.0), (turn, TURNED)):
        turned = replace(before, markers=before.markers @ matrix.T, world_from_file=matrix)
        assert_allclose(rewritten(turned, tmp_path).markers, before.markers, rtol=0, atol=tolerance)


def test_up_is_written_in_the_axes_of_the_file(recording, tmp_path):
    matrix = np.array(
        [[1.0, 0.0, 0.0], [0.0, 0.0, 1.0], [0.0, -1.0, 0.0]]
    )  # y of the world: file's z
    assert rewritten(replace(recording, world_from_file=matrix), tmp_path).up == "+z"


def test_an_up_that_is_no_axis_of_the_file_is_not_said(recording, tmp_path):
    slant = Rotation.from_euler("x", 30, degrees=True).as_matrix()
    assert rewritten(replace(recording, world_from_file=slant), tmp_path).up is None


def test_new_labels_keep_the_place_and_the_rest_of_their_point(rich, tmp_path):
    before = read_c3d(rich)
    after = rewritten(replace(before, labels=("HEAD", *before.labels[1:])), tmp_path)
    assert after.labels == ("HEAD", "B", "A_2"[:1])  # no other A is left to tell it from
    assert_array_equal(source(after).frames.fourth, source(before).frames.fourth)
    section = source(after).layout.section
    assert section.texts("POINT", "LABELS") == ("HEAD", "B", "A", "spare")
    assert section.texts("POINT", "DESCRIPTIONS") == ("first", "second", "third")


def test_markers_in_another_order_go_back_to_their_places(rich, tmp_path):
    before = read_c3d(rich)
    order = [2, 0, 1]
    shuffled = replace(
        before,
        markers=before.markers[:, order],
        residuals=before.residuals[:, order],
        labels=tuple(before.labels[i] for i in order),
    )
    after = rewritten(shuffled, tmp_path)
    assert after.labels == before.labels
    assert_array_equal(after.markers, before.markers)
    assert_array_equal(source(after).frames.fourth, source(before).frames.fourth)


def test_a_marker_whose_place_is_taken_is_a_new_one(rich, tmp_path):
    before = read_c3d(rich)
    after = rewritten(replace(before, labels=("B", "X", "A_2")), tmp_path)
    section = source(after).layout.section
    assert section.texts("POINT", "LABELS") == ("B", "A", "X", "spare")
    assert section.texts("POINT", "DESCRIPTIONS") == ("second", "third", "")


def test_frames_at_another_rate_are_others_and_take_no_masks(rich, tmp_path):
    before = read_c3d(rich)
    after = rewritten(replace(before, rate=50.0, analog=None), tmp_path)
    assert after.rate == 50.0
    assert_array_equal(source(after).frames.fourth[:2], [[3, -1, 0], [0, 2, 0]])


@pytest.mark.parametrize("padded", [True, False])
def test_what_ends_on_no_block_is_given_none(c3d_file, tmp_path, padded):
    path = c3d_file(first=0, padded=padded)
    write_c3d(read_c3d(path), tmp_path / "written.c3d")
    assert (tmp_path / "written.c3d").stat().st_size == path.stat().st_size
    with (tmp_path / "written.c3d").open("rb") as file, warnings.catch_warnings():
        warnings.simplefilter("ignore")
        assert len(list(c3d.Reader(file).read_frames())) == (2 if padded else 1)  # of truly one


def test_parameters_that_were_missing_find_room_before_the_data(c3d_file, tmp_path):
    for filling in range(0, 512, 16):
        missing = {"DATA_START": None, "SCALE": None, "RATE": None}
        groups = {
            "POINT": missing,
            "ODD": {"LESS": "x" * min(filling, 255), "MORE": "x" * max(0, filling - 255)},
        }
        before = read_c3d(c3d_file(groups=groups))
        assert_array_equal(rewritten(before, tmp_path).markers, before.markers)


def test_a_prefix_taken_away_is_no_longer_announced(c3d_file, tmp_path):
    subjects = {"LABEL_PREFIXES": ["Ann:"], "USES_PREFIXES": [1]}
    points = {"ANGLES": ["Ann:LHipAngles"], "TYPE_GROUPS": ["ANGLES", "ANGLE"]}
    before = read_c3d(
        c3d_file(
            labels=["Ann:C7", "Ann:LHipAngles"], groups={"SUBJECTS": subjects, "POINT": points}
        )
    )
    bare = replace(
        before, labels=("C7",), outputs=(replace(before.outputs[0], label="LHipAngles"),)
    )
    section = source(rewritten(bare, tmp_path)).layout.section
    assert section.numbers("SUBJECTS", "USES_PREFIXES") == [0]
    assert section.texts("POINT", "ANGLES")[-1] == "LHipAngles"
    kept = source(rewritten(before, tmp_path)).layout.section
    assert kept.numbers("SUBJECTS", "USES_PREFIXES") == [1]


def test_points_may_be_added(rich, tmp_path):
    before = read_c3d(rich)
    centre = before.markers.mean(axis=1, keepdims=True)
    more = replace(
        before,
        markers=np.concatenate([centre, before.markers], axis=1),
        residuals=np.concatenate([np.full((3, 1), np.nan), before.residuals], axis=1),
        labels=("left_knee", *before.labels),
    )
    after = rewritten(more, tmp_path)
    assert after.labels == (*before.labels, "left_knee")
    assert_array_equal(after.markers[:, :3], before.markers)
    assert_allclose(after.markers[:, 3], centre[:, 0], rtol=SINGLE)
    assert source(after).layout.section.texts("POINT", "LABELS")[:4] == ("A", "B", "A", "left_knee")
    assert_array_equal(source(after).frames.fourth[:, :3], source(before).frames.fourth)


def test_a_filled_gap_is_seen_and_a_deleted_point_is_not(rich, tmp_path):
    before = read_c3d(rich)
    markers = before.markers.copy()
    markers[0, 1], markers[2, 0] = 0.5, np.nan
    after = rewritten(replace(before, markers=markers), tmp_path)
    assert_array_equal(after.seen[:, :2], [[True, True], [True, True], [False, True]])
    assert_allclose(after.markers[0, 1], 0.5)


def test_a_part_of_a_trial_keeps_its_frame_numbers_and_masks(rich, tmp_path):
    before = read_c3d(rich)
    part = replace(
        before,
        markers=before.markers[1:],
        residuals=before.residuals[1:],
        analog=replace(before.analog, values=before.analog.values[2:]),
        events=(),
        first_frame=188,
    )
    after = rewritten(part, tmp_path)
    assert (after.first_frame, after.n_frames, after.events) == (188, 2, ())
    assert_array_equal(source(after).frames.fourth, source(before).frames.fourth[1:])
    assert_allclose(after.analog.values, part.analog.values, atol=SINGLE)


def test_changed_events_replace_those_of_the_header(rich, tmp_path):
    before = read_c3d(rich)
    assert [event.label for event in before.events] == ["RHS"]
    after = rewritten(replace(before, events=(Event(0.01, "LTO", "Left"),)), tmp_path)
    assert [(event.label, event.context) for event in after.events] == [("LTO", "Left")]
    assert source(after).layout.header.events == ()


@pytest.mark.parametrize("processor", ["INTEL", "DEC", "MIPS"])
def test_events_of_the_header_speak_intel(c3d_file, tmp_path, processor):
    events = [(0.25, "RHS"), (0.5, "LTO")]
    header = source(rewritten(read_c3d(c3d_file(processor=processor, events=events)), tmp_path))
    assert header.layout.header.events == tuple(events)
    assert header.layout.header.raw[376:380] == b"\x01\x02\0\0"


def test_icons_of_events_that_are_no_more_go_with_them(c3d_file, tmp_path):
    events = {"USED": [1], "LABELS": ["Foot Off"], "TIMES": [0.0, 0.0], "ICON_IDS": [2]}
    before = read_c3d(c3d_file(groups={"EVENT": events}))
    after = rewritten(replace(before, events=(Event(0.0, "Foot Strike"),)), tmp_path)
    assert source(before).layout.section.find("EVENT", "ICON_IDS") is not None
    assert source(after).layout.section.find("EVENT", "ICON_IDS") is None


def test_events_keep_their_instant_when_the_first_frame_gets_another_number(c3d_file, tmp_path):
    events = {"USED": [1], "LABELS": ["Foot Off"], "TIMES": [0.0, 1.25]}
    before = read_c3d(c3d_file(first=101, groups={"EVENT": events}))
    after = rewritten(replace(before, first_frame=201), tmp_path)
    assert after.events == before.events
    assert after.events[0].time == 0.25


def test_fewer_and_longer_labels_of_as_many_letters(c3d_file, tmp_path):
    six = [f"A{i}" for i in range(6)]
    before = read_c3d(c3d_file(points=[[(float(i), 2.0, 3.0) for i in range(6)]], labels=six))
    three = replace(before, markers=before.markers[:, :3], labels=("LEFT", "RIGH", "BACK"))
    assert rewritten(three, tmp_path).labels == ("LEFT", "RIGH", "BACK")


@pytest.mark.parametrize("n", [256, 700])
def test_many_points_channels_and_events(rng, tmp_path, n):
    many = Recording(
        rng.normal(size=(2, n, 3)),
        tuple(f"marker with a {'very ' * 25} long name of its own {i}" for i in range(n)),
        100.0,
        analog=Analog(rng.normal(size=(4, n)), tuple(f"c{i}" for i in range(n)), ("V",) * n, 200.0),
        events=tuple(Event(i * 0.5, f"e{i}") for i in range(n)),
    )
    after = rewritten(many, tmp_path)
    assert after.labels == many.labels
    assert after.analog.labels == many.analog.labels
    assert_allclose(after.markers, many.markers, rtol=SINGLE)
    assert_allclose(after.analog.values, many.analog.values, rtol=SINGLE)
    assert [event.label for event in after.events] == [event.label for event in many.events]
    theirs = ezc3d.c3d(str(tmp_path / "written.c3d"))
    assert_array_equal(theirs["data"]["points"][:3].transpose(2, 1, 0) * 1e-3, after.markers)
    parts = [p for name, p in theirs["parameters"]["POINT"].items() if name.startswith("LABELS")]
    assert [label for part in parts for label in part["value"]] == list(many.labels)
    with (tmp_path / "written.c3d").open("rb") as file:  # takes the way to a record as signed
        assert c3d.Reader(file).get("POINT:UNITS").string_value == "mm"


@pytest.mark.parametrize("first", [1, 70])
def test_long_trials(rng, tmp_path, first):
    n_frames = 65_600
    long = Recording(rng.normal(size=(n_frames, 1, 3)), ("A",), 1000.0, first_frame=first)
    after = rewritten(long, tmp_path)
    assert (after.n_frames, after.first_frame) == (n_frames, first)
    assert_allclose(after.markers[-1], long.markers[-1], rtol=SINGLE)
    theirs = ezc3d.c3d(str(tmp_path / "written.c3d"))
    assert theirs["data"]["points"].shape == (4, 1, n_frames)
    with (tmp_path / "written.c3d").open("rb") as file, warnings.catch_warnings():
        warnings.filterwarnings("ignore", "No analog data")
        reader = c3d.Reader(file)
        assert (reader.first_frame, reader.frame_count) == (first, n_frames)


def test_a_part_from_late_in_a_long_trial(rng, tmp_path):
    late = Recording(rng.normal(size=(5, 1, 3)), ("A",), 1000.0, first_frame=70_000)
    after = rewritten(late, tmp_path)
    assert (after.n_frames, after.first_frame) == (5, 70_000)


def test_parameters_of_one_name_become_several_and_the_last_keeps_it(c3d_file, tmp_path):
    before = read_c3d(c3d_file(groups={"P": {"Mass": [1.0], "mass": [2.0], "Mass_1": [3.0]}}))
    group = source(rewritten(before, tmp_path)).layout.section.group("P")
    assert [p.name for p in group.parameters] == ["Mass_2", "mass", "Mass_1"]


def test_a_group_said_twice_keeps_the_parameters_of_both():
    first, second = words("USED", 3), words("FRAMES", 9)
    twice = (Group(5, "POINT", parameters=(first,)), Group(5, "POINT", parameters=(second,)))
    (group,) = section_from_bytes(bytes_from_section(Section(twice)), INTEL).groups
    assert group.parameters == (first, second)


def test_descriptions_and_locks_are_kept(rich):
    section = source(read_c3d(rich)).layout.section
    group = section.groups[0]
    locked = replace(group.parameters[0], locked=True, description="how many")
    odd = replace(group, locked=True, description="points", parameters=(locked,))
    changed = replace(section, groups=(odd, *section.groups[1:]))
    assert section_from_bytes(bytes_from_section(changed), INTEL) == changed


def test_segment_rotations_are_taken_along(tmp_path):
    made = ezc3d.c3d()
    made["parameters"]["POINT"]["LABELS"]["value"] = ["A", "B"]
    made["parameters"]["POINT"]["RATE"]["value"] = [100.0]
    made["data"]["points"] = np.ones((4, 2, 6))
    made["data"]["rotations"] = np.arange(96.0).reshape(4, 4, 1, 6)
    group = {"USED": (2, 1), "RATE": (4, 100.0), "RATIO": (2, 1), "DATA_START": (2, 0)}
    made["parameters"]["ROTATION"] = {
        name: {"type": kind, "description": "", "is_locked": False, "value": np.array([value])}
        for name, (kind, value) in group.items()
    } | {"__METADATA__": {"DESCRIPTION": "", "IS_LOCKED": False}}
    made.write(str(tmp_path / "made.c3d"))
    before = read_c3d(tmp_path / "made.c3d")
    grown = replace(
        before, markers=np.ones((6, 99, 3)), labels=tuple(f"{i}" for i in range(99)), residuals=None
    )
    write_c3d(grown, tmp_path / "grown.c3d")
    theirs = [ezc3d.c3d(str(tmp_path / name)) for name in ("made.c3d", "grown.c3d")]
    assert theirs[0]["data"]["rotations"].shape == (4, 4, 1, 6)
    assert_array_equal(theirs[1]["data"]["rotations"], theirs[0]["data"]["rotations"])


@pytest.mark.parametrize(
    ("different", "message"),
    [
        ({"labels": ("A", "B", "C", "D" * 300)}, "longer than the 255 bytes"),
        ({"first_frame": -1}, "the first frame is -1"),
        ({"markers": np.full((11, 4, 3), 1e40)}, "too large"),
        (
            {"analog": Analog(np.zeros((13, 1)), ("Fx",), ("N",), 59.0)},
            "13 analog samples do not share out among 11 frames",
        ),
    ],
)
def test_what_the_format_has_no_room_for(recording, tmp_path, different, message):
    path = tmp_path / "kept.c3d"
    path.write_bytes(b"before")
    with pytest.raises(BadRecording, match=message):
        write_c3d(replace(recording, **different), path)
    assert path.read_bytes() == b"before"


@pytest.mark.parametrize(
    ("shape", "labels", "message"),
    [((0, 1, 3), ("A",), "without frames"), ((4, 0, 3), (), "without points or channels")],
)
def test_an_empty_recording_is_refused(tmp_path, shape, labels, message):
    with pytest.raises(BadRecording, match=message):
        write_c3d(Recording(np.empty(shape), labels, 100.0), tmp_path / "none.c3d")


def test_what_is_new_keeps_its_names_where_readers_know_255(recording, rng, tmp_path):
    """Beyond 255 points the vendor's outputs go last: their names go to LABELS2, ours do not."""
    n = recording.n_frames

    def outputs(names, kind):
        return tuple(Output(name, kind, rng.normal(size=(n, 3)), "deg") for name in names)

    vendor = [f"Vendor{i}" for i in range(248)]
    first = replace(recording, outputs=outputs(vendor, "angle"))
    write_c3d(first, tmp_path / "first.c3d")
    had = read_c3d(tmp_path / "first.c3d")
    more = replace(
        had,
        markers=np.concatenate([had.markers, had.markers[:, :2]], axis=1),
        labels=(*had.labels, "knee", "hip"),
        residuals=None if had.residuals is None else np.hstack([had.residuals] * 2)[:, :6],
        outputs=(*had.outputs, *outputs(["knee_angles", "hip_angles"], "angle")),
    )
    write_c3d(more, tmp_path / "more.c3d")
    ours = ["A", "B", "C", "D", "knee", "hip", "knee_angles", "hip_angles"]
    other = ezc3d.c3d(str(tmp_path / "more.c3d"))
    points = other["parameters"]["POINT"]
    assert points["LABELS"]["value"] == [*ours, *vendor[:247]]
    assert points["LABELS2"]["value"] == vendor[247:]
    assert other["data"]["points"].shape[1] == 256
    again = read_c3d(tmp_path / "more.c3d")
    assert list(again.labels) == ours[:6]
    assert_allclose(again.markers, more.markers, rtol=SINGLE, atol=1e-9, equal_nan=True)
    values = {output.label: output.values for output in again.outputs}
    assert list(values) == [*ours[6:], *vendor]
    for output in more.outputs:
        assert_allclose(values[output.label], output.values, rtol=SINGLE)
    # nothing is new in this one: its order stays
    assert [p.label for p in points_of(again, source(again))] == [*ours, *vendor]
    assert [p.label for p in points_of(had, source(had))] == [*ours[:4], *vendor]
