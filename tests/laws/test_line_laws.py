"""Laws of the whole line: what must not matter to axes, rest and angles, does not."""

from dataclasses import dataclass, replace
from functools import cache

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal

from kinesphere.data import Recording, Solution, TopologicalModel
from kinesphere.io import read
from kinesphere.pipeline import solve
from kinesphere.synthetic import make_performance, spoil_with_gaps, spoil_with_noise

SAME = 1e-5  # rad; iterations stop where steps are small, from starts that differ by rounding
MIRROR = np.diag([1.0, 1.0, -1.0])
REAL = [
    "plugin-gait/pycgm_movement.c3d",
    "plugin-gait/PiG_Motion-FlatFoot-Full.c3d",
    "functional/Test_func_trunk.c3d",
]


@dataclass(frozen=True)
class Case:
    recording: Recording
    model: TopologicalModel | None
    solution: Solution


@cache
def synthetic() -> Case:
    """Return a person who never stands still for long, with noise and gaps."""
    it = make_performance(
        np.random.default_rng(5),
        layout="cmu41",
        rate=30.0,
        calibration_s=18.0,
        free_s=6.0,
        sway_deg=3.0,
    )
    rng = np.random.default_rng(6)
    spoilt = spoil_with_gaps(spoil_with_noise(it.recording, rng), rng, share=0.02)
    return Case(spoilt, it.model, solve(spoilt, it.model))


@pytest.fixture(
    scope="module", params=[None, *(pytest.param(f, marks=pytest.mark.real) for f in REAL)]
)
def case(request) -> Case:
    if request.param is None:
        return synthetic()
    found = read(request.getfixturevalue("recordings") / request.param)
    bare = replace(found, outputs=(), analog=None, events=(), details={})
    return Case(bare, None, solve(bare))


def assert_same(found: Solution, wanted: Solution, order=slice(None)):
    ours, theirs = found.parameters, wanted.parameters
    assert ours.skeleton.joint_names == theirs.skeleton.joint_names
    for joint, same in zip(theirs.skeleton.joints, ours.skeleton.joints, strict=True):
        assert same.axes_source == joint.axes_source
        assert_allclose(same.axes, joint.axes, atol=SAME)
        assert_allclose(same.rest, joint.rest, atol=SAME)
        assert_allclose(same.centre_in_child, joint.centre_in_child, atol=SAME)
    for now, then in ((ours.angles, theirs.angles), (ours.twists, theirs.twists)):
        now = now[order]
        assert_array_equal(np.isnan(now), np.isnan(then))
        # near a singular pose an angle may differ by more than the pose does
        off = np.abs(np.angle(np.exp(1j * (now - then))))
        assert np.nanquantile(off, 0.999) < 100 * SAME
        assert np.nanmedian(off) < SAME
    rotations = found.motion.rotations[order]
    assert_allclose(rotations, wanted.motion.rotations, atol=10 * SAME)
    told, same = (
        [
            step.findings.get("facing")
            for step in s.parameters.history
            if step.name == "normalization"
        ]
        for s in (wanted, found)
    )
    assert told[0]["decided_by"] == same[0]["decided_by"]


def test_the_direction_of_time_does_not_matter(case):
    back = slice(None, None, -1)
    residuals = case.recording.residuals
    reversed_ = replace(
        case.recording,
        markers=case.recording.markers[back],
        residuals=None if residuals is None else residuals[back],
    )
    assert_same(solve(reversed_, case.model), case.solution, back)


def test_the_order_of_markers_does_not_matter(case):
    order = np.random.default_rng(3).permutation(case.recording.n_markers)
    residuals = case.recording.residuals
    permuted = replace(
        case.recording,
        markers=case.recording.markers[:, order],
        labels=tuple(case.recording.labels[i] for i in order),
        residuals=None if residuals is None else residuals[:, order],
    )
    assert_same(solve(permuted, case.model), case.solution)


def test_a_mirrored_person_bends_the_other_side_alike(case):
    """Left is called right and the other way round: nothing else tells the image."""
    labels = case.recording.labels
    markers = case.recording.markers * [-1.0, 1.0, 1.0]
    image = solve(
        replace(case.recording, markers=markers, labels=tuple(swapped(n, labels) for n in labels)),
        case.model,
    )
    ours, theirs = image.parameters, case.solution.parameters
    for j, joint in enumerate(theirs.skeleton.joints):
        at = ours.skeleton.joint_names.index(other_side(joint.name))
        same = ours.skeleton.joints[at]
        assert same.axes_source == joint.axes_source
        assert_allclose(np.abs(same.axes), np.abs(joint.axes), atol=SAME)
        assert_allclose(same.rest, MIRROR @ joint.rest @ MIRROR, atol=SAME)
        off = np.abs(ours.angles[:, at]) - np.abs(theirs.angles[:, j])
        off = off[np.isfinite(off)]
        assert np.median(np.abs(off)) < SAME


def swapped(label: str, labels: tuple[str, ...]) -> str:
    """Return the label of the other side, where there is one."""
    person, colon, name = label.rpartition(":")
    other = person + colon + {"L": "R", "R": "L"}.get(name[:1], "") + name[1:]
    return other if other in labels else label


def other_side(name: str) -> str:
    for side, other in (("left_", "right_"), ("right_", "left_")):
        if name.startswith(side):
            return other + name.removeprefix(side)
    return name


@pytest.mark.parametrize("unit", ["m", "cm", "mm"])
def test_the_unit_of_the_file_does_not_matter(unit, tmp_path):
    wanted = synthetic()
    path = tmp_path / "walk.trc"
    path.write_text(trc_of(wanted.recording, unit), encoding="utf-8")
    assert_same(solve(read(path), wanted.model), wanted.solution)


def trc_of(recording: Recording, unit: str) -> str:
    """Return a recording as TRC in a unit, to the last digit."""
    each = {"m": 1.0, "cm": 100.0, "mm": 1000.0}[unit]
    n_frames, n = recording.n_frames, recording.n_markers
    rate = f"{recording.rate:g}"
    lines = [
        "PathFileType\t4\t(X/Y/Z)\twalk.trc",
        "DataRate\tCameraRate\tNumFrames\tNumMarkers\tUnits\tOrigDataRate"
        "\tOrigDataStartFrame\tOrigNumFrames",
        "\t".join([rate, rate, str(n_frames), str(n), unit, rate, "1", str(n_frames)]),
        "Frame#\tTime\t" + "\t\t\t".join(recording.labels),
        "\t\t" + "\t".join(f"{axis}{i + 1}" for i in range(n) for axis in "XYZ"),
        "",
    ]
    for f, frame in enumerate(recording.markers.reshape(n_frames, -1) * each):
        numbers = ("NaN" if np.isnan(v) else repr(float(v)) for v in frame)
        lines.append("\t".join([str(f + 1), repr(f / recording.rate), *numbers]))
    return "\n".join(lines) + "\n"
