"""The page: whole, offline, and what it shows is what was found."""

import base64
import hashlib
import json
import re
from dataclasses import replace
from html.parser import HTMLParser

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal
from scipy.spatial.transform import Rotation

from kinesphere.data import Step
from kinesphere.data.isb import isb_angles
from kinesphere.report import report_html
from kinesphere.report.moments import runs
from kinesphere.report.packing import unpack
from kinesphere.report.scene import (
    MAX_FRAMES,
    SCREEN_RATE,
    frame_stride,
    scene_from_solution,
)

HOSTILE = "</script><script>alert(1)</script>"
MILLIMETRE = 1e-3
HUNDREDTH_DEGREE = 0.02  # deg; quaternions are rounded to 1e-4, that is 0.01° a component


class Page(HTMLParser):
    """Elements with their attributes and text, as a browser takes the page apart."""

    def __init__(self, html):
        super().__init__()
        self.elements, self.open, self.texts = [], [], []
        self.feed(html)
        self.close()

    def handle_starttag(self, tag, attrs):
        self.elements.append([tag, dict(attrs), ""])
        self.open.append(self.elements[-1])

    def handle_endtag(self, tag):
        while self.open and self.open.pop()[0] != tag:
            pass

    def handle_data(self, data):
        self.texts.append(data)
        if self.open:
            self.open[-1][2] += data

    def all(self, tag):
        return [element for element in self.elements if element[0] == tag]


@pytest.fixture(scope="module")
def html(solution):
    return report_html(solution, "Trial <1> & more")


@pytest.fixture(scope="module")
def scene(html):
    (data,) = [e for e in Page(html).all("script") if e[1].get("type") == "application/json"]
    return json.loads(data[2])


def shown(scene, name):
    return unpack(scene["arrays"][name])


def test_the_page_needs_nothing_from_elsewhere(html):
    page = Page(html)
    for _, attributes, _ in page.elements:
        assert not {"src", "href", "action", "srcset", "data"} & {*attributes}
    assert "url(" not in html
    assert "@import" not in html
    assert not re.search(r"\b(fetch|XMLHttpRequest|WebSocket|import\()", html)


def test_only_the_pages_own_script_may_run(html):
    page = Page(html)
    (policy,) = [e[1]["content"] for e in page.all("meta") if "http-equiv" in e[1]]
    (script,) = [e[2] for e in page.all("script") if "type" not in e[1]]
    digest = base64.b64encode(hashlib.sha256(script.encode()).digest()).decode()
    assert f"script-src 'sha256-{digest}'" in policy
    assert "default-src 'none'" in policy
    assert not [e for e in page.elements if any(name.startswith("on") for name in e[1])]


def test_labels_and_warnings_stay_text(html, scene, solution):
    page = Page(html)
    assert len(page.all("script")) == 2
    assert page.all("img") == []
    assert HOSTILE in solution.recording.labels
    labels = [marker["label"] for marker in scene["markers"]]
    assert labels[:2] == list(solution.recording.labels[:2])
    data = html.split('id="scene">')[1].split("</script>")[0]
    assert not {"<", ">", "&"} & {*data}  # browsers end a script at less than Python's parser does
    assert any(f"label {HOSTILE}" in text for text in page.texts)
    assert page.all("h1")[0][2] == "Trial <1> & more"


def test_positions_are_the_solutions(scene, solution):
    step = scene["stride"]
    columns = np.flatnonzero(solution.recording.seen.any(axis=0))
    assert [m["label"] for m in scene["markers"]] == [solution.recording.labels[c] for c in columns]
    markers = solution.recording.markers[::step][:, columns]
    assert_array_equal(np.isnan(shown(scene, "markers")), np.isnan(markers))
    assert_allclose(shown(scene, "markers"), markers, atol=MILLIMETRE)
    assert_allclose(shown(scene, "origins"), solution.motion.origins[::step], atol=MILLIMETRE)


def test_orientations_are_the_solutions_and_never_jump_in_sign(scene, solution):
    quaternions = shown(scene, "quaternions")
    rotations = solution.motion.rotations[:: scene["stride"]]
    known = np.isfinite(rotations).all(axis=(2, 3))
    assert_array_equal(np.isfinite(quaternions).all(axis=2), known)
    back = Rotation.from_quat(quaternions[known])
    off = (back * Rotation.from_matrix(rotations[known]).inv()).magnitude()
    assert np.rad2deg(off.max()) < HUNDREDTH_DEGREE
    together = np.einsum("fli,fli->fl", quaternions[1:], quaternions[:-1])
    assert np.nanmin(together) > 0


def test_curves_are_the_solutions(scene, solution):
    parameters, step = solution.parameters, scene["stride"]
    assert_allclose(shown(scene, "angles"), np.rad2deg(parameters.angles[::step]), atol=0.0051)
    assert_allclose(shown(scene, "twists"), np.rad2deg(parameters.twists[::step]), atol=0.0051)
    residuals = parameters.residuals[::step] * 1e3
    assert_allclose(shown(scene, "joint_residuals"), residuals, atol=0.0051)
    residuals = solution.motion.residuals[::step] * 1e3
    assert_allclose(shown(scene, "limb_residuals"), residuals, atol=0.0051)


def test_flags_and_movement_are_stretches_of_time(scene, solution):
    assert scene["flags"][3] == {"unseen": [[20, 30]], "singular": [[50, 52]]}
    assert scene["flags"][2] == {}
    for j, stretches in enumerate(scene["moving"]):
        mask = np.zeros(scene["n_frames"], dtype=bool)
        for first, end in stretches:
            mask[first:end] = True
        assert_array_equal(mask, solution.parameters.moving[:, j])


def test_movements_that_axes_were_found_from_are_stretches_of_time(solution):
    knee, other = (j for j in solution.skeleton.joints[:2])
    phases = {knee.name: {"phases_s": [[0.5, 1.25], [2.0, 3.0]]}, other.name: {"phases_s": []}}
    step = Step("parameterization", findings={"joints": phases})
    sources = {knee.name: "movement", other.name: "body"}
    joints = tuple(
        replace(joint, axes_source=sources.get(joint.name, "body"))
        for joint in solution.skeleton.joints
    )
    told = replace(
        solution.parameters,
        skeleton=replace(solution.skeleton, joints=joints),
        history=(*solution.history, step),
    )
    shown = scene_from_solution(replace(solution, parameters=told))["measured_s"]
    assert shown[:2] == [[[0.5, 1.25], [2.0, 3.0]], []]
    assert scene_from_solution(solution)["measured_s"] == [[] for _ in solution.skeleton.joints]


def test_a_joint_sits_where_parent_and_child_have_it(scene, solution):
    for drawn, joint in zip(scene["joints"], solution.skeleton.joints, strict=True):
        assert scene["limbs"][drawn["parent"]]["name"] == joint.parent
        assert_allclose(drawn["centre"], joint.centre_in_parent, atol=1e-6)
        assert_allclose(drawn["axes"], joint.axes, atol=1e-6)


def test_every_joint_has_a_chart_and_a_row(html, solution):
    page = Page(html)
    charts = [e[1]["data-joint"] for e in page.all("article")]
    assert sorted(map(int, charts)) == list(range(len(solution.skeleton.joints)))
    rows = [e for e in page.all("th") if e[1].get("scope") == "row"]
    clinical = isb_angles(solution.motion, solution.skeleton).joints
    assert len(rows) == len(solution.skeleton.joints) + len(solution.skeleton.limbs) + len(clinical)


def test_left_stands_beside_right(html):
    names = re.findall(r'data-joint="\d+">\s*<h3><i[^>]*></i>([^<\n]+)', html)
    assert names[0] == "neck"
    for left, right in zip(names[1::2], names[2::2], strict=True):
        assert right == left.replace("left", "right")
        assert left.startswith("left")


def test_warnings_are_said_once(html):
    warnings = html.split('<details class="warnings"')[1].split("</details>")[0]
    assert warnings.split("<ul>")[1].count("a warning twice") == 1
    assert "2 things to know" in warnings


def test_settings_and_versions_are_there(html):
    assert "9.9.9" in html
    assert "<code>outlier_mm</code>" in html
    assert "<code>nested.deep</code></dt><dd>yes" in html


def test_a_page_without_warnings_has_no_box(solution):
    quiet = replace(solution, parameters=replace(solution.parameters, history=()))
    assert 'class="warnings"' not in report_html(quiet)


def test_a_fast_recording_is_thinned_aloud(solution):
    fast = replace(
        solution,
        motion=replace(solution.motion, rate=240.0),
        parameters=replace(solution.parameters, rate=240.0),
    )
    html = report_html(fast)
    assert "Every 4th frame is shown (60 Hz)" in html
    assert "is shown (" not in report_html(solution)


@pytest.mark.parametrize(
    ("n_frames", "rate", "stride"),
    [
        (10, 12.0, 1),
        (600, 59.94, 1),
        (600, 100.0, 1),
        (600, 119.88, 1),
        (600, 120.0, 2),
        (600, 239.76, 3),
        (24_000, 50.0, 1),
        (24_001, 50.0, 2),
        (100_000, 120.0, 5),
    ],
)
def test_stride(n_frames, rate, stride):
    assert frame_stride(n_frames, rate) == stride
    assert n_frames / stride <= MAX_FRAMES
    assert stride == 1 or rate / stride >= SCREEN_RATE / 2 or n_frames > MAX_FRAMES


def test_runs():
    assert runs(np.array([], dtype=bool)) == []
    assert runs(np.array([True, False, True, True])) == [[0, 1], [2, 4]]
    assert runs(np.zeros(4, dtype=bool)) == []


def test_scripts_hold_no_markup_that_could_end_them(html):
    (script,) = [e[2] for e in Page(html).all("script") if "type" not in e[1]]
    assert script.rstrip().endswith("});")
    assert "<!--" not in script


def test_a_minute_stays_small(solution, rng):
    """Tile the solution to 3600 frames with noise in every marker: the worst case for packing."""
    at = np.arange(3600) % solution.motion.n_frames
    motion, parameters, recording = solution.motion, solution.parameters, solution.recording
    noisy = recording.markers[at]
    noisy += rng.normal(scale=1e-3, size=noisy.shape)
    long = replace(
        solution,
        recording=replace(
            recording,
            markers=noisy,
            rate=60.0,
            analog=None,
        ),
        motion=replace(
            motion,
            rotations=motion.rotations[at],
            origins=motion.origins[at],
            residuals=motion.residuals[at],
            flags=motion.flags[at],
            rate=60.0,
        ),
        parameters=replace(
            parameters,
            root_positions=parameters.root_positions[at],
            root_rotations=parameters.root_rotations[at],
            angles=parameters.angles[at],
            twists=parameters.twists[at],
            residuals=parameters.residuals[at],
            flags=parameters.flags[at],
            moving=parameters.moving[at],
            rate=60.0,
        ),
    )
    assert len(report_html(long)) < 5e6
