"""What nobody films on purpose: each is solved with the right flag, or refused in one line."""

import re
from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose
from scipy.spatial.transform import Rotation

from kinesphere.cli.main import run
from kinesphere.data import JointFlag, motion_from_parameters
from kinesphere.errors import BadRecording
from kinesphere.io import read, write
from kinesphere.parameterization.angles import unwrapped
from kinesphere.pipeline import solve
from kinesphere.synthetic import make_performance

pytestmark = pytest.mark.slow

ANGLE = 1e-6  # rad; the actor has no noise, iterations stop at about this
SAMPLED = 1e-3  # rad; other markers make other frames the sample that limbs are measured on
FLOAT32 = 1e-3  # rad; 1 km off the origin a 32-bit float tells a place to 0.06 mm
SCENE = 1e-9  # m


@pytest.fixture(scope="module")
def actor():
    """Return 41 markers on an actor who calibrates in 20 s and moves on for 2 s."""
    return make_performance(
        np.random.default_rng(1), layout="cmu41", rate=10.0, calibration_s=20.0, free_s=2.0
    )


@pytest.fixture(scope="module")
def plain(actor):
    """Return the solution of the recording as it is."""
    return solve(actor.recording)


def recorded(actor, **changes):
    """Return what cameras see where some of the parameters are others."""
    places = motion_from_parameters(replace(actor.parameters, **changes)).marker_positions()
    markers = np.stack([places[label] for label in actor.recording.labels], axis=1)
    return replace(actor.recording, markers=markers)


def standing(actor):
    """Return angles, twists and root poses of somebody who never leaves the first pose."""
    told = actor.parameters
    names = ("angles", "twists", "root_positions", "root_rotations")
    return {name: np.repeat(getattr(told, name)[:1], told.n_frames, axis=0) for name in names}


def swinging(actor, joint, columns):
    """Return the same, but for one joint that swings about some of its axes, one after another."""
    still = standing(actor)
    j, n = actor.skeleton.joint_names.index(joint), actor.parameters.n_frames
    for part, column in zip(np.array_split(np.arange(n), len(columns)), columns, strict=True):
        still["angles"][part, j, column] += 0.8 * np.sin(np.linspace(0, 6 * np.pi, len(part)))
    return still


def turned(recording, turn, shift=(0.0, 0.0, 0.0), **changes):
    return replace(recording, markers=recording.markers @ turn.T + shift, **changes)


def without(actor, limbs, *, absent):
    """Return the recording with the markers of some limbs never seen, or not even in the file."""
    gone = {m for s in actor.model.segments if s.name in limbs for m in s.markers}
    labels, markers = actor.recording.labels, np.array(actor.recording.markers)
    kept = [c for c, label in enumerate(labels) if label not in gone or not absent]
    markers[:, [c for c, label in enumerate(labels) if label in gone]] = np.nan
    return replace(actor.recording, markers=markers[:, kept], labels=tuple(labels[c] for c in kept))


def warning(solution, *words):
    """Return the one warning that holds all the words."""
    found = [w for w in solution.warnings if all(word in w for word in words)]
    assert len(found) == 1, solution.warnings
    return found[0]


def share(solution, joint, flag):
    """Return in which share of the frames a joint carries a flag."""
    flags = solution.parameters.flags[:, solution.skeleton.joint_names.index(joint)]
    return float(((flags & flag) > 0).mean())


def assert_rebuilt(solution, atol=1e-3):
    """Assert that parameters put limbs where they were measured, in m, in most frames."""
    assert_allclose(
        np.nanmedian(solution.parameters.residuals, axis=0), 0.0, atol=atol, err_msg="residuals"
    )


# --- too little movement ---


def test_no_motion_at_all(actor):
    solution = solve(recorded(actor, **standing(actor)))
    joints = solution.skeleton.joints
    assert {joint.observability for joint in joints} == {"undetermined"}
    assert {joint.axes_source for joint in joints} == {"body"}
    assert all(joint.name in warning(solution, "does not tell the centre") for joint in joints)
    told = warning(solution, "the body frame's serve instead")
    assert told.count("the limb hardly moves") == len(joints)


def test_one_movement_only(actor):
    solution = solve(recorded(actor, **swinging(actor, "left_knee", [0])))
    knee = solution.skeleton.joint("left_knee")
    assert (knee.axes_source, knee.observability) == ("movement", "hinge")
    others = [j for j in solution.skeleton.joints if j.name != "left_knee"]
    assert {j.axes_source for j in others} == {"body"}
    assert len([w for w in solution.warnings if "never move" in w]) == 1  # one line for all


def test_a_joint_of_two_axes_that_moves_about_one(actor):
    solution = solve(recorded(actor, **swinging(actor, "left_shoulder", [0, 0])))
    assert solution.skeleton.joint("left_shoulder").axes_source == "body"
    assert "left_shoulder (only 1 of 2 main movements is there)" in warning(solution, "serve")


def test_parallel_axes(actor):
    skeleton = actor.skeleton
    shoulder = skeleton.joint("left_shoulder")
    limb = shoulder.rest @ skeleton.limb("left_upper_arm").long_axis
    across = np.cross(shoulder.axes[0], limb)
    tilt = Rotation.from_rotvec(np.deg2rad(8) * across / np.linalg.norm(across)).as_matrix()
    near = replace(shoulder, axes=np.array([shoulder.axes[0], tilt @ shoulder.axes[0]]))
    joints = tuple(near if j is shoulder else j for j in skeleton.joints)
    both = swinging(actor, "left_shoulder", [0, 1])
    solution = solve(recorded(actor, skeleton=replace(skeleton, joints=joints), **both))
    assert solution.skeleton.joint("left_shoulder").axes_source == "body"
    assert "left_shoulder (only 1 of 2 main movements is there)" in warning(solution, "serve")


@pytest.mark.parametrize("n_frames", [1, 2])
def test_hardly_any_frames(actor, n_frames):
    solution = solve(replace(actor.recording, markers=actor.recording.markers[:n_frames]))
    assert solution.parameters.n_frames == n_frames
    assert {joint.observability for joint in solution.skeleton.joints} == {"undetermined"}
    assert ("the recording has a single frame" in "".join(solution.warnings)) == (n_frames == 1)


# --- people who differ ---

FOREARM, SHANK = ("left_forearm", "left_hand"), ("right_shank", "right_foot")
ARMS = tuple(f"{s}_{limb}" for s in ("left", "right") for limb in ("upper_arm", "forearm", "hand"))


@pytest.mark.parametrize("limbs", [FOREARM, SHANK, ARMS])
@pytest.mark.parametrize("absent", [False, True])
def test_limbs_that_are_not_there(actor, plain, limbs, absent):
    solution = solve(without(actor, limbs, absent=absent), "cmu41")
    assert set(plain.skeleton.limb_names) - set(solution.skeleton.limb_names) == set(limbs)
    for limb in limbs:
        assert warning(solution, f"limb {limb} is left out")
    assert_rebuilt(solution)
    knee = "left_knee"
    mine, whole = (s.skeleton.joint_names.index(knee) for s in (solution, plain))
    assert_allclose(
        solution.parameters.angles[:, mine, 0], plain.parameters.angles[:, whole, 0], atol=SAMPLED
    )


def test_a_layout_without_a_leg_is_better_named(actor):
    solution = solve(without(actor, SHANK, absent=True))
    assert solution.model_name == "motion alone"
    assert warning(solution, "cmu41 88%", "without some limbs", "name it with --model")


def test_a_mirrored_person(actor, plain):
    mirrored = turned(actor.recording, np.diag([-1.0, 1.0, 1.0]))
    solution = solve(mirrored)
    assert "was reflected" in warning(solution, "mirror image")
    assert_allclose(
        unwrapped(solution.parameters.angles), unwrapped(plain.parameters.angles), atol=ANGLE
    )


# --- poses ---


def test_a_joint_in_gimbal_for_long(actor, plain):
    angles = np.array(actor.parameters.angles)
    j, n = actor.skeleton.joint_names.index("left_shoulder"), len(angles)
    angles[-20:, j, 0] = np.pi / 2  # along the proximal axis, where turning about it is twist
    solution = solve(recorded(actor, angles=angles))
    assert share(solution, "left_shoulder", JointFlag.SINGULAR) >= 20 / n
    assert share(plain, "left_shoulder", JointFlag.SINGULAR) < 10 / n
    assert_rebuilt(solution)


def test_full_turns_about_the_vertical_change_no_angle(actor, plain):
    told = actor.parameters
    turns = np.linspace(0, 4 * np.pi, told.n_frames)[:, None] * [0.0, 1.0, 0.0]
    rotations = Rotation.from_rotvec(turns).as_matrix() @ told.root_rotations
    solution = solve(recorded(actor, root_rotations=rotations))
    assert solution.warnings == plain.warnings
    assert_allclose(
        unwrapped(solution.parameters.angles), unwrapped(plain.parameters.angles), atol=1e-3
    )


def test_full_turns_about_an_axis_run_on_when_unwrapped(actor):
    angles = np.array(actor.parameters.angles)
    j, last = actor.skeleton.joint_names.index("left_shoulder"), 60
    arm = np.linspace(0, 4 * np.pi, last + 1)[1:]  # 12 deg a frame: two whole turns in 6 s
    proximal = angles[-last - 1, j, 1] + arm
    angles[-last:, j, :2] = np.stack([np.full(last, angles[-last - 1, j, 0]), proximal], axis=1)
    angles = np.angle(np.exp(1j * angles))
    solution = solve(recorded(actor, angles=angles), calibration=(0.0, 15.0))
    found = solution.parameters.angles[:, solution.skeleton.joint_names.index("left_shoulder")]
    ways = np.ptp(unwrapped(found[-last:]), axis=0)
    assert np.nanmax(ways) == pytest.approx(4 * np.pi * (last - 1) / last, abs=0.3)
    assert np.nanmin(ways) < 0.5  # the other axis rests


def test_a_handstand_all_the_time(actor):
    upside_down = np.diag([1.0, -1.0, -1.0])
    solution = solve(turned(actor.recording, upside_down, up="+y"))
    assert "head is along -y from the feet: up is -y" in warning(solution, "the file says up")


def test_somebody_who_lies_all_the_time(actor):
    lie = Rotation.from_rotvec([0, 0, np.pi / 2]).as_matrix()
    still = recorded(actor, **standing(actor))
    lowest = (still.markers @ lie.T)[..., 1].min()
    solution = solve(turned(still, lie, (2.0, 0.03 - lowest, 0.0), up="+y"))
    assert solution.recording.world_from_file.tolist() == np.eye(3).tolist()
    assert "a person who lies" in warning(solution, "up is +y as the file says, although")
    assert "the body lies (trunk 90 deg" in warning(solution, "no frame shows a good default")


def test_somebody_who_sits_all_the_time(actor):
    angles, names = np.array(actor.parameters.angles), actor.skeleton.joint_names
    for side in ("left", "right"):
        hip, knee = (actor.skeleton.joint(f"{side}_{name}") for name in ("hip", "knee"))
        flexion = int(np.abs(hip.axes[:, 2]).argmax())
        angles[:, names.index(hip.name), :2] = 0
        angles[:, names.index(hip.name), flexion] = 1.45 * np.sign(hip.axes[flexion, 2])
        angles[:, names.index(knee.name), 0] = -1.5 * np.sign(knee.axes[0, 2])
    solution = solve(recorded(actor, angles=angles))
    assert "as when seated" in warning(solution, "no frame shows a good default position")
    doubted = warning(solution, "the body frame's serve instead")
    # one thigh twists by a little more than an axis needs
    assert "left_hip (the limb turns about its own length alone)" in doubted
    assert "right_hip (the limb hardly moves)" in doubted


# --- markers ---


def test_infinity_in_a_file_is_not_seen(actor, tmp_path):
    path, where = tmp_path / "r.c3d", 3
    write(actor.recording, path)
    data = bytearray(path.read_bytes())
    start = 512 * (int.from_bytes(data[16:18], "little") - 1)  # the header's first data block
    data[start + 16 * where : start + 16 * where + 4] = np.float32(np.inf).tobytes()
    path.write_bytes(data)
    recording = read(path)
    assert np.isnan(recording.markers[0, where]).all()
    assert "infinite coordinates (first: point 4" in warning(solve(recording), "taken as not seen")


def test_infinity_from_a_program_is_refused(actor):
    markers = np.array(actor.recording.markers)
    markers[3, 1, 2] = -np.inf
    with pytest.raises(ValueError, match=r"markers is infinite at \(3, 1, 2\); only NaN"):
        replace(actor.recording, markers=markers)


def test_nothing_but_nan(actor):
    nothing = np.full_like(actor.recording.markers, np.nan)
    with pytest.raises(BadRecording, match="holds no marker position"):
        solve(replace(actor.recording, markers=nothing))


def test_a_place_no_marker_has(actor, tmp_path, capsys):
    markers = np.array(actor.recording.markers)
    markers[7, 5] = 1e27
    write(replace(actor.recording, markers=markers), tmp_path / "r.c3d")
    assert run(["solve", str(tmp_path / "r.c3d"), "-o", str(tmp_path / "out")]) == 2
    said = capsys.readouterr().err
    assert "LSHO is 1e+27 m away in frame 8: no position" in said
    assert said.count("\n") <= 2


def test_a_constant_marker(actor):
    markers = np.array(actor.recording.markers)
    markers[:, 5] = markers[0, 5]
    solution = solve(replace(actor.recording, markers=markers))
    assert warning(solution, "LSHO never moves while others do")


def test_coincident_markers(actor):
    markers = np.array(actor.recording.markers)
    foot = [actor.recording.labels.index(label) for label in ("LHEE", "LTOE", "LMT5")]
    markers[:, foot] = markers[:, foot[:1]]
    solution = solve(replace(actor.recording, markers=markers))
    assert warning(solution, "3 pairs of markers are at the same place", "LHEE and LTOE")
    assert share(solution, "left_ankle", JointFlag.TWIST_UNKNOWN) == 1
    assert "left_ankle" in warning(solution, "nothing tells the twist")


@pytest.mark.parametrize(("factor", "said"), [(1e-3, "0.00163 m"), (1e3, r"1.63e\+03 m")])
def test_metres_declared_as_millimetres_and_the_other_way_round(actor, factor, said):
    with pytest.raises(BadRecording, match=f"feet and head are {said} apart.*check the length"):
        solve(replace(actor.recording, markers=factor * actor.recording.markers))


def test_a_kilometre_off_the_origin(actor, plain, tmp_path):
    far = turned(actor.recording, np.eye(3), (1e3, 0.0, -1e3))  # 1e6 mm
    write(far, tmp_path / "far.c3d")
    solution = solve(read(tmp_path / "far.c3d"))
    same = [re.sub(r"\d+", "", w) for w in plain.warnings]  # lengths are known to 0.06 mm there
    assert [w for w in solution.warnings if re.sub(r"\d+", "", w) not in same] == []
    off = unwrapped(solution.parameters.angles) - unwrapped(plain.parameters.angles)
    assert np.nanpercentile(np.abs(off), 90) < 20 * FLOAT32


@pytest.mark.parametrize("pair", [("LTHI", "RTHI"), ("LANK", "LHEE")])
def test_labels_that_change_places(actor, pair):
    markers = np.array(actor.recording.markers)
    columns = [actor.recording.labels.index(label) for label in pair]
    steps = np.linalg.norm(np.diff(markers[:, columns], axis=0), axis=2).max(axis=1)
    at = 81 + int(steps[80:140].argmin())  # at 10 Hz only slow markers are told apart
    markers[at:, columns] = markers[at:, columns[::-1]]
    solution = solve(replace(actor.recording, markers=markers))
    assert warning(solution, f"{pair[0]} and {pair[1]} change places into frame {at + 1}:")


@pytest.mark.parametrize("said", ["+z", "+y", None])
def test_z_up_gives_what_y_up_gives(actor, plain, said):
    lay = np.array([[1.0, 0, 0], [0, 0, -1], [0, 1, 0]])  # y up → z up
    solution = solve(turned(actor.recording, lay, up=said))
    assert_allclose(solution.recording.markers, plain.recording.markers, atol=SCENE)
    assert_allclose(solution.parameters.angles, plain.parameters.angles, atol=ANGLE)
    overruled = [w for w in solution.warnings if "up is +z" in w]
    assert len(overruled) == (said == "+y")
