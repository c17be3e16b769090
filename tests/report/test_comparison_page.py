"""The page of a comparison: whole without scripts, its curves are the data, its names are text."""

import re
from dataclasses import replace

import numpy as np
import pytest

from kinesphere.comparison import compare
from kinesphere.report import comparison_html
from kinesphere.report.plots import MOST_POINTS, Curve, curves, dots
from kinesphere.synthetic import make_performance

EVIL = "<script>alert(1)</script>"


@pytest.fixture(scope="module")
def found():
    parameters = make_performance(
        np.random.default_rng(5), rate=20.0, calibration_s=20.0, free_s=5.0
    ).parameters
    angles = np.array(parameters.angles)
    angles[50:80, 3] = np.nan
    return compare(parameters, replace(parameters, angles=angles))


@pytest.fixture(scope="module")
def html(found):
    return comparison_html(found, EVIL, "b & c", "left_elbow")


def test_every_angle_has_a_figure_and_a_row(html, found):
    assert html.count('<article class="figure"') == len(found.parameters)
    rows = html.split("<h2>Angles</h2>")[1].split("</tbody>")[0]
    assert rows.count("<tr>") == len(found.parameters) + 1


def test_names_of_files_stay_text_and_nothing_is_fetched(html):
    assert EVIL not in html
    assert "&lt;script&gt;alert(1)" in html
    assert html.count("<script>") == 1
    assert not re.search(r'(src|href)\s*=\s*"?https?:', html)
    assert "default-src 'none'" in html


def test_the_curve_of_a_figure_is_the_angle(html, found):
    elbow = found.parameter("left_elbow", "bend")
    figure = html.split('data-joint="left_elbow" data-kind="bend"')[1].split("</article>")[0]
    points = re.findall(r'<polyline class="one" points="([^"]+)"', figure)
    drawn = np.array([[float(v) for v in p.split(",")] for p in " ".join(points).split()])
    stride = -(-len(found.times) // MOST_POINTS)
    expected = elbow.first[::stride]
    known = np.isfinite(expected)
    assert len(drawn) == known.sum()
    np.testing.assert_allclose(drawn[:, 0], found.times[::stride][known], atol=1e-3)
    np.testing.assert_allclose(-drawn[:, 1], np.rad2deg(expected[known]), atol=0.006)


def test_a_joint_that_is_not_there_is_no_page(found):
    with pytest.raises(KeyError):
        comparison_html(found, joint="tail")


def test_gaps_break_a_line_and_nothing_at_all_is_drawn_as_nothing():
    values = np.array([1.0, 2.0, np.nan, 4.0, np.nan, np.nan])
    plot = curves(np.arange(6.0), [Curve("one", values)])
    assert plot.svg.count("<polyline") == 2
    assert "nan" not in plot.svg
    empty = curves(np.arange(6.0), [Curve("one", np.full(6, np.nan))])
    assert "<polyline" not in empty.svg
    nothing = dots(np.full(4, np.nan), np.full(4, np.nan), (("bias", np.nan),))
    assert "nan" not in nothing.svg
    one = curves(np.array([0.0]), [Curve("one", np.array([3.0]))])
    assert "inf" not in one.svg


def test_ticks_are_round_and_inside():
    plot = curves(np.linspace(0, 7.3, 50), [Curve("one", np.linspace(-31, 88, 50))])
    for ticks in (plot.x, plot.y):
        assert 2 <= len(ticks) <= 7
        assert all(0 <= float(t.at.rstrip("%")) <= 100 for t in ticks)
    assert "0" in [t.text for t in plot.y]
