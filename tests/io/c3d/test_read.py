"""read_c3d against files that were put together number by number."""

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal

from kinesphere.data import Event
from kinesphere.errors import UnreadableFile
from kinesphere.io.c3d import read_c3d

SINGLE = 2e-7  # relative; what a 32-bit float loses
PROCESSORS = ("INTEL", "DEC", "MIPS")


def warnings_of(recording):
    return " | ".join(recording.history[0].warnings)


def frames(n_frames, n_points, scale=1.0):
    """Coordinates all different, whole multiples of ``scale``: (n_frames, n_points, 3) as lists."""
    numbers = np.arange(n_frames * n_points * 3).reshape(n_frames, n_points, 3) - 7
    return [[tuple(float(v * scale) for v in point) for point in frame] for frame in numbers]


@pytest.mark.parametrize("processor", PROCESSORS)
@pytest.mark.parametrize("scale", [0.25, -0.25])
def test_all_six_encodings_say_the_same(c3d_file, processor, scale):
    step = scale if scale > 0 else 1.0
    points = [
        [(-4.0, 8.0, 15.0), (160.0, 230.0, 420.0)],
        [(0.0, 1.0, 2.0), (3.0, 4.0, 5.0, 0x05C8)],
    ]
    stored = [[tuple(v / step for v in p[:3]) + p[3:] for p in frame] for frame in points]
    analog = [[(1.0, -2.0), (3.0, 4.0), (5.0, 6.0)], [(7.0, 8.0), (9.0, 10.0), (11.0, 12.0)]]
    path = c3d_file(
        points=stored,
        scale=scale,
        processor=processor,
        analog=analog,
        events=[(0.01, "RHS")],
        groups={"ANALOG": {"SCALE": [2.0, 0.5], "OFFSET": [1, -2], "GEN_SCALE": [10.0]}},
    )
    recording = read_c3d(path)
    assert_array_equal(recording.markers * 1000, np.array([[p[:3] for p in f] for f in points]))
    assert recording.labels == ("A", "B")
    assert recording.rate == 100.0
    assert_allclose(recording.residuals[1, 1], 0xC8 * 0.25e-3, rtol=SINGLE)  # 05: cameras
    assert_allclose(recording.analog.values[0], [0.0, 0.0])
    assert_allclose(recording.analog.values[-1], [(11 - 1) * 20.0, (12 + 2) * 5.0])
    assert recording.analog.values.shape == (6, 2)
    assert recording.analog.rate == 300.0
    assert recording.events[0].label == "RHS"
    assert_allclose(recording.events[0].time, 0.01, rtol=SINGLE)
    kind = "real" if scale < 0 else "integer"
    assert recording.history[0].findings["encoding"] == f"{processor} {kind}"


def test_a_negative_fourth_word_hides_a_point_whatever_its_coordinates(c3d_file):
    path = c3d_file(points=[[(1.0, 2.0, 3.0, -3.0), (0.0, 0.0, 0.0, 0.0)]])
    recording = read_c3d(path)
    assert np.isnan(recording.markers[0, 0]).all()
    assert_array_equal(recording.markers[0, 1], 0.0)  # zero is data


def test_what_is_not_finite_is_not_seen_and_infinity_is_said_aloud(c3d_file):
    nan, inf = float("nan"), float("inf")
    path = c3d_file(
        points=[[(nan, 2.0, 3.0), (1.0, 2.0, 3.0)], [(4.0, -inf, 6.0), (1.0, 2.0, 3.0)]]
    )
    recording = read_c3d(path)
    assert_array_equal(recording.seen, [[False, True], [False, True]])
    assert "1 points have infinite coordinates (first: point 1 of stored frame 1)" in warnings_of(
        recording
    )


@pytest.mark.parametrize(
    ("unit", "metres"),
    [("mm", 1e-3), ("mm      ", 1e-3), ("MM", 1e-3), ("mm\0\0", 1e-3), ("cm", 1e-2), ("m", 1.0),
     ("in", 0.0254)],
)  # fmt: skip
def test_units_of_length(c3d_file, unit, metres):
    size = 1.0 / metres
    path = c3d_file(points=[[(0.0, 0.0, 0.0), (0.5 * size, size, size)]], unit=unit)
    recording = read_c3d(path)
    assert_allclose(recording.markers[0, 1], [0.5, 1.0, 1.0], rtol=SINGLE)
    assert warnings_of(recording) == ""


def test_one_unit_a_point_is_one_unit(c3d_file):
    recording = read_c3d(c3d_file(unit=["cm", "cm"], points=[[(0.0, 0.0, 0.0), (9.0, 90.0, 9.0)]]))
    assert_allclose(recording.markers[0, 1, 1], 0.9)


@pytest.mark.parametrize(("size", "unit"), [(1500.0, "mm"), (1.5, "m")])
@pytest.mark.parametrize("said", ["    ", "furlong"])
def test_a_unit_nobody_knows_is_guessed_aloud(c3d_file, size, unit, said):
    recording = read_c3d(c3d_file(points=[[(0.0, 0.0, 0.0), (0.0, size, 0.0)]], unit=said))
    assert_allclose(recording.markers[0, 1, 1], 1.5)
    assert f"{unit} is guessed" in warnings_of(recording)


def test_a_unit_that_cannot_be_is_doubted(c3d_file):
    recording = read_c3d(c3d_file(points=[[(0.0, 0.0, 0.0), (0.0, 1500.0, 0.0)]], unit="m"))
    assert "the markers span 1.35e+03 m" in warnings_of(recording)  # from 5 to 95 %


def test_outputs_keep_their_unit_and_are_no_markers(c3d_file):
    path = c3d_file(
        points=[[(1.0, 2.0, 3.0), (30.0, -40.0, 50.0), (7.0, 8.0, 9.0, -1.0)]],
        labels=["A", "Elbow", "LHipPower"],
        groups={"POINT": {"ANGLES": ["Elbow"], "ANGLE_UNITS": "deg"}},
    )
    recording = read_c3d(path)
    assert recording.labels == ("A",)
    elbow, power = recording.outputs
    assert (elbow.label, elbow.kind, elbow.unit) == ("Elbow", "angle", "deg")
    assert_array_equal(elbow.values, [[30.0, -40.0, 50.0]])
    assert power.kind == "power"
    assert np.isnan(power.values).all()


def test_typed_groups_of_any_name(c3d_file):
    path = c3d_file(
        points=[[(1.0, 2.0, 3.0)] * 3],
        labels=["A", "B", "C"],
        groups={
            "POINT": {
                "MYTHINGS": ["B"],
                "ODD": ["C"],
                "TYPE_GROUPS": ["MYTHINGS", "FORCE", "ODD", "X"],
            }
        },
    )
    assert [o.kind for o in read_c3d(path).outputs] == ["force", "other"]


def test_more_than_255_labels(c3d_file):
    labels = [f"P{i}" for i in range(300)]
    recording = read_c3d(c3d_file(points=frames(2, 300), labels=labels))
    assert recording.labels == tuple(labels)


def test_a_record_longer_than_a_signed_word_can_say(c3d_file):
    labels = [f"{i}".ljust(200, "x") for i in range(255)]  # 51,000 bytes
    groups = {"POINT": {"LABELS": labels, "Y_SCREEN": "+Y"}}  # what comes behind it is found
    recording = read_c3d(c3d_file(points=frames(2, 255), groups=groups))
    assert recording.labels == tuple(labels)
    assert recording.up == "+y"


def test_of_two_parameters_of_one_name_the_last_counts(c3d_file):
    assert read_c3d(c3d_file(groups={"POINT": {"Rate": [50.0]}})).rate == 50.0


def test_labels_beyond_the_points_in_use_name_nothing(c3d_file):
    assert read_c3d(c3d_file(labels=["A", "B", "C", "A"])).labels == ("A", "B")


def test_points_without_a_label_get_a_star_and_labels_said_twice_a_number(c3d_file):
    labels = ["A", "", "A", "A_2", "*1"]
    recording = read_c3d(c3d_file(points=frames(2, 7), labels=labels))
    assert recording.labels == ("A", "*1'", "A_2'", "A_2", "*1", "*5", "*6")
    assert "label A is there more than once; point 3" in warnings_of(recording)


def test_one_frame_reads_and_the_first_keeps_its_number(c3d_file):
    recording = read_c3d(c3d_file(first=187))
    assert recording.markers.shape == (1, 2, 3)
    assert recording.first_frame == 187


def long_files():
    """Ways to say that a trial has more frames than 16 bits can count."""
    n = 65_540
    end = {"ACTUAL_START_FIELD": [1, 0], "ACTUAL_END_FIELD": [n % 65536, n // 65536]}
    yield "trial", n, {"last": 65535, "groups": {"TRIAL": end}}
    yield "long", n, {"last": 65535, "groups": {"POINT": {"LONG_FRAMES": [float(n)]}}}
    yield "frames", n, {"last": 65535, "groups": {"POINT": {"FRAMES": [float(n)]}}}
    yield "wrapped", n, {"last": n % 65536, "groups": {"TRIAL": end}}


@pytest.mark.parametrize(("n", "different"), [pytest.param(*r, id=i) for i, *r in long_files()])
def test_long_trials(c3d_file, n, different):
    points = [[(float(i % 1000), 0.0, float(i // 1000))] for i in range(n)]
    recording = read_c3d(c3d_file(points=points, labels=["A"], **different))
    assert recording.n_frames == n
    assert_allclose(recording.markers[-1, 0] * 1000, points[-1][0])


def test_a_trial_field_left_over_from_before_cutting_is_no_truth(c3d_file):
    end = {"ACTUAL_START_FIELD": [1, 0], "ACTUAL_END_FIELD": [1303, 0]}
    assert read_c3d(c3d_file(groups={"TRIAL": end})).n_frames == 1


def test_unsigned_samples(c3d_file):
    groups = {"ANALOG": {"FORMAT": "UNSIGNED", "OFFSET": [32768], "SCALE": [0.5]}}
    analog = [[(65535,), (0,)]]
    recording = read_c3d(c3d_file(scale=0.5, points=[[(1, 2, 3)]], analog=analog, groups=groups))
    assert_allclose(recording.analog.values[:, 0], [32767 / 2, -32768 / 2])


def test_samples_that_are_no_numbers_are_missing(c3d_file):
    recording = read_c3d(c3d_file(analog=[[(float("inf"),), (2.0,)]]))
    assert_array_equal(np.isnan(recording.analog.values[:, 0]), [True, False])
    assert "1 analog samples" in warnings_of(recording)


def test_events_run_on_the_clock_of_the_recording(c3d_file):
    events = {
        "USED": [2],
        "LABELS": ["Foot Strike", "Foot Off", "of an older trial"],
        "CONTEXTS": ["Left", "Right", ""],
        "SUBJECTS": ["Ann", "", ""],
        "TIMES": [0.0, 3.5, 1.0, 2.25, 0.0, 3.0],
    }
    recording = read_c3d(c3d_file(first=201, events=[(9.0, "OLD")], groups={"EVENT": events}))
    assert recording.events == (
        Event(1.5, "Foot Strike", "Left", "Ann"),  # frame 1 is at 0, frame 201 at 2 s
        Event(60.25, "Foot Off", "Right", ""),
    )


def test_a_header_without_the_key_to_its_labels_has_no_events(c3d_file):
    path = c3d_file(events=[(0.0, "RHS")])
    content = bytearray(path.read_bytes())
    content[298:300] = b"\0\0"
    path.write_bytes(bytes(content))
    assert read_c3d(path).events == ()


@pytest.mark.parametrize(
    ("said", "up"), [("+Z", "+z"), ("Y", "+y"), ("-X", "-x"), ("Z+", "+z"), ("up", None)]
)
def test_the_axis_that_points_up_on_the_screen(c3d_file, said, up):
    assert read_c3d(c3d_file(groups={"POINT": {"Y_SCREEN": said}})).up == up


def test_a_file_may_hold_analog_channels_alone(c3d_file):
    recording = read_c3d(c3d_file(points=[[], []], labels=[], analog=[[(1.0,)], [(2.0,)]]))
    assert recording.markers.shape == (2, 0, 3)
    assert_array_equal(recording.analog.values, [[1.0], [2.0]])


def test_where_header_and_parameters_disagree_one_is_taken_aloud(c3d_file):
    recording = read_c3d(c3d_file(points=frames(2, 3), header={2: 2}))
    assert recording.n_markers == 3
    assert "POINT:USED of 3, which is taken" in warnings_of(recording)


@pytest.mark.parametrize("said", [0.0, -50.0, 1e9, float("nan")])
def test_the_frame_rate_of_the_header_stands_in(c3d_file, said):
    recording = read_c3d(c3d_file(groups={"POINT": {"RATE": [said]}}))
    assert recording.rate == 100.0
    assert "the header's 100 Hz is taken" in warnings_of(recording)


@pytest.mark.parametrize(
    ("different", "message"),
    [
        ({"rate": 0.0}, "the frame rate is 0.0 Hz .* must be positive"),
        ({"points": [], "last": 0}, r"no frames \(first is 1, last 0\)"),
        ({"points": [[]], "labels": []}, "neither points nor analog channels"),
        ({"last": 5}, "cut short: 5 frames of 2 points declared, 1 present"),
        ({"header": {2: 60000}, "groups": {"POINT": {"USED": None}}}, "60000 points declared, 0"),
        ({"header": {3: 7, 10: 3}}, "7 analog values a frame in 3 samples"),
        ({"header": {3: 7, 10: 0}}, "7 analog values a frame in 0 samples"),
        ({"header": {9: 9999}}, "the data should start at block 9999"),
        ({"groups": {"POINT": {"SCALE": [0.0]}}}, "POINT:SCALE is 0.0"),
        ({"groups": {"POINT": {"SCALE": [float("nan")]}}}, "POINT:SCALE is nan"),
    ],
)  # fmt: skip
def test_what_cannot_be_is_named(c3d_file, different, message):
    path = c3d_file(**{"padded": False, **different})
    with pytest.raises(UnreadableFile, match=message) as caught:
        read_c3d(path)
    assert str(path) in str(caught.value)
    assert "\n" not in str(caught.value)
