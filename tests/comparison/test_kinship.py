"""What one source gives both sides is not sought: an edited motion differs by its edits alone."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from kinesphere.comparison import compare
from kinesphere.comparison.kinship import find_kinship
from kinesphere.comparison.sides import side_from
from kinesphere.data import Motion, Parameters, PoseFlag, Step
from kinesphere.synthetic import make_performance

READ = Step("read", {"file": "walk.c3d"}, {"n_frames": 1250, "rate_hz": 50.0})
UPRIGHT = Step("orientation", {"up": "auto"}, {"up": "+z"})
SOLVED = Step("skeleton", {}, {"residual_mm": 1.25})
EXACT = 1e-9  # rad: rounding


@pytest.fixture(scope="module")
def parameters() -> Parameters:
    return make_performance(
        np.random.default_rng(3), rate=50.0, calibration_s=20.0, free_s=5.0
    ).parameters


@pytest.fixture(scope="module")
def motion() -> Motion:
    return make_performance(
        np.random.default_rng(3), rate=50.0, calibration_s=20.0, free_s=5.0
    ).motion


def kinship(first, second):
    return find_kinship(side_from(first), side_from(second))


def bent(parameters, joint, by):
    """Return parameters with one joint's first angle larger by so many degrees."""
    angles = np.array(parameters.angles)
    angles[:, parameters.skeleton.joint_names.index(joint), 0] += np.deg2rad(by)
    return replace(parameters, angles=angles)


def turned_in(motion, degrees, frames=slice(None)):
    """Return a motion in another world, or that is turned in some frames."""
    turn = Rotation.from_euler("y", degrees, degrees=True).as_matrix()
    rotations, origins = np.array(motion.rotations), np.array(motion.origins)
    rotations[frames], origins[frames] = turn @ rotations[frames], origins[frames] @ turn.T
    return replace(motion, rotations=rotations, origins=origins)


def after(motion, *history):
    return replace(motion, history=history)


@pytest.mark.parametrize("by", [20.0, -35.0])
def test_a_constant_edit_is_told_whole(parameters, by):
    """It was taken for another definition of the forearm's frame, and gone but for a degree."""
    found = compare(parameters, bent(parameters, "left_elbow", by))
    elbow = found.parameter("left_elbow", "axis1")
    assert np.rad2deg(elbow.after.bias) == pytest.approx(by, abs=1e-6)
    assert elbow.after.sd < EXACT
    told = {joint.name: joint.orientation_after for joint in found.joints}
    assert np.rad2deg(told.pop("left_elbow")) == pytest.approx(abs(by), abs=1e-6)
    assert max(told.values()) < 1e-7
    assert found.offset.shared
    assert found.offset.seconds == 0
    assert {limb.turn for limb in found.limbs} == {0.0}


def test_edits_at_either_end_shift_no_clock(parameters, rng):
    """A wave in one joint pulled the offset by hundredths of a frame."""
    angles = np.array(parameters.angles)
    n = parameters.n_frames
    angles[n // 2 :, :, 0] += np.deg2rad(15) * np.sin(np.linspace(0, 9, n - n // 2))[:, None]
    found = compare(parameters, replace(parameters, angles=angles))
    assert found.offset.seconds == 0
    assert found.offset.overlap == pytest.approx((n - 1) / parameters.rate)


def test_an_edited_solution_keeps_its_world(motion):
    """Half of the frames turned about the vertical: that is the edit, not another laboratory."""
    source = after(motion, READ, UPRIGHT, SOLVED)
    edited = turned_in(
        after(motion, READ, UPRIGHT, SOLVED, Step("editing")), 30.0, slice(500, None)
    )
    found = compare(source, edited)
    assert found.kinship.world
    assert found.world.turn == 0
    apart = found.parameter("trunk", "left_rotation").after
    assert np.rad2deg(apart.rmsd) == pytest.approx(30 * np.sqrt(1 - 500 / apart.n), rel=1e-3)


def test_put_upright_otherwise_is_another_world(motion):
    source = after(motion, READ, UPRIGHT, SOLVED)
    other = after(turned_in(motion, 30.0), READ, Step("orientation", {"up": "+y"}), SOLVED)
    found = compare(source, other)
    assert found.kinship.clock
    assert not found.kinship.world
    assert np.rad2deg(found.world.turn) == pytest.approx(30)


def test_two_models_of_one_recording_have_one_clock(motion):
    """Every pose of the second is wrong in its own way, and so are its centres."""
    skeleton = motion.skeleton
    moved = [replace(j, centre_in_child=j.centre_in_child + 0.01) for j in skeleton.joints]
    other = replace(motion, skeleton=replace(skeleton, joints=tuple(moved)))
    shared = kinship(after(motion, READ, UPRIGHT, SOLVED), after(other, READ, UPRIGHT, SOLVED))
    assert (shared.clock, shared.world, shared.limbs) == (True, True, False)


def test_a_name_alone_is_no_kinship(motion):
    """Every solved folder has a ``motion.bvh``."""
    read = Step("read", {"format": "bvh", "file": "motion.bvh"}, {"n_frames": 1250})
    first, second = after(turned_in(motion, 10.0), read), after(motion, read)
    assert not kinship(first, second).world
    later = replace(motion, first_frame=2, history=(READ, SOLVED))
    assert not kinship(after(motion, READ, SOLVED), later).clock
    other = after(motion, replace(READ, findings={"n_frames": 1249}), SOLVED)
    assert not kinship(after(motion, READ, UPRIGHT, SOLVED), other).world


def test_what_stands_still_alike_tells_no_clock(motion):
    """A neck that is stiff on both sides is alike at any offset."""
    names = motion.skeleton.limb_names
    rotations = np.array(motion.rotations)
    rotations[:, names.index("head")] = rotations[:, names.index("trunk")]
    stiff = replace(motion, rotations=rotations)
    assert kinship(stiff, stiff).clock
    late = replace(stiff, rotations=np.roll(rotations, 3, axis=0))
    assert not kinship(stiff, late).clock


def test_only_limbs_that_are_compared_are_warned_of(motion):
    """A hand whose twist nothing tells, of which the other side has none."""
    names = motion.skeleton.limb_names
    flags = np.array(motion.flags)
    flags[:, [names.index("head"), names.index("left_foot")]] = PoseFlag.TWIST_UNKNOWN
    blind = replace(motion, flags=flags)
    (said,) = (w for w in compare(blind, blind).warnings if "twist" in w)
    assert "head, left_foot on both sides" in said
    keep = [i for i, name in enumerate(names) if name != "head"]
    skeleton = motion.skeleton
    headless = replace(
        motion,
        skeleton=replace(
            skeleton,
            limbs=tuple(skeleton.limbs[i] for i in keep),
            joints=tuple(joint for joint in skeleton.joints if joint.child != "head"),
        ),
        rotations=motion.rotations[:, keep],
        origins=motion.origins[:, keep],
        residuals=motion.residuals[:, keep],
        flags=motion.flags[:, keep],
    )
    (said,) = (w for w in compare(blind, headless).warnings if "twist" in w)
    assert "of left_foot on the first side" in said
