"""The section on bodies from motion alone: only there, complete, and safe with hostile labels."""

from dataclasses import replace

import pytest

from kinesphere.data import Step
from kinesphere.report import report_html
from kinesphere.report.bodies import colour_of, find_bodies, marker_colours


@pytest.fixture(scope="module")
def found_alone(solution):
    """Return the solution as if its bodies had come from motion alone."""
    skeleton = solution.skeleton
    bodies = {
        limb.name: {"markers": ", ".join(limb.markers), "within_mm": 1.25, "confidence": 0.9}
        for limb in skeleton.limbs
    }
    joints = {
        joint.name: {
            "parent": joint.parent,
            "child": joint.child,
            "cost_mm": 3.0,
            "next_best_mm": None if i else 3.1,
            "confidence": 1.0 if i else 0.03,
            "doubtful": i in (0, 2),
            "n_axes": 2,
        }
        for i, joint in enumerate(skeleton.joints)
    }
    label = skeleton.limbs[1].markers[0]
    step = Step(
        "discovery",
        findings={
            "bodies_found": len(bodies),
            "count_confidence": 0.8,
            "trees": 2,
            "names_confidence": None,
            "bodies": bodies,
            "joints_found": joints,
            "marker_confidence": {label: 0.4},
            "at_joints": {label: skeleton.limb_names[0]},
            "loose": ["<i>strap</i>"],
            "ghosts": [],
            "other_trees": [["Ben:LFHD", "Ben:RFHD"]],
            "merge_curve_mm": {str(k): 30.0 / k for k in range(1, 20)},
        },
    )
    history = (*solution.parameters.history, step)
    return replace(solution, parameters=replace(solution.parameters, history=history))


def test_with_a_model_there_is_no_such_section(solution):
    assert find_bodies(solution) is None
    assert marker_colours(solution) == {}
    assert 'id="bodies"' not in report_html(solution)


def test_every_body_is_drawn_and_every_joint_a_line(found_alone):
    bodies = find_bodies(found_alone)
    skeleton = found_alone.skeleton
    assert [node.name for node in bodies.nodes] != []
    assert len(bodies.nodes) == len(skeleton.limbs)
    assert len({(node.x, node.y) for node in bodies.nodes}) == len(bodies.nodes)
    assert len(bodies.lines) == len(skeleton.joints)
    assert [i for i, line in enumerate(bodies.lines) if line.doubtful] == [0, 2]
    told = [line.confidence for line in bodies.lines]
    assert told[:4] == ["0.03", "1.00", "?", "1.00"]  # sure only of not having another
    assert all(0 < node.x < bodies.width and 0 < node.y < bodies.height for node in bodies.nodes)


def test_children_lie_below_their_parents(found_alone):
    assert all(line.y2 > line.y1 for line in find_bodies(found_alone).lines)


def test_no_joint_is_drawn_through_a_name(found_alone):
    bodies, skeleton = find_bodies(found_alone), found_alone.skeleton
    nodes = {node.name.replace(" ", "_"): node for node in bodies.nodes}
    letters = 4  # how far below its line a name reaches
    for joint, line in zip(skeleton.joints, bodies.lines, strict=True):
        parent, child = nodes[joint.parent], nodes[joint.child]
        assert line.y1 > parent.y + parent.radius + 11 + letters
        assert child.y - child.radius > line.y1
        assert (line.x2, line.y2) == (child.x, child.y)


def test_the_curve_spans_its_box_and_marks_what_was_found(found_alone):
    bodies = find_bodies(found_alone)
    points = [tuple(map(float, pair.split(","))) for pair in bodies.curve.split()]
    wide, high = bodies.curve_size
    assert points[0] == (0.0, 0.0)
    assert points[-1][0] == wide
    assert all(0 <= y <= high for _, y in points)
    assert 0 < bodies.found_x < wide


def test_markers_wear_their_bodys_colour_and_at_a_joint_the_next_ones(found_alone):
    colours = marker_colours(found_alone)
    limbs = found_alone.skeleton.limbs
    shared = limbs[1].markers[0]
    assert colours[shared] == [colour_of(1), colour_of(0)]
    assert colours[limbs[2].markers[0]] == [colour_of(2)]
    assert len({colour_of(i) for i in range(40)}) == 40


def test_the_page_tells_what_is_uncertain_and_trusts_no_label(found_alone):
    page = report_html(found_alone)
    section = page[page.index('id="bodies"') :]
    section = section[: section.index("</section>")]
    assert "&lt;i&gt;strap&lt;/i&gt;" in section
    assert "<i>strap</i>" not in page
    assert "Ben:LFHD, Ben:RFHD" in section
    assert "edge doubtful" in section
    assert "<script" not in section
