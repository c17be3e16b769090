"""The editing session: what sliders do, undone and redone."""

import pytest
from hypothesis import given
from hypothesis import strategies as st
from pydantic import ValidationError

from kinesphere.data.edits import Edit
from kinesphere.viewer import Scope, Session, Target, session_from_edits

ELBOW = Target("left_elbow", 1, Scope((100, 200), 0.25))
TWIST = Target("left_elbow", "twist", Scope((100, 200), 0.25))
KNEE = Target("right_knee", 1)
LIFT = Target("root", "y")


def test_a_slider_makes_one_edit_however_far_it_is_dragged():
    session = Session()
    for amount in (1.0, 12.0, 30.0):
        session = session.changed(ELBOW, amount)
    assert session.edits == (
        Edit(joint="left_elbow", axis=1, add_deg=30.0, frames=(100, 200), blend_s=0.25),
    )
    assert session.amount(ELBOW) == 30.0
    assert session.amount(TWIST) == 0.0
    assert session.undone().edits == ()
    assert session.undone().redone().edits == session.edits


def test_gestures_are_steps_of_their_own():
    session = Session().changed(ELBOW, 10.0).settled().changed(ELBOW, 20.0).changed(KNEE, 5.0)
    assert [session.amount(target) for target in (ELBOW, KNEE)] == [20.0, 5.0]
    amounts = []
    while session.past:
        session = session.undone()
        amounts.append((session.amount(ELBOW), session.amount(KNEE)))
    assert amounts == [(20.0, 0.0), (10.0, 0.0), (0.0, 0.0)]
    assert session.undone() is session


def test_a_change_after_undo_forgets_what_was_undone():
    session = Session().changed(ELBOW, 10.0).changed(KNEE, 5.0).undone().changed(TWIST, 3.0)
    assert session.redone() is session
    assert [edit.axis for edit in session.edits] == [1, "twist"]


def test_back_to_zero_leaves_no_edit():
    session = Session().changed(ELBOW, 10.0).changed(KNEE, 5.0).changed(ELBOW, 0.0)
    assert [edit.joint for edit in session.edits] == ["right_knee"]
    assert Session().changed(ELBOW, 0.0) == Session()


def test_the_same_joint_at_other_frames_is_another_edit():
    other = Target("left_elbow", 1, Scope((300, 300)))
    session = Session().changed(ELBOW, 10.0).changed(other, 5.0).changed(ELBOW, 12.0)
    assert [(edit.frames, edit.add_deg) for edit in session.edits] == [
        ((100, 200), 12.0),
        ((300, 300), 5.0),
    ]


def test_the_root_is_shifted_in_metres():
    session = Session().changed(LIFT, 0.2)
    assert session.edits == (Edit(joint="root", axis="y", add_m=0.2),)
    assert session.amount(LIFT) == 0.2


def test_edits_of_a_file_are_gone_on_from():
    kept = (
        Edit(joint="neck", axis=2, set_deg=5.0),
        Edit(joint="right_knee", axis=1, add_deg=7.0),
        Edit(joint="right_knee", axis=1, add_deg=1.0, seconds=(0.0, 1.0)),
    )
    session = session_from_edits(kept)
    assert session.amount(KNEE) == 7.0
    assert session.changed(KNEE, 9.0).edits == (
        kept[0],
        Edit(joint="right_knee", axis=1, add_deg=9.0),
        kept[2],
    )
    assert session.changed(Target("neck", 2), 1.0).edits[:3] == kept


def test_clearing_can_be_undone():
    session = Session().changed(ELBOW, 10.0)
    assert session.cleared().edits == ()
    assert session.cleared().undone().edits == session.edits
    assert Session().cleared() == Session()


def test_what_is_no_number_is_refused():
    with pytest.raises(ValidationError):
        Session().changed(ELBOW, float("nan"))


MOVES = st.lists(
    st.one_of(
        st.tuples(st.sampled_from([ELBOW, TWIST, KNEE, LIFT]), st.sampled_from([0.0, 1.0, -2.0])),
        st.sampled_from(["undo", "redo", "settle"]),
    ),
    max_size=30,
)


@given(moves=MOVES)
def test_undo_and_redo_undo_each_other(moves):
    session = Session()
    for move in moves:
        if isinstance(move, str):
            does = {"undo": Session.undone, "redo": Session.redone, "settle": Session.settled}
            session = does[move](session)
        else:
            session = session.changed(*move)
            assert session.amount(move[0]) == move[1]
        if session.past:
            assert session.undone().redone().edits == session.edits
        if session.future:
            assert session.redone().undone().edits == session.edits
    while session.past:
        session = session.undone()
    assert session.edits == ()
