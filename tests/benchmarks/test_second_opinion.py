"""Opinions on real angles: read as they are written, compared as the page says, drawn with gaps."""

import xml.etree.ElementTree as ET

import numpy as np
import pytest
from benchmarks.markerless.curves import Panel, curves_svg
from benchmarks.markerless.second_opinion import Opinions, page, read_mot

MOT = """Coordinates
version=1
nRows=2
nColumns=3
inDegrees=yes

endheader
time\tknee_angle_r\telbow_flex_r
      0.0\t     10.5\t     -3.0
      0.1\t     11.5\t      4.0
"""


def test_motions_are_read_by_their_names(tmp_path):
    (tmp_path / "a.mot").write_text(MOT)
    found = read_mot(tmp_path / "a.mot")
    assert found["knee_angle_r"].tolist() == [10.5, 11.5]
    assert found["elbow_flex_r"].tolist() == [-3.0, 4.0]


def test_the_page_tells_a_constant_from_a_shape():
    t = np.linspace(0, 6, 50)
    wave = 40 + 20 * np.sin(t)
    (row,) = [
        line
        for line in page([Opinions("left_knee", wave + 5, wave, np.full(50, np.nan))]).splitlines()
        if line.startswith("| left knee")
    ]
    cells = [cell.strip() for cell in row.strip("|").split("|")]
    assert cells[1] == "25…65°"
    assert cells[3:6] == ["5.0°", "0.0°", "1.00"]
    assert cells[6:] == ["–", "–", "–"]


def test_curves_break_where_nobody_says():
    series = np.array([1.0, 2.0, np.nan, 4.0, 5.0])
    text = curves_svg([Panel("knee <1>", {"one": series, "two": series + 1})], "frame", "deg")
    root = ET.fromstring(text)
    paths = [p.get("d") for p in root.iter("{http://www.w3.org/2000/svg}path")]
    assert sum(d.count("M") == 2 and d.count("L") == 2 for d in paths) == 2
    assert "knee <1>" in [t.text for t in root.iter("{http://www.w3.org/2000/svg}text")]


def test_a_panel_that_keeps_still_can_be_drawn():
    still = np.full(4, 3.0)
    assert "nan" not in curves_svg([Panel("still", {"one": still})], "frame", "deg")
    assert page([Opinions("left_hip", still, still, still)]).count("0.0°") >= 2


@pytest.mark.parametrize("n", [1, 2, 5])
def test_any_number_of_panels_has_room(n):
    root = ET.fromstring(curves_svg([Panel("a", {"one": np.arange(3.0)})] * n, "x", "y"))
    height = float(root.get("height"))
    for group in root.iter("{http://www.w3.org/2000/svg}g"):
        top = float(group.get("transform").split()[1].rstrip(")"))
        assert top + 190 <= height
