"""read_bvh: what others write, what we write, and what nobody should."""

import numpy as np
import pytest
from numpy.testing import assert_allclose
from scipy.spatial.transform import Rotation

from kinesphere.errors import BadSetting, KinesphereError, UnreadableFile
from kinesphere.io import read, read_bvh, write, write_bvh

PRINTED = 2e-6  # m; angles printed to 1e-6°, lengths to 1e-6 units, a chain of a few limbs
EXACT = 1e-9
ARM = """HIERARCHY
ROOT Hips
{
  OFFSET 0 90 0
  CHANNELS 6 Xposition Yposition Zposition Zrotation Xrotation Yrotation
  JOINT Left Arm {
    OFFSET 10 40 0
    CHANNELS 3 Yrotation Zrotation Xrotation
    End Site
    {
      OFFSET 60 0 0
    }
  }
  JOINT Tail
  {
    OFFSET 0 0 -30
    CHANNELS 3 Xrotation Yrotation Zrotation
  }
}
MOTION
Frames: 2
Frame Time: .0083333
0 90 0 0 0 0 0 0 0 0 0 0
1 91 2 90 0 0 10 20 30 0 0 0
"""


def put(tmp_path, text, name="a.bvh"):
    path = tmp_path / name
    path.write_text(text, encoding="utf-8")
    return path


def test_channels_multiply_in_their_order(tmp_path):
    motion = read_bvh(put(tmp_path, ARM), unit="cm")
    assert motion.skeleton.limb_names == ("Hips", "Left Arm", "Tail")
    assert motion.rate == 120.0
    centres = motion.joint_centres()
    assert_allclose(centres[0], [[0.1, 1.3, 0], [0, 0.9, -0.3]], atol=EXACT)
    # turned by 90° about z: x goes to y, y to −x
    assert_allclose(centres[1], [[0.01 - 0.4, 0.91 + 0.1, 0.02], [0.01, 0.91, -0.28]], atol=EXACT)
    local = Rotation.from_euler("YZX", [10, 20, 30], degrees=True)
    tip = Rotation.from_euler("z", 90, degrees=True).apply(local.apply([0.6, 0, 0]))
    arm = motion.skeleton.limbs[1]
    there = centres[1, 0] + motion.rotations[1, 1] @ (arm.length * arm.long_axis)
    assert_allclose(there, centres[1, 0] + tip, atol=EXACT)


def test_the_rest_pose_has_parallel_frames_facing_z(tmp_path):
    motion = read_bvh(put(tmp_path, ARM), unit="cm")
    front, up, right = motion.rotations[0, 1].T
    assert_allclose([front, up, right], [[0, 0, 1], [0, 1, 0], [-1, 0, 0]], atol=EXACT)
    assert_allclose(motion.skeleton.limbs[1].long_axis, [0, 0, -1], atol=EXACT)


@pytest.mark.parametrize("rest", ["standing", "t-pose"])
@pytest.mark.parametrize("names", ["kinesphere", "unity", "motionbuilder"])
@pytest.mark.parametrize("channels", ["smooth", "zxy", "zyx"])
def test_what_was_written_comes_back(performance, tmp_path, rest, names, channels):
    motion = performance.motion
    write_bvh(motion, tmp_path / "a.bvh", rest=rest, names=names, channels=channels)
    back = read_bvh(tmp_path / "a.bvh", unit="cm")
    assert back.rate == motion.rate
    plain = read_bvh_in_order(motion, tmp_path)
    assert_allclose(back.joint_centres(), plain, atol=PRINTED)
    assert_allclose(back.joint_centres(), in_order(motion, tmp_path), atol=1e-4)


def in_order(motion, tmp_path):
    """Return the motion's joint centres in the order in which its BVH file names them."""
    write_bvh(motion, tmp_path / "order.bvh")
    names = read_bvh(tmp_path / "order.bvh", unit="cm").skeleton.limb_names[1:]
    children = [joint.child for joint in motion.skeleton.joints]
    return motion.joint_centres()[:, [children.index(name) for name in names]]


def read_bvh_in_order(motion, tmp_path):
    write_bvh(motion, tmp_path / "plain.bvh")
    return read_bvh(tmp_path / "plain.bvh", unit="cm").joint_centres()


def test_reading_and_writing_again_changes_nothing(performance, tmp_path):
    write_bvh(performance.motion, tmp_path / "a.bvh")
    once = read_bvh(tmp_path / "a.bvh", unit="cm")
    write(once, tmp_path / "b.bvh")
    twice = read_bvh(tmp_path / "b.bvh", unit="cm")
    assert twice.skeleton.limb_names == once.skeleton.limb_names
    assert_allclose(twice.origins, once.origins, atol=PRINTED)
    assert_allclose(twice.rotations, once.rotations, atol=1e-7)
    ends = [limb.length for limb in once.skeleton.limbs]
    assert_allclose([limb.length for limb in twice.skeleton.limbs], ends, atol=PRINTED)


@pytest.mark.parametrize(("unit", "said"), [("cm", "cm"), ("m", "m"), ("mm", "mm"), ("in", "in")])
def test_the_unit_is_guessed_by_the_figure_aloud(performance, tmp_path, unit, said):
    write_bvh(performance.motion, tmp_path / "a.bvh", unit=unit)
    motion = read(tmp_path / "a.bvh")
    assert f"{said} is guessed" in " ".join(motion.history[0].warnings)
    write_bvh(performance.motion, tmp_path / "b.bvh", unit="cm")
    expected = read_bvh(tmp_path / "b.bvh", unit="cm").joint_centres()
    assert_allclose(motion.joint_centres(), expected, atol=1e-4)
    with pytest.raises(BadSetting, match="parsec"):
        read_bvh(tmp_path / "a.bvh", unit="parsec")


def test_a_world_with_z_up_is_turned_aloud(performance, tmp_path):
    write_bvh(performance.motion, tmp_path / "a.bvh", unit="m")
    lines = (tmp_path / "a.bvh").read_text(encoding="utf-8").splitlines()
    turn = Rotation.from_euler("x", 90, degrees=True)  # y up becomes z up
    at = lines.index("MOTION") + 3
    out = [
        line if "OFFSET" not in line else turned_offset(line, turn) for line in lines[: at - 3]
    ] + lines[at - 3 : at]
    values = np.array([line.split() for line in lines[at:]], dtype=float)
    names = [w for line in lines if "CHANNELS" in line for w in line.split()[2:]]
    columns = 0
    for line in lines:
        if "CHANNELS" not in line:
            continue
        words = line.split()[2:]
        k = columns + (3 if len(words) == 6 else 0)
        if len(words) == 6:
            values[:, columns : columns + 3] = turn.apply(values[:, columns : columns + 3])
        order = "".join(w[0] for w in words if w.endswith("rotation"))
        local = Rotation.from_euler(order, values[:, k : k + 3], degrees=True)
        values[:, k : k + 3] = (turn * local * turn.inv()).as_euler(order, degrees=True)
        columns += len(words)
    assert columns == len(names)
    body = [" ".join(f"{v:.9f}" for v in row) for row in values]
    motion = read_bvh(put(tmp_path, "\n".join([*out, *body]) + "\n", "z.bvh"), unit="m")
    plain = read_bvh(tmp_path / "a.bvh", unit="m")
    assert "stands along +z" in " ".join(motion.history[0].warnings)
    assert_allclose(motion.joint_centres()[..., 1], plain.joint_centres()[..., 1], atol=PRINTED)
    apart = np.linalg.norm(np.diff(plain.joint_centres(), axis=1), axis=2)
    assert_allclose(
        np.linalg.norm(np.diff(motion.joint_centres(), axis=1), axis=2), apart, atol=PRINTED
    )
    assert np.linalg.det(motion.rotations).min() > 0.999


def turned_offset(line, turn):
    head, _, numbers = line.partition("OFFSET ")
    turned = turn.apply(np.array(numbers.split(), dtype=float))
    return head + "OFFSET " + " ".join(f"{v:.9f}" for v in turned)


def test_inner_joints_with_positions_come_apart_aloud(tmp_path):
    text = ARM.replace("CHANNELS 3 Yrotation", "CHANNELS 6 Xposition Yposition Zposition Yrotation")
    text = text.replace("0 90 0 0 0 0 0 0 0 0 0 0", "0 90 0 0 0 0 10 40 5 0 0 0 0 0 0")
    text = text.replace("1 91 2 90 0 0 10 20 30", "1 91 2 90 0 0 10 40 0 10 20 30")
    motion = read_bvh(put(tmp_path, text), unit="cm")
    assert_allclose(motion.origins[0, 1], [0.1, 1.3, 0.05], atol=EXACT)
    assert "come apart" in " ".join(motion.history[0].warnings)
    assert motion.skeleton.joint("Left Arm").residual == pytest.approx(0.05 / np.sqrt(2))


def test_positions_that_are_zero_are_added_to_the_offsets(tmp_path):
    text = ARM.replace("CHANNELS 3 Yrotation", "CHANNELS 6 Xposition Yposition Zposition Yrotation")
    text = text.replace("0 90 0 0 0 0 0 0 0 0 0 0", "0 90 0 0 0 0 0 0 0 0 0 0 0 0 0")
    text = text.replace("1 91 2 90 0 0 10 20 30", "1 91 2 90 0 0 0 0 0 10 20 30")
    motion = read_bvh(put(tmp_path, text), unit="cm")
    plain = read_bvh(put(tmp_path, ARM, "plain.bvh"), unit="cm")
    assert_allclose(motion.origins, plain.origins, atol=EXACT)


def test_gaps_spoken_as_nan_are_gaps(tmp_path):
    motion = read_bvh(put(tmp_path, ARM.replace("10 20 30", "10 nan 30")), unit="cm")
    assert motion.seen.tolist() == [[True, True, True], [True, False, True]]


@pytest.mark.parametrize(
    ("old", "new", "said"),
    [
        ("OFFSET 10 40 0", "OFFSET 10 40", "line 7: OFFSET"),
        ("OFFSET 10 40 0", "OFFSET 10 inf 0", "line 7: OFFSET"),
        ("CHANNELS 3 Xrotation", "CHANNELS 4 Xrotation", "line 17: CHANNELS"),
        ("CHANNELS 3 Xrotation", "CHANNELS 3 Wrotation", "line 17: CHANNELS"),
        ("MOTION\n", "", "no line MOTION"),
        ("Frame Time: .0083333", "Frame Time: 0", "Frame Time is '0'"),
        ("Frame Time: .0083333", "Frame Time: soon", "Frame Time is 'soon'"),
        ("ROOT Hips\n{", "ROOT Hips\n", "where { was expected"),
        ("JOINT Tail", "ROOT Tail", "line 14"),
        ("JOINT Tail\n  {", "JONT Tail\n  {", "starts with 'JONT'"),
        ("0 90 0 0 0 0 0 0 0 0 0 0\n", "0 90 0\n1\n", "gaps need"),
        ("1 91 2", "1 91 x", "'x' where a number"),
        ("1 91 2", "1 91 1e999", "infinite"),
    ],
)
def test_damage_is_named(tmp_path, old, new, said):
    assert old in ARM
    with pytest.raises(UnreadableFile) as error:
        read_bvh(put(tmp_path, ARM.replace(old, new)))
    assert said in str(error.value)
    assert "\n" not in str(error.value)


def test_a_tower_of_joints_is_refused(tmp_path):
    deep = "HIERARCHY\nROOT a\n{\nOFFSET 0 0 0\n" + "JOINT b\n{\nOFFSET 0 1 0\n" * 5000
    with pytest.raises(UnreadableFile, match="one in another"):
        read_bvh(put(tmp_path, deep + "}\n" * 5001 + "MOTION\nFrames: 0\nFrame Time: 1\n"))


def test_what_can_be_forgiven_is_said(tmp_path):
    text = ARM.replace("Frames: 2", "Frames: 7").replace("JOINT Tail", "JOINT Hips")
    motion = read_bvh(put(tmp_path, text.replace("\n", "\r\n")), unit="cm")
    said = " ".join(motion.history[0].warnings)
    assert "says 7 frames, there are 2" in said
    assert motion.skeleton.limb_names[2] == "Hips_2"


def test_any_damage_is_an_error_of_ours(performance, tmp_path, rng):
    write_bvh(performance.motion, tmp_path / "a.bvh")
    raw = (tmp_path / "a.bvh").read_bytes()[:9000]
    refused = 0
    for _ in range(150):
        spoilt = bytearray(raw)
        for at in rng.integers(0, len(raw), rng.integers(1, 6)):
            spoilt[at] = rng.integers(0, 256)
        (tmp_path / "b.bvh").write_bytes(bytes(spoilt[: rng.integers(20, len(raw))]))
        try:
            read_bvh(tmp_path / "b.bvh")
        except KinesphereError:
            refused += 1
    assert refused > 50


def test_bvhio_agrees(performance, tmp_path):
    bvhio = pytest.importorskip("bvhio")
    motion = performance.motion
    write_bvh(motion, tmp_path / "a.bvh", rest="t-pose")
    root = bvhio.readAsHierarchy(str(tmp_path / "a.bvh"))
    centres, joints = motion.joint_centres(), motion.skeleton.joints
    for frame in (0, 31, 74):
        root.loadPose(frame)
        for j, joint in enumerate(joints):
            at = root.filter(joint.child, isEqual=True)[0].PositionWorld
            assert_allclose([at.x / 100, at.y / 100, at.z / 100], centres[frame, j], atol=1e-4)


def test_pybvh_agrees(performance, tmp_path):
    pybvh = pytest.importorskip("pybvh")
    motion = performance.motion
    write_bvh(motion, tmp_path / "a.bvh", channels="zxy", names="unity")
    bvh = pybvh.read_bvh_file(str(tmp_path / "a.bvh"))
    names = read_bvh(tmp_path / "a.bvh", unit="cm").skeleton.limb_names
    at = [bvh.joint_names.index(name) for name in names[1:]]
    places = bvh.joint_positions()[:, at]
    assert_allclose(places / 100, in_order(motion, tmp_path), atol=1e-4)
