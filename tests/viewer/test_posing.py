"""What a person types beside the scene: nothing that is typed raises."""

from contextlib import nullcontext
from types import SimpleNamespace
from unittest.mock import MagicMock

import pytest

from kinesphere.viewer.panel import RANGE, SHIFT, TURN, Panel
from kinesphere.viewer.poses import EditedPoses
from kinesphere.viewer.posing import Posing


class Gui:
    """Controls that hold what they are given, without a page."""

    def add_folder(self, _):
        return nullcontext()

    def add_number(self, _, value, min=0, max=0, **__):
        return self._control(value, min, max)

    def add_slider(self, _, low, high, _step, value, **__):
        return self._control(value, low, high)

    def add_dropdown(self, _, options, initial_value=None, **__):
        return self._control(initial_value or options[0])

    def add_checkbox(self, _, value, **__):
        return self._control(value)

    def add_button(self, label, **__):
        return SimpleNamespace(label=label, on_click=id)

    def add_markdown(self, content, **__):
        return SimpleNamespace(content=content, visible=True)

    def add_command(self, *_, **__):
        return SimpleNamespace(on_trigger=id)

    @staticmethod
    def _control(value, low=None, high=None):
        control = SimpleNamespace(value=value, min=low, max=high, calls=[])
        control.on_update = control.calls.append
        return control


@pytest.fixture
def posing(solution, tmp_path):
    server = MagicMock(gui=Gui())
    motion = solution.motion
    frames = (motion.first_frame, motion.n_frames, motion.rate)
    panel = Panel(server, frames, solution.skeleton, (), {})
    stage = MagicMock(figure=None)
    time = SimpleNamespace(frame=0, playing=False, draw=lambda: None)
    made = Posing(server, panel, stage, EditedPoses(solution), time, tmp_path / "e.toml", ())
    made.panel = panel
    made.pick(solution.skeleton.joint_names.index("left_elbow"))
    return made


def slide(posing, k, value):
    posing.panel.sliders[k].value = value
    posing._changer(k)(value)
    return posing.session.edits


@pytest.mark.parametrize("typed", [1e9, 181.0, float("inf")])
def test_a_slider_goes_no_farther_than_it_reaches(posing, typed):
    assert [edit.add_deg for edit in slide(posing, 0, typed)] == [TURN]
    posing.pick(-1)
    assert slide(posing, 3, -typed)[-1].add_m == -SHIFT
    assert slide(posing, 3, float("nan"))[1:] == ()


def test_fields_count_within_their_limits(posing, solution):
    panel, first = posing.panel, solution.motion.first_frame
    last = first + solution.motion.n_frames - 1
    panel.scope.value = RANGE
    panel.start.value, panel.end.value, panel.blend.value = 10**9, first - 50, -3.0
    (edit,) = slide(posing, 0, 10.0)
    assert (edit.frames, edit.blend_s) == ((first, last), 0.0)
    panel.start.value, panel.end.value = last - 2, first + 3  # from after to: taken the other way
    panel.blend.value = 1e9
    edit = slide(posing, 0, 10.0)[-1]
    assert edit.frames == (first + 3, last - 2)
    assert edit.blend_s == panel.blend.max
