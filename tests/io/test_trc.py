"""read_trc and write_trc: every spelling of a gap, every way a file can be damaged."""

import re
import warnings
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.testing import assert_allclose, assert_array_equal

from kinesphere.data import Recording
from kinesphere.errors import BadSetting, KinesphereError, UnreadableFile
from kinesphere.io import read, read_trc, write, write_trc

PRINTED = 5.1e-10  # m; six decimals of a millimetre, rounded

HEAD = (
    "PathFileType\t4\t(X/Y/Z)\ta.trc\n"
    "DataRate\tCameraRate\tNumFrames\tNumMarkers\tUnits\tOrigDataRate\tOrigDataStartFrame\tOrigNumFrames\n"
    "50.00\t50.00\t4\t2\tmm\t50.00\t1\t4\n"
    "Frame#\tTime\tC7\t\t\tleft heel\t\t\n"
    "\t\tX1\tY1\tZ1\tX2\tY2\tZ2\n"
)
ROWS = (
    "1\t0.00\t1000\t2000\t3000\t4\t5\t6\n"
    "2\t0.02\t1001\t2001\t3001\t5\t6\t7\n"
    "3\t0.04\t1002\t2002\t3002\t6\t7\t8\n"
    "4\t0.06\t1003\t2003\t3003\t7\t8\t9\n"
)
PLAIN = HEAD + ROWS


@pytest.fixture
def read_text(tmp_path):
    """Return a function that reads TRC from a text or bytes."""

    def read_it(content):
        path = tmp_path / "a.trc"
        path.write_bytes(content.encode() if isinstance(content, str) else content)
        return read_trc(path)

    return read_it


def warnings_of(recording):
    return " | ".join(recording.history[-1].warnings)


def test_a_plain_file(read_text):
    recording = read_text(PLAIN)
    assert recording.labels == ("C7", "left heel")
    assert recording.rate == 50.0
    assert recording.first_frame == 1
    assert recording.up is None
    assert_allclose(recording.markers[2], [[1.002, 2.002, 3.002], [0.006, 0.007, 0.008]])
    step = recording.history[-1]
    assert step.name == "read"
    assert step.findings["unit"] == "mm"
    assert step.findings["n_frames"] == 4
    assert not step.warnings


@pytest.mark.parametrize(
    "gap",
    [
        "\t\t",
        " \t  \t ",
        "NaN\tNaN\tNaN",
        "nan\tNAN\tnAn",
        "  NaN\t       NaN\t NaN ",
        "-nan\tnan\tnan",
        "\tNaN\t",
    ],
)
def test_spellings_of_a_gap(read_text, gap):
    recording = read_text(PLAIN.replace("1001\t2001\t3001", gap))
    assert_array_equal(recording.seen, [[1, 1], [0, 1], [1, 1], [1, 1]])
    assert np.isnan(recording.markers[1, 0]).all()
    assert not warnings_of(recording)


@pytest.mark.parametrize("row_end", ["\t\t\t", "\t\t", "", "\t", " \t"])
def test_cells_missing_at_the_end_of_a_row(read_text, row_end):
    recording = read_text(PLAIN.replace("2001\t3001\t5\t6\t7\n", f"2001\t3001{row_end}\n"))
    assert_array_equal(recording.seen, [[1, 1], [1, 0], [1, 1], [1, 1]])
    assert recording.markers[1, 0, 2] == pytest.approx(3.001)


def test_half_a_point_is_not_seen_and_said(read_text):
    recording = read_text(PLAIN.replace("1001\t2001\t3001", "1001\t\t3001"))
    assert np.isnan(recording.markers[1, 0]).all()
    assert "1 points had only some" in warnings_of(recording)


@pytest.mark.parametrize(
    "change",
    [
        lambda text: text.replace("\n", "\r\n"),
        lambda text: text.replace("\n", "\r"),
        lambda text: text.replace("\n1\t", "\n\n1\t"),
        lambda text: text.replace("\n1\t", "\n\t\t\t\t\t\t\t\n1\t"),
        lambda text: text.replace("\n", "\t\t\n"),
        lambda text: text.replace("\n", "\t" * 9 + "\n"),
        lambda text: text + "\n\n",
        lambda text: text[:-1],
        lambda text: text.replace("\t\tX1\tY1\tZ1\tX2\tY2\tZ2\n", ""),
        lambda text: "\ufeff" + text,
        lambda text: text.replace("1000\t2000\t3000", "1e3\t+2.00E+03\t  3000.0 "),
        lambda text: text.replace("\t4\t2\tmm", "\t4\t       2\tMM "),
        lambda text: text.replace("mm", "Millimeters"),
        lambda text: text.replace("\t4\t2\tmm", "\t4.0\t2.0\tmm"),
        lambda text: text.replace("left heel\t\t\n", "left heel\n"),
    ],
    ids=[
        *("CRLF", "CR", "blank line", "line of tabs", "trailing tabs", "many tabs", "blank end"),
        *("no last line end", "no XYZ line", "BOM", "E format", "padded", "unit in words"),
        *("counts as floats", "bare labels"),
    ],
)
def test_dialects_say_the_same(read_text, change):
    plain, dialect = read_text(PLAIN), read_text(change(PLAIN))
    assert dialect.labels == plain.labels
    assert_array_equal(dialect.markers, plain.markers)
    assert dialect.rate == plain.rate
    assert not warnings_of(dialect)


def test_runs_of_blanks_between_the_cells(read_text):
    recording = read_text(
        PLAIN.replace("\t\t\n", "\n").replace("\t\t\t", "\t").replace("\t", "   ")
    )
    assert recording.labels == ("C7", "left heel")
    assert_array_equal(recording.markers, read_text(PLAIN).markers)
    single = PLAIN.replace("left heel", "LHEE").replace("\t", " ")
    assert read_text(single).labels == ("C7", "LHEE")
    assert_array_equal(read_text(single).markers, recording.markers)


def test_blanks_cannot_show_a_gap(read_text):
    text = PLAIN.replace("left heel", "LHEE").replace("1001\t2001\t3001\t", "").replace("\t", " ")
    with pytest.raises(
        UnreadableFile, match=r"line 7 has 5 cells, the header names 8 columns; gaps"
    ):
        read_text(text)
    assert read_text(PLAIN.replace("1001\t2001\t3001", "NaN\tNaN\tNaN")).seen.sum() == 7


@pytest.mark.parametrize(
    ("unit", "metres"),
    [("mm", 0.001), ("m", 1), ("cm", 0.01), ("in", 0.0254), ("meters", 1), ("Inches", 0.0254)],
)
def test_units(read_text, unit, metres):
    recording = read_text(PLAIN.replace("mm", unit).replace("000", "0").replace("00", "0"))
    assert recording.markers[0, 1, 0] == pytest.approx(4 * metres)


@pytest.mark.parametrize("unit", ["", "furlongs"])
def test_an_unknown_unit_is_guessed_aloud(read_text, unit):
    recording = read_text(PLAIN.replace("mm", unit))
    assert recording.markers[0, 0, 0] == pytest.approx(1.0)
    assert "mm is guessed" in warnings_of(recording)


def test_frames_need_not_start_at_one(read_text):
    rows = ROWS
    for n in (4, 3, 2, 1):
        rows = rows.replace(f"{n}\t0.0", f"{n + 140}\t0.0")
    recording = read_text(HEAD + rows)
    assert recording.first_frame == 141
    assert recording.n_frames == 4


def test_a_wrong_count_of_frames_is_said(read_text):
    recording = read_text(PLAIN.replace("50.00\t4\t2", "50.00\t9\t2"))
    assert recording.n_frames == 4
    assert "says 9 frames, there are 4" in warnings_of(recording)


def test_missing_rows_are_frames_not_seen(read_text):
    recording = read_text(PLAIN.replace("3\t0.04\t1002\t2002\t3002\t6\t7\t8\n", ""))
    assert_array_equal(recording.seen.all(axis=1), [True, True, False, True])
    assert recording.rate == 50.0
    assert recording.markers[3, 1, 2] == pytest.approx(0.009)
    assert "1 frames are missing" in warnings_of(recording)


def test_missing_rows_do_not_slow_the_clock(read_text):
    text = PLAIN.replace("50.00", "0").replace("3\t0.04\t1002\t2002\t3002\t6\t7\t8\n", "")
    assert read_text(text).rate == 50.0


def test_decimated_frames_count_in_steps(read_text):
    rows = "".join(f"{n}\t{n / 1200:.5f}\t1\t2\t3\t4\t5\t6\n" for n in (11, 21, 31, 41))
    recording = read_text(HEAD + rows)
    assert recording.n_frames == 4
    assert recording.rate == pytest.approx(120.0)
    assert "the time column counts" in warnings_of(recording)


@pytest.mark.parametrize(("clock", "rate"), [(50.3, 50.0), (51.5, 51.5)])
def test_a_clock_that_is_a_little_off_is_no_other_rate(read_text, clock, rate):
    rows = "".join(f"{n}\t{(n - 1) / clock:.6f}\t1\t2\t3\t4\t5\t6\n" for n in range(1, 502))
    recording = read_text(HEAD + rows)
    assert recording.rate == pytest.approx(rate)
    assert ("the time column counts" in warnings_of(recording)) == (rate != 50.0)


@pytest.mark.parametrize("told", ["", "0", "n/a", "-50", "nan", "inf"])
def test_the_time_column_gives_the_rate_the_header_lacks(read_text, told):
    recording = read_text(PLAIN.replace("50.00\t50.00\t4", f"{told}\t50.00\t4"))
    assert recording.rate == pytest.approx(50.0)
    assert "time column" in warnings_of(recording)


def test_times_of_three_decimals_do_not_contradict_the_header(read_text):
    text = PLAIN.replace("50.00", "119.88")
    for i, t in enumerate(("0.00", "0.02", "0.04", "0.06")):
        text = text.replace(f"\t{t}\t", f"\t{i / 119.88:.3f}\t")
    assert read_text(text).rate == 119.88
    assert not warnings_of(read_text(text))


def test_an_uneven_time_column_is_said(read_text):
    assert "uneven" in warnings_of(read_text(PLAIN.replace("0.02", "0.039")))


@pytest.mark.parametrize(
    ("change", "said"),
    [
        (
            lambda t: t.replace("\t4\t2\tmm", "\t4\t3\tmm"),
            "line 4 holds 2 labels, .* says 3 markers",
        ),
        (
            lambda t: t.replace("\t4\t2\tmm", "\t4\t1\tmm"),
            "line 4 holds 2 labels, .* says 1 markers",
        ),
        (
            lambda t: t.replace("\t4\t2\tmm", "\t4\t1e999\tmm"),
            "line 3 gives '1e999' for NumMarkers",
        ),
        (lambda t: t.replace("\t4\t2\tmm", "\t4\t\tmm"), "line 3 gives '' for NumMarkers"),
        (lambda t: t.replace("NumMarkers", "Number"), "name no NumMarkers"),
        (lambda t: t.replace("left heel", "C7"), "line 4 names C7 more than once"),
        (lambda t: t.replace("Frame#", "Foo#"), "line 4 starts with 'Foo#"),
        (lambda t: t.replace("PathFileType", "Path"), "line 1 starts with 'Path"),
        (lambda t: t.replace("2001", "20o1"), "line 7 holds '20o1' where a number"),
        (lambda t: t.replace("2001", "1e999"), "line 7 holds an infinite number"),
        (lambda t: t.replace("\t5\t6\t7\n", "\t5\t6\t7\t8\n"), "line 7 has 9 cells, .* 8 columns"),
        (lambda t: t.replace("2\t0.02", "1.5\t0.02"), "line 7 does not start with a frame"),
        (lambda t: t.replace("2\t0.02", "\t0.02"), "line 7 does not start with a frame"),
        (lambda t: t.replace("3\t0.04", "2\t0.04"), "line 8 is frame 2 after frame 2"),
        (
            lambda t: t.replace("4\t0.06", "999999999\t0.06"),
            "jump unevenly between 1 and 999999999",
        ),
        (lambda t: t[: t.index("0.04") + 9], "line 8 has 3 cells, .* breaks off there"),
        (lambda _: HEAD, "no frames after the header"),
        (
            lambda t: re.sub(r"0\.0\d\t", "7\t", t.replace("50.00", "0")),
            "line 3 gives '0' for DataRate",
        ),
        (lambda t: t.replace("2001", "20\x0001"), "line 7 holds binary data"),
        (lambda _: "", "empty"),
        (lambda _: "\n \n", "blanks"),
    ],
)
def test_damage_is_named_with_its_line(read_text, change, said):
    with pytest.raises(UnreadableFile, match=said):
        read_text(change(PLAIN))


@pytest.mark.parametrize("n_lines", [1, 2, 3, 4])
def test_a_header_cut_short(read_text, n_lines):
    text = "".join(PLAIN.splitlines(keepends=True)[:n_lines])
    with pytest.raises(UnreadableFile, match=r"breaks off|no frames"):
        read_text(text)


def test_no_file_and_a_folder(tmp_path):
    with pytest.raises(UnreadableFile, match="no such file"):
        read_trc(tmp_path / "none.trc")
    with pytest.raises(UnreadableFile, match="folder"):
        read_trc(tmp_path)


def test_a_file_that_is_no_utf8_is_latin_1(read_text):
    recording = read_text(PLAIN.replace("left heel", "Fuß").encode("latin-1"))
    assert recording.labels == ("C7", "Fuß")


@given(at=st.integers(0, len(PLAIN) - 1), byte=st.integers(0, 255), cut=st.booleans())
@settings(deadline=None, max_examples=200)
def test_damaged_anywhere_it_reads_or_says_why(tmp_path_factory, at, byte, cut):
    content = bytearray(PLAIN.encode())
    content[at] = byte
    path = tmp_path_factory.getbasetemp() / "damaged.trc"
    path.write_bytes(bytes(content[: at + 1] if cut else content))
    said, n_frames = "", 1
    try:
        n_frames = read_trc(path).n_frames
    except KinesphereError as error:
        said = str(error)
    assert "\n" not in said
    assert 1 <= n_frames <= 44  # no more than ten missing for each that is there


@pytest.fixture
def recording(rng):
    markers = rng.normal(scale=2.0, size=(17, 5, 3))
    markers[rng.random((17, 5)) < 0.3] = np.nan
    markers[4] = np.nan
    return Recording(markers, ("A", "b 2", "ç", "D:x", "E"), 119.88012, first_frame=77)


@pytest.mark.parametrize("unit", ["mm", "m", "cm", "in"])
def test_written_and_read_again(recording, tmp_path, unit):
    write_trc(recording, tmp_path / "a.trc", unit=unit)
    again = read_trc(tmp_path / "a.trc")
    assert again.labels == recording.labels
    assert again.rate == recording.rate
    assert again.first_frame == 77
    assert not warnings_of(again)
    assert_array_equal(again.seen, recording.seen)
    assert_allclose(again.markers, recording.markers, atol=PRINTED, rtol=0)
    assert again.details["trc"]["unit"] == unit
    # what was printed once is printed the same again
    write_trc(again, tmp_path / "b.trc", unit=unit)
    first, second = (
        (tmp_path / f"{x}.trc").read_text(encoding="utf-8").split("\n")[1:] for x in "ab"
    )
    assert first == second


def test_opensim_reads_what_is_written(recording, tmp_path):
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # its bindings are SWIG's
        osim = pytest.importorskip("opensim")
    named = replace(recording, labels=("A", "B", "C", "D", "E"))
    write_trc(named, tmp_path / "a.trc", unit="m")
    table = osim.TimeSeriesTableVec3(str(tmp_path / "a.trc"))
    assert tuple(table.getColumnLabels()) == named.labels
    columns = [table.getDependentColumn(label) for label in named.labels]
    values = [[[c[f][k] for k in range(3)] for c in columns] for f in range(named.n_frames)]
    assert_allclose(values, recording.markers, atol=PRINTED, rtol=0)


def test_the_registry_knows_it_by_content(recording, tmp_path):
    write(recording, tmp_path / "a.trc")
    (tmp_path / "a.trc").rename(tmp_path / "a.txt")
    assert_allclose(read(tmp_path / "a.txt").markers, recording.markers, atol=PRINTED, rtol=0)


def test_the_axes_of_the_file_come_back(recording, tmp_path):
    world_from_file = np.array([[0.0, 1, 0], [0, 0, 1], [1, 0, 0]])
    turned = replace(
        recording, markers=recording.markers @ world_from_file.T, world_from_file=world_from_file
    )
    write_trc(turned, tmp_path / "a.trc")
    again = read_trc(tmp_path / "a.trc")
    assert_allclose(again.markers, recording.markers, atol=PRINTED, rtol=0)


def test_the_first_time_comes_back(read_text, tmp_path):
    late = read_text(PLAIN.replace("0.0", "7.0"))
    write_trc(late, tmp_path / "b.trc")
    assert (
        (tmp_path / "b.trc")
        .read_text(encoding="utf-8")
        .splitlines()[6]
        .startswith("1\t7.000000000\t")
    )


def test_an_unknown_unit_to_write_in(recording, tmp_path):
    with pytest.raises(BadSetting, match="parsec"):
        write_trc(recording, tmp_path / "a.trc", unit="parsec")
