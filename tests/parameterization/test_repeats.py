"""How often a main movement is done."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from kinesphere.parameterization.anatomy import body_axes
from kinesphere.parameterization.joint import fit_joint
from kinesphere.parameterization.repeats import repeats, strokes
from kinesphere.parameterization.samples import JointSamples
from kinesphere.parameterization.settings import ParameterizationSettings
from kinesphere.parameterization.view import view_joint

RATE = 50.0
DOWN = np.array([0.0, -1.0, 0.0])
SETTINGS = ParameterizationSettings()


@pytest.mark.parametrize("times", [1, 2, 8])
def test_a_stroke_is_from_one_turn_to_the_next(times):
    turn = np.linspace(0, 1, 200)
    bends = np.tile(np.sin(np.pi * turn), times)
    swings = np.tile(np.sin(2 * np.pi * turn), times)
    for way in (1, -1):
        assert strokes(way * bends, 0.6) == 2 * times
        assert strokes(way * swings[::way], 1.2) == 2 * times - 1
    assert strokes(bends + 0.1 * np.sin(300 * np.linspace(0, times, len(bends))), 0.6) == 2 * times


def test_nothing_is_no_stroke():
    assert strokes(np.zeros(9), 0.1) == strokes(np.empty(0), 0.1) == 0
    assert strokes(np.zeros(9), 0.0) == 0


def bending(times, pause_s, wobble_deg=0.0):
    """Return a hip that flexes by 60°, with a rest after each time or on and on."""
    one = 60.0 * np.sin(np.linspace(0, np.pi, round(2 * RATE))) ** 2
    rest = np.zeros(round(pause_s * RATE))
    still = np.zeros(round(3 * RATE))
    angles = np.concatenate([still, *[np.concatenate([one, rest])] * times, still])
    axis = Rotation.from_rotvec([0.05, 0.05, 0.0]).apply(body_axes("left_hip")[0])
    vectors = np.deg2rad(angles)[:, None] * axis
    rng = np.random.default_rng(0)
    noise = Rotation.from_rotvec(np.deg2rad(0.2) * rng.normal(size=(len(angles), 3)))
    rotations = (noise * Rotation.from_rotvec(vectors)).as_matrix()
    seen = np.ones(len(angles), dtype=bool)
    return view_joint("left_hip", rotations, DOWN, seen, RATE, seen, SETTINGS), axis


@pytest.mark.parametrize(
    ("times", "pause_s", "kept"), [(1, 0.0, False), (8, 0.0, True), (4, 2.0, True)]
)
def test_a_movement_done_on_and_on_is_repeated(times, pause_s, kept):
    view, axis = bending(times, pause_s)
    fit = fit_joint(view, SETTINGS)
    assert fit.half_told == kept
    if kept:
        assert abs(fit.axes[1] @ axis) > np.cos(np.deg2rad(2.0))


def held(times, hold_s):
    """Return phases of a flexion by 60° that is held: there, and back."""
    way = 60.0 * np.sin(np.linspace(0, np.pi / 2, round(RATE))) ** 2
    hold, rest = np.full(round(hold_s * RATE), 60.0), np.zeros(round(2 * RATE))
    angles, phases = [rest], []
    for _ in range(times):
        start = sum(map(len, angles))
        stop = start + 2 * len(way) + len(hold)
        middle = (start + len(way), start + len(way) + len(hold))
        phases += [(start, middle[0]), (middle[1], stop)] if hold_s else [(start, stop)]
        angles += [way, hold, way[::-1], rest]
    axis = body_axes("left_hip")[0]
    vectors = np.deg2rad(np.concatenate(angles))[:, None] * axis
    rotations = Rotation.from_rotvec(vectors).as_matrix()
    return JointSamples(rotations, rotations @ DOWN, tuple(phases), RATE, DOWN), axis


@pytest.mark.parametrize("times", [1, 2, 3])
@pytest.mark.parametrize("hold_s", [0.0, 2.0])
def test_there_and_back_is_once_however_long_it_is_held_between(times, hold_s):
    samples, axis = held(times, hold_s)
    assert len(samples.phases) == times * (2 if hold_s else 1)
    assert repeats(samples, axis[None], np.zeros(len(samples.phases), int)) == times


def test_both_ways_from_the_middle_and_back_is_once():
    angles = np.deg2rad(30.0) * np.sin(np.linspace(0, 4 * np.pi, 400))
    axis = body_axes("left_hip")[0]
    rotations = Rotation.from_rotvec(angles[:, None] * axis).as_matrix()
    samples = JointSamples(rotations, rotations @ DOWN, ((0, 200), (200, 400)), RATE, DOWN)
    assert repeats(samples, axis[None], np.zeros(2, int)) == 2


def test_part_of_a_stroke_and_phases_about_nothing_count_not():
    view, axis = bending(8, 0.0)
    samples: JointSamples = view.samples
    (phase,) = samples.phases
    assert repeats(samples, axis[None], np.zeros(1, int)) == 8
    assert repeats(samples, axis[None], np.full(1, -1)) == 0
    short = samples.with_phases((phase, (phase[0], phase[0] + 20)))
    assert repeats(short, axis[None], np.zeros(2, int)) == 8
