"""The tables: every figure against one computed here."""

from dataclasses import replace

import numpy as np
import pytest

from kinesphere.data import JointFlag, PoseFlag, Step
from kinesphere.report.axes_words import axes_in_detail, origins_in_words
from kinesphere.report.joint_table import chart_order, joint_rows
from kinesphere.report.limb_table import limb_rows
from kinesphere.report.step_cards import step_cards
from kinesphere.report.tiles import tiles
from kinesphere.report.wording import millimetres


def with_joint(solution, index, **changes):
    """Return the solution with one joint changed."""
    joints = list(solution.skeleton.joints)
    joints[index] = replace(joints[index], **changes)
    skeleton = replace(solution.skeleton, joints=tuple(joints))
    return replace(solution, parameters=replace(solution.parameters, skeleton=skeleton))


@pytest.mark.parametrize(
    ("changes", "trust"),
    [
        ({"observability": "determined", "residual": 0.0149, "axes_source": "movement"}, "good"),
        ({"observability": "given", "residual": 0.001, "axes_source": "reused"}, "good"),
        ({"observability": "determined", "residual": 0.0151, "axes_source": "movement"}, "fair"),
        ({"observability": "hinge", "residual": 0.001, "axes_source": "movement"}, "fair"),
        ({"observability": "determined", "residual": 0.001, "axes_source": "body"}, "fair"),
        ({"observability": "determined", "residual": 0.0301, "axes_source": "movement"}, "poor"),
        ({"observability": "undetermined", "residual": 0.001, "axes_source": "movement"}, "poor"),
    ],
)
def test_trust_is_what_centre_and_axes_rest_on(solution, changes, trust):
    assert joint_rows(with_joint(solution, 3, **changes))[3].trust == trust


def test_a_joint_row_tells_the_figures(solution):
    changed = with_joint(
        solution,
        3,
        residual=0.01234,
        range_of_motion=np.deg2rad(56.7),
        axes_source="movement",
        axes_uncertainty=np.full(solution.skeleton.joints[3].n_axes, np.deg2rad(2.5)),
        note="a note",
    )
    row = joint_rows(changed)[3]
    joint = changed.skeleton.joints[3]
    assert (row.name, row.index, row.n_axes) == (joint.name.replace("_", " "), 3, joint.n_axes)
    assert (row.residual, row.range_of_motion, row.note) == ("12.3 mm", "56.7°", "a note")
    assert row.axes == f"{joint.n_axes} from movement, ± 2.5°"
    degrees = np.rad2deg(solution.parameters.angles[:, 3, 0])
    low, high = np.nanpercentile(degrees, [5, 95])
    assert row.angles[0] == f"{round(low)}° … {round(high)}°"
    assert row.angles[2] == "–"
    share = 10 / solution.parameters.n_frames
    assert f"unseen {share:.1%}" in row.flagged
    assert "singular" in row.flagged


def test_loose_axes_and_limbs_out_of_reach_are_trusted_less(solution):
    sure = {"observability": "determined", "residual": 0.001, "axes_source": "movement"}

    def trust(uncertainty, unreachable=0.0):
        told = with_joint(solution, 3, axes_uncertainty=np.deg2rad(uncertainty), **sure)
        flags = np.array(told.parameters.flags)
        flags[:, 3] = 0
        flags[: round(unreachable * len(flags)), 3] = JointFlag.UNREACHABLE
        return joint_rows(replace(told, parameters=replace(told.parameters, flags=flags)))[3].trust

    n = solution.skeleton.joints[3].n_axes
    assert trust([9.9] * n) == "good"
    assert trust([np.nan] * n) == "good"
    assert trust([2.0] * (n - 1) + [10.1]) == "fair"
    assert trust([2.0] * n, unreachable=0.3) == "fair"
    assert trust([2.0] * n, unreachable=0.02) == "good"


def test_each_axis_tells_how_well_it_is_determined():
    told = {
        "axes_uncertainty_deg": [1.44, 0.52],
        "ranges_deg": [88.0, 91.6],
        "conditioning": [29.02, 3.14],
    }
    unsure = {"axes_uncertainty_deg": [None, 2.0], "ranges_deg": [None, 40.2], "conditioning": []}
    body = {"axes_uncertainty_deg": [None], "ranges_deg": [3.0], "conditioning": [1.2]}
    joints = {"left_hip": told, "left_elbow": unsure, "neck": body}
    history = (Step("parameterization", {}, {"joints": joints}, (), "0"),)
    assert axes_in_detail("left_hip", history) == (
        "axis 1 ± 1.4°, over 88°, rotation 29 times larger than about others; "
        "axis 2 ± 0.5°, over 92°, rotation 3.14 times larger than about others"
    )
    assert axes_in_detail("left_elbow", history) == "axis 2 ± 2.0°, over 40°"
    assert axes_in_detail("neck", history) == axes_in_detail("nobody", ()) == ""


def test_limbs_are_measured_against_the_other_side(solution):
    rows = {row.name: row for row in limb_rows(solution)}
    lengths = {limb.name: limb.length for limb in solution.skeleton.limbs}
    left, right = lengths["left_thigh"], lengths["right_thigh"]
    share = (left - right) / ((left + right) / 2)
    assert rows["left thigh"].other_side == f"{share:+.1%}"
    assert rows["right thigh"].other_side == f"{-share:+.1%}"
    assert rows["head"].other_side == ""
    assert rows["left thigh"].length == f"{left * 1e3:.1f} mm"
    assert rows["left thigh"].markers == ", ".join(solution.skeleton.limb("left_thigh").markers)


def test_limbs_tell_how_often_they_were_seen(solution):
    row = limb_rows(solution)[4]
    unseen = (solution.motion.flags[:, 4] == PoseFlag.UNSEEN).mean()
    assert row.unseen == f"{unseen:.1%}"
    assert row.measured == f"{1 - unseen:.1%}"


def test_charts_stand_left_beside_right_whatever_the_order(solution):
    rows = joint_rows(solution)
    shuffled = [rows[i] for i in np.random.default_rng(2).permutation(len(rows))]
    ordered = chart_order(shuffled)
    assert sorted(row.index for row in ordered) == list(range(len(rows)))
    assert (ordered[0].name, ordered[0].side) == ("neck", "alone")
    for left, right in zip(ordered[1::2], ordered[2::2], strict=True):
        assert (left.side, right.side) == ("left", "right")
        assert left.name.removeprefix("left") == right.name.removeprefix("right")


def test_two_joints_of_the_middle_share_a_row(solution):
    rows = joint_rows(solution)
    lumbar = replace(rows[0], name="lumbar")
    assert [row.side for row in chart_order([lumbar, *rows])[:2]] == ["middle", "middle"]


def test_a_joint_without_its_other_side_keeps_its_chart(solution):
    rows = [row for row in joint_rows(solution) if row.name != "right knee"]
    assert sorted(r.index for r in chart_order(rows)) == sorted(r.index for r in rows)


def test_nested_findings_become_a_table(solution):
    step = solution.history[1]
    found = {"joints": {"left_knee": {"n_axes": 1, "list": [1]}, "neck": {"spread_deg": 2.0}}}
    history = (replace(step, findings={**found, "x_mm": 1.0}),)
    (card,) = step_cards(
        replace(solution, parameters=replace(solution.parameters, history=history))
    )
    assert card.findings == (("x", "1 mm"),)
    (table,) = card.tables
    assert table.header == ("n axes", "spread")
    assert table.rows == (("left knee", "1", "–"), ("neck", "–", "2°"))


def test_steps_tell_time_settings_and_version(solution):
    read, skeleton = step_cards(solution)
    assert (read.seconds, skeleton.seconds) == ("", "1.5 s")
    assert skeleton.settings == (("outlier_mm", "3"), ("nested.deep", "yes"))
    assert skeleton.version == "9.9.9"


def test_tiles_sum_up(solution):
    by_name = {tile.name: tile for tile in tiles(solution)}
    motion = solution.motion
    assert by_name["Recording"].aside == f"{motion.n_frames:,} frames at {motion.rate:g} Hz"
    assert by_name["Skeleton"].value == "12 limbs"
    assert by_name["Seen"].value == f"{motion.seen.mean():.1%}"
    residual = np.sqrt(np.nanmean(motion.residuals**2)) * 1e3
    value, unit = by_name["Limb fit"].value.split()
    assert (float(value), unit) == (pytest.approx(residual, rel=0.005), "mm")  # three figures


def test_a_joint_that_cannot_come_apart_has_no_residual_and_no_part_in_the_median(solution):
    told = [joint.residual for i, joint in enumerate(solution.skeleton.joints) if i != 3]
    changed = with_joint(solution, 3, residual=float("nan"))
    assert joint_rows(changed)[3].residual == "–"
    tile = {tile.name: tile for tile in tiles(changed)}["Joint centres"]
    assert tile.value == millimetres(float(np.median(told)))
    assert tile.aside.startswith(f"median residual of {len(told)}; ")


def test_axes_of_several_origins_are_told_one_by_one():
    assert origins_in_words(("body", "body"), ()) == "2 from body"
    assert origins_in_words(("reused",), ("knee",)) == "1 reused from knee"
    assert origins_in_words(("body", "movement"), ()) == "axis 1 from body, axis 2 from movement"
    assert origins_in_words(("reused", "movement"), ("hip", None)) == (
        "axis 1 reused from hip, axis 2 from movement"
    )
    assert origins_in_words((), ()) == ""
