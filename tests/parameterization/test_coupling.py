"""How far an axis may be off for movement that goes with its own."""

import numpy as np
import pytest
from benchmarks.axes.generator import poses, wander
from scipy.spatial.transform import Rotation

from kinesphere.data import Joint, Limb, Motion, PoseFlag, Skeleton
from kinesphere.parameterization.axes.refinement import other_readings, refine_axes
from kinesphere.parameterization.confidence import with_skin
from kinesphere.parameterization.coupling import (
    NEIGHBOURS,
    Neighbours,
    circling,
    coupling,
    neighbours_of,
)
from kinesphere.parameterization.movement_axes import movement_axes
from kinesphere.parameterization.samples import JointSamples
from kinesphere.parameterization.settings import ParameterizationSettings
from kinesphere.parameterization.view import view_joint

RATE = 50.0
AXES = np.array([[1.0, 0.0, 0.0], [0.0, 0.0, 1.0]])
LIMB = np.array([0.0, -1.0, 0.0])
N = 400


def samples_of(angles, noise_deg=0.0, rng=None, phases=4):
    rotations = poses(AXES, np.eye(3), LIMB, np.deg2rad(angles))
    if noise_deg:
        spoiled = Rotation.from_rotvec(np.deg2rad(noise_deg) * wander(rng, len(angles), 3))
        rotations = spoiled.as_matrix() @ rotations
    ends = np.linspace(0, len(angles), phases + 1).astype(int)
    spans = tuple(zip(ends[:-1].tolist(), ends[1:].tolist(), strict=True))
    return JointSamples(rotations, rotations @ LIMB, spans, RATE, LIMB)


def ellipse(main_deg, side_deg, ahead, twist=0.0):
    turn = np.linspace(0, 8 * np.pi, N)
    main = main_deg * np.sin(turn)
    return np.column_stack([side_deg * np.sin(turn + ahead), main, twist * main])


def circled(samples):
    return float(np.rad2deg(circling(samples, AXES[1:], np.zeros(len(samples.phases), int)))[0])


@pytest.mark.parametrize("ahead", [np.pi / 2, -np.pi / 2, 0.5])
def test_circling_is_the_part_that_is_late(ahead):
    expected = np.rad2deg(np.arctan(8 / 30 * abs(np.sin(ahead))))
    assert circled(samples_of(ellipse(30.0, 8.0, ahead))) == pytest.approx(expected, rel=0.06)


def test_both_ways_round_is_circling_too():
    angles = ellipse(30.0, 8.0, np.pi / 2)
    angles[N // 2 :, 0] *= -1
    assert circled(samples_of(angles)) > 13.0


def test_there_and_back_is_none(rng):
    assert circled(samples_of(ellipse(30.0, 8.0, 0.0))) < 1.0
    assert circled(samples_of(ellipse(40.0, 0.0, 0.0), 3.0, rng)) < 5.0
    assert circled(samples_of(ellipse(40.0, 0.0, 0.0), 1.0, rng)) < 2.0


def test_phases_about_nothing_do_not_count():
    samples = samples_of(ellipse(30.0, 8.0, np.pi / 2))
    assert circling(samples, AXES[1:], np.full(4, -1)) == 0.0
    assert circling(samples.with_phases(((0, 2),)), AXES[1:], np.zeros(1, int)) == 0.0


def test_a_limb_that_circles_tells_no_axis_of_a_hinge(rng):
    """What is in phase tilts its axis, by as much as is late, as far as anyone can tell."""
    seen = np.ones(2 * N, dtype=bool)
    still = np.zeros((N // 2, 3))
    settings = ParameterizationSettings()
    told = []
    for side in (0.0, 20.0):
        angles = np.concatenate([still, ellipse(45.0, side, 0.8), still])
        rotations = samples_of(angles, 0.3, rng).rotations
        view = view_joint("joint_01", rotations, LIMB, seen, RATE, seen, settings)
        told.append(movement_axes(view, 1, settings))
    plain, circling_round = told
    assert not plain.doubts
    assert np.rad2deg(plain.quality.uncertainty) < 6.0
    assert any("movement about another" in doubt for doubt in circling_round.doubts)
    assert np.rad2deg(circling_round.quality.coupled) > 10.0


@pytest.mark.parametrize("twist", [0.0, 0.4])
def test_twist_with_the_angle_puts_one_of_two_axes_off_and_that_is_told(rng, twist):
    for _ in range(4):
        samples = samples_of(ellipse(35.0, 0.0, 0.0, twist), 2.0, rng)
        axes = refine_axes(samples, AXES[1:])
        off = np.rad2deg(np.arccos(min(1.0, abs(float(axes[0] @ AXES[1])))))
        (said,) = np.rad2deg(other_readings(samples, axes))
        assert (off > 15.0) == (said > 10.0) == (twist > 0)
        assert said < 1.5 * off + 5.0


def test_a_wide_limb_is_thought_to_twist_less(rng):
    samples = samples_of(ellipse(35.0, 0.0, 0.0, 0.4), 2.0, rng)
    axes = refine_axes(samples, AXES[1:])
    assert other_readings(samples, axes, wide=True) < other_readings(samples, axes)


def chain():
    """Return trunk, thigh, shank and head, the thigh still, the shank bending by 60°."""

    def limb(name, parent):
        nothing = {"markers": (), "marker_positions": np.empty((0, 3))}
        return Limb(name=name, parent=parent, long_axis=LIMB, length=0.4, **nothing)

    def joint(name, parent, child):
        return Joint(
            name=name,
            parent=parent,
            child=child,
            centre_in_parent=np.zeros(3),
            centre_in_child=np.zeros(3),
            residual=0.0,
            range_of_motion=np.nan,
            covariance=np.eye(3),
            observability="given",
        )

    limbs = (
        limb("trunk", None),
        limb("thigh", "trunk"),
        limb("shank", "thigh"),
        limb("head", "trunk"),
        limb("arm", "trunk"),
    )
    joints = (
        joint("hip", "trunk", "thigh"),
        joint("knee", "thigh", "shank"),
        joint("neck", "trunk", "head"),
        joint("shoulder", "trunk", "arm"),
    )
    rotations = np.tile(np.eye(3), (N, 5, 1, 1))
    bent = Rotation.from_rotvec(
        np.deg2rad(30.0) * np.sin(np.linspace(0, 8 * np.pi, N))[:, None] * AXES[1]
    )
    rotations[:, 2] = rotations[:, 3] = bent.as_matrix()
    return Motion(
        skeleton=Skeleton(limbs, joints),
        rotations=rotations,
        origins=np.zeros((N, 5, 3)),
        residuals=np.zeros((N, 5)),
        flags=np.full((N, 5), PoseFlag.MEASURED, dtype=np.uint8),
        rate=RATE,
    )


def test_neighbours_share_a_narrow_limb():
    hip, knee, neck, shoulder = neighbours_of(chain())
    assert [len(one.pairs) for one in (hip, knee, neck, shoulder)] == [1, 1, 0, 0]
    samples = samples_of(np.zeros((N, 3)), phases=1)
    labels = np.zeros(1, dtype=int)
    assert np.rad2deg(hip.arcs(samples, labels, 1)) == pytest.approx([60.0], abs=3.0)
    assert knee.arcs(samples, labels, 1) == pytest.approx([0.0], abs=1e-6)
    assert neck.arcs(samples, labels, 1) == 0.0


def test_where_the_neighbour_moves_and_the_joint_hardly_does_skin_is_the_movement():
    hip = neighbours_of(chain())[0]
    samples = samples_of(ellipse(8.0, 0.0, 0.0))
    ranges = np.deg2rad([16.0])
    off = coupling(samples, AXES[1:], ranges, hip)
    assert np.rad2deg(off) == pytest.approx([np.rad2deg(np.arctan2(NEIGHBOURS * 60, 16))], rel=0.15)
    assert np.rad2deg(with_skin(off, ranges))[0] > 13.0
    wide = coupling(samples, AXES[1:], np.deg2rad([90.0]), hip)
    assert np.rad2deg(wide)[0] < 3.0
    assert np.rad2deg(coupling(samples, AXES[1:], ranges, Neighbours()))[0] < 1.0
