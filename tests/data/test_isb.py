"""Clinical angles: signs of plain movements, mirror images, singular poses, the measured axis."""

from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose
from scipy.spatial.transform import Rotation

from kinesphere.data import Motion
from kinesphere.data.isb import IsbJoint, isb_angles, isb_joint, joint_angles
from kinesphere.data.isb_conventions import CONVENTIONS, ROOT_CONVENTION
from kinesphere.synthetic import make_performance

EXACT = np.deg2rad(1e-9)  # rounding of a dozen products
FORWARD, UP, RIGHT = np.eye(3)
DOWN = -UP


@pytest.fixture(scope="module")
def performance():
    return make_performance(np.random.default_rng(3), rate=20.0, calibration_s=20.0, free_s=3.0)


def read(name, rotation):
    """Return the clinical angles in deg of one pose of a joint in normalized frames."""
    kind = name.removeprefix("left_").removeprefix("right_")
    joint = IsbJoint(name, CONVENTIONS.get(kind, ROOT_CONVENTION), 0.0, "body")
    angles, _ = joint_angles(rotation.as_matrix()[None], joint)
    return dict(zip(joint.angle_names, np.rad2deg(angles[0]), strict=True))


def turned(limb, to, degrees):
    """Return the rotation that takes a limb from one direction towards another."""
    axis = np.cross(limb, to)
    return Rotation.from_rotvec(np.deg2rad(degrees) * axis / np.linalg.norm(axis))


OUTWARD = {"left": -RIGHT, "right": RIGHT}
PLAIN = [  # joint, where the limb points, where it goes, which angle grows
    ("hip", DOWN, "forward", "flexion"),
    ("hip", DOWN, "inward", "adduction"),
    ("knee", DOWN, "backward", "flexion"),
    ("knee", DOWN, "inward", "adduction"),
    ("ankle", FORWARD, "up", "dorsiflexion"),
    ("elbow", DOWN, "forward", "flexion"),
    ("elbow", DOWN, "outward", "valgus"),
    ("wrist", DOWN, "forward", "flexion"),
    ("wrist", DOWN, "inward", "ulnar_deviation"),
    ("lumbar", UP, "forward", "flexion"),
    ("lumbar", UP, "to the right", "right_bending"),
    ("neck", UP, "forward", "flexion"),
    ("pelvis", UP, "forward", "anterior_tilt"),
    ("pelvis", UP, "to the left", "right_up_obliquity"),
]


@pytest.mark.parametrize("side", ["left", "right"])
@pytest.mark.parametrize(("kind", "limb", "way", "angle"), PLAIN)
def test_a_plain_movement_is_one_angle_positive_on_both_sides(side, kind, limb, way, angle):
    to = {
        "forward": FORWARD,
        "backward": -FORWARD,
        "up": UP,
        "inward": -OUTWARD[side],
        "outward": OUTWARD[side],
        "to the right": RIGHT,
        "to the left": -RIGHT,
    }[way]
    name = kind if kind in ("lumbar", "neck", "pelvis") else f"{side}_{kind}"
    found = read(name, turned(limb, to, 25.0))
    assert found[angle] == pytest.approx(25.0, abs=1e-9)
    assert all(abs(v) < 1e-9 for other, v in found.items() if other != angle)


@pytest.mark.parametrize(
    ("kind", "angle"),
    [
        ("hip", "internal_rotation"),
        ("knee", "internal_rotation"),
        ("ankle", "internal_rotation"),
        ("elbow", "pronation"),
        ("wrist", "pronation"),
    ],
)
@pytest.mark.parametrize("side", ["left", "right"])
def test_turning_the_front_inward_is_internal_rotation(side, kind, angle):
    found = read(f"{side}_{kind}", turned(FORWARD, -OUTWARD[side], 15.0))
    assert found[angle] == pytest.approx(15.0, abs=1e-9)


@pytest.mark.parametrize("kind", ["lumbar", "neck", "pelvis"])
def test_turning_the_front_to_the_left_is_left_rotation(kind):
    assert read(kind, turned(FORWARD, -RIGHT, 40.0))["left_rotation"] == pytest.approx(40.0)


@pytest.mark.parametrize("side", ["left", "right"])
def test_the_shoulder_tells_plane_and_elevation(side):
    for degrees in (30.0, 90.0, 150.0):
        sideways = read(f"{side}_shoulder", turned(DOWN, OUTWARD[side], degrees))
        assert sideways["elevation"] == pytest.approx(degrees)
        assert sideways["plane_of_elevation"] == pytest.approx(0.0, abs=1e-9)
        forward = read(f"{side}_shoulder", turned(DOWN, FORWARD, degrees))
        assert forward["elevation"] == pytest.approx(degrees)
        assert forward["plane_of_elevation"] == pytest.approx(90.0)
    inward = read(f"{side}_shoulder", turned(FORWARD, -OUTWARD[side], 20.0))
    assert inward["internal_rotation"] + inward["plane_of_elevation"] == pytest.approx(20.0)


@pytest.mark.parametrize("kind", sorted(CONVENTIONS))
def test_angles_rebuild_the_pose_by_their_sequence(rng, kind):
    convention = CONVENTIONS[kind]
    r = Rotation.random(40, rng=rng)
    joint = IsbJoint(f"right_{kind}", convention, 0.3, "movement axis")
    angles, _ = joint_angles(r.as_matrix(), joint)
    raw = np.empty_like(angles)
    for k, (_, at, sign) in enumerate(convention.angles):
        raw[:, at] = sign * angles[:, k]
    turn = Rotation.from_euler("Y", 0.3)
    rebuilt = turn * Rotation.from_euler(convention.sequence, raw) * turn.inv()
    assert (rebuilt.inv() * r).magnitude().max() < 1e-9


def test_mirrored_bodies_have_equal_angles(rng):
    mirror = np.diag([1.0, 1.0, -1.0])
    r = Rotation.random(30, rng=rng).as_matrix()
    for kind, convention in CONVENTIONS.items():
        for turn in (0.0, 0.4):
            right, margin = joint_angles(r, IsbJoint(f"right_{kind}", convention, turn, ""))
            left, same = joint_angles(
                mirror @ r @ mirror, IsbJoint(f"left_{kind}", convention, turn, "")
            )
            assert_allclose(left, right, atol=EXACT)
            assert_allclose(margin, same, atol=EXACT)


def test_tilt_and_obliquity_do_not_ask_where_the_laboratory_points(performance):
    motion = performance.motion
    turn = Rotation.from_euler("y", 70, degrees=True).as_matrix()
    moved = replace(motion, rotations=turn @ motion.rotations, origins=motion.origins @ turn.T)
    one, other = isb_angles(motion), isb_angles(moved)
    root = motion.skeleton.limb_names[0]
    for name in ("anterior_tilt", "right_up_obliquity"):
        assert_allclose(other.angle(f"{root}.{name}"), one.angle(f"{root}.{name}"), atol=EXACT)
    heading = other.angle(f"{root}.left_rotation") - one.angle(f"{root}.left_rotation")
    assert_allclose(np.angle(np.exp(1j * (heading - np.deg2rad(70)))), 0, atol=1e-9)
    joints = slice(1, None)
    assert_allclose(other.angles[:, joints], one.angles[:, joints], atol=1e-8)


@pytest.mark.parametrize("off", [0.0, 1e-12, 2.0, 9.9, 10.1, 30.0])
def test_frames_near_the_singular_pose_are_flagged(off):
    hip = IsbJoint("right_hip", CONVENTIONS["hip"], 0.0, "body")
    shoulder = IsbJoint("right_shoulder", CONVENTIONS["shoulder"], 0.0, "body")
    _, margin = joint_angles(turned(DOWN, RIGHT, 90 - off).as_matrix()[None], hip)
    assert np.rad2deg(margin[0]) == pytest.approx(off, abs=1e-5)
    for elevation in (off, 180 - off):
        angles, margin = joint_angles(turned(DOWN, RIGHT, elevation).as_matrix()[None], shoulder)
        assert np.rad2deg(margin[0]) == pytest.approx(off, abs=1e-5)
        assert np.isfinite(angles).all()


def test_the_measured_flexion_axis_keeps_flexion_out_of_the_other_angles(performance):
    """A knee that bends about an axis turned 20° outward: nothing but flexion, on both sides."""
    skeleton = performance.skeleton
    for side, forward in (("left", -1), ("right", 1)):
        knee = skeleton.joint(f"{side}_knee")
        axis = np.array([[forward * np.sin(0.35), 0.0, np.cos(0.35)]])
        knee = replace(
            knee, axes=-axis, axes_source="movement", axes_uncertainty=None, name=f"{side}_knee"
        )
        read_as = isb_joint(knee)
        assert read_as.turn == pytest.approx(0.35)
        r = Rotation.from_rotvec(-np.deg2rad([[0], [45], [90]]) * axis).as_matrix()
        angles, _ = joint_angles(r, read_as)
        assert_allclose(np.rad2deg(angles), [[0, 0, 0], [45, 0, 0], [90, 0, 0]], atol=1e-9)
        body = isb_joint(replace(knee, axes_source="body"))
        assert body.turn == 0.0
        assert np.abs(np.rad2deg(joint_angles(r, body)[0][2, 1:])).max() > 15


def test_an_axis_that_is_far_from_sideways_is_not_believed(performance):
    knee = performance.skeleton.joint("left_knee")
    odd = replace(knee, axes=[[0.9, 0.0, -0.43]], axes_source="movement", axes_uncertainty=None)
    assert isb_joint(odd).turn_from == "body"


def test_gaps_stay_gaps_and_strange_bodies_have_no_clinical_angles(performance):
    motion = performance.motion
    limb = motion.skeleton.limb_names.index("left_shank")
    rotations = np.array(motion.rotations)
    rotations[3:7, limb] = np.nan
    found = isb_angles(replace(motion, rotations=rotations))
    gap = np.isnan(found.angle("left_knee.flexion"))
    assert gap[3:7].all()
    assert gap.sum() == 4
    assert np.isnan(found.angle("left_ankle.dorsiflexion")[3:7]).all()
    assert not found.gimbal[3:7, [j.name for j in found.joints].index("left_knee")].any()
    assert isinstance(motion, Motion)
    joints = tuple(replace(j, name=f"joint_{i:02d}") for i, j in enumerate(motion.skeleton.joints))
    root = motion.skeleton.limb_names[0]
    unnamed = replace(motion, skeleton=replace(motion.skeleton, joints=joints))
    assert [j.name for j in isb_angles(unnamed).joints] == [root]
    with pytest.raises(KeyError):
        found.angle("left_knee.yaw")


def test_one_frame_is_enough(performance):
    motion = performance.motion
    one = replace(
        motion,
        rotations=motion.rotations[:1],
        origins=motion.origins[:1],
        residuals=motion.residuals[:1],
        flags=motion.flags[:1],
    )
    assert_allclose(isb_angles(one).angles, isb_angles(motion).angles[:1])
