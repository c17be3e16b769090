"""read_amc and read_asf: a small skeleton by hand, damage, and CMU's own files."""

import numpy as np
import pytest
from numpy.testing import assert_allclose
from scipy.spatial.transform import Rotation

from kinesphere.errors import KinesphereError, UnreadableFile
from kinesphere.io import read, read_amc, read_asf, read_bvh

EXACT = 1e-9
INCH = 0.0254 / 0.45
ASF = """# a comment
:version 1.10
:name TEST
:units
  mass 1.0
  length 0.45
  angle deg
:root
  order TX TY TZ RX RY RZ
  axis XYZ
  position 0 1 0
  orientation 0 0 0
:bonedata
  begin
    id 1
    name arm
    direction 2 0 0
    length 3
    axis 0 0 20 XYZ
    dof rx ry rz
    limits (-160.0 20.0)
           (-70.0 70.0)
           (-60.0 70.0)
  end
  begin
    id 2
    name hand
    direction 0 1 0
    length 0.5
    axis 30 0 0 XYZ
    dof rz
  end
:hierarchy
  begin
    root arm
    arm hand
  end
"""
AMC = """#!OML:ASF
:FULLY-SPECIFIED
:DEGREES
1
root 1 2 3 10 20 30
arm 5 6 7
hand 40
2
root 0 0 0 0 0 0
arm 0 0 0
hand 0
"""


def put(tmp_path, asf=ASF, amc=AMC):
    (tmp_path / "a.asf").write_text(asf, encoding="utf-8")
    (tmp_path / "a.amc").write_text(amc, encoding="utf-8")
    return tmp_path / "a.amc"


def test_bones_turn_in_axes_of_their_own(tmp_path):
    motion = read(put(tmp_path))

    def extrinsic(*angles):
        return Rotation.from_euler("xyz", angles, degrees=True)

    root = extrinsic(10, 20, 30)
    axes = extrinsic(0, 0, 20)
    arm = root * axes * extrinsic(5, 6, 7) * axes.inv()
    hand_axes = extrinsic(30, 0, 0)
    hand = arm * hand_axes * extrinsic(0, 0, 40) * hand_axes.inv()
    at_root = np.array([1.0, 3.0, 3.0])
    at_hand = at_root + arm.apply([3, 0, 0])
    tip = at_hand + hand.apply([0, 0.5, 0])
    assert_allclose(motion.origins[0] / INCH, [at_root, at_root, at_hand], atol=EXACT)
    limb = motion.skeleton.limbs[2]
    there = motion.origins[0, 2] + motion.rotations[0, 2] @ (limb.length * limb.long_axis)
    assert_allclose(there / INCH, tip, atol=EXACT)
    rest = motion.origins[1] / INCH
    assert_allclose(rest, [[0, 1, 0], [0, 1, 0], [3, 1, 0]], atol=EXACT)
    assert_allclose(motion.rotations[1, 0], motion.rotations[1, 2], atol=EXACT)
    assert motion.rate == 120.0
    assert "120 Hz is taken" in " ".join(motion.history[0].warnings)


def test_radians_are_radians(tmp_path):
    expected = read(put(tmp_path))
    amc = AMC.replace(":DEGREES", ":RADIANS")
    for words in ("10 20 30", "5 6 7", "hand 40"):
        turned = [w if w == "hand" else f"{np.radians(float(w)):.15f}" for w in words.split()]
        amc = amc.replace(words, " ".join(turned), 1)
    assert_allclose(read(put(tmp_path, amc=amc)).rotations, expected.rotations, atol=EXACT)
    asf = ASF.replace("angle deg", "angle rad").replace("0 0 20 XYZ", f"0 0 {np.pi / 9:.15f} XYZ")
    asf = asf.replace("30 0 0 XYZ", f"{np.pi / 6:.15f} 0 0 XYZ")
    both = read(put(tmp_path, asf, AMC))
    assert_allclose(both.rotations, expected.rotations, atol=EXACT)


def test_the_skeleton_is_found_beside_the_motion(tmp_path):
    path = put(tmp_path)
    (tmp_path / "a.asf").rename(tmp_path / "77.asf")
    renamed = path.rename(tmp_path / "77_03.amc")
    (tmp_path / "b.asf").write_text("no skeleton", encoding="utf-8")
    assert read_amc(renamed, rate=60.0).rate == 60.0
    lonely = renamed.rename(tmp_path / "x.amc")
    with pytest.raises(UnreadableFile, match=r"2 skeletons beside it; .*x.asf"):
        read_amc(lonely)
    assert read_amc(lonely, tmp_path / "77.asf").n_frames == 2


def test_a_skeleton_alone_stands_at_rest(tmp_path):
    put(tmp_path)
    skeleton = read_asf(tmp_path / "a.asf")
    assert skeleton.limb_names == ("root", "arm", "hand")
    assert_allclose(skeleton.limb("arm").length, 3 * INCH)
    assert_allclose(skeleton.limb("arm").long_axis, [0, 0, -1], atol=EXACT)  # the file's +x is left


def test_a_missing_bone_is_a_gap_and_an_odd_one_is_said(tmp_path):
    amc = AMC.replace("arm 5 6 7\n", "wing 1 2\n")
    motion = read(put(tmp_path, amc=amc))
    assert motion.seen.tolist() == [[True, False, False], [True, True, True]]
    said = " ".join(motion.history[0].warnings)
    assert "no bone wing" in said
    assert "arm is missing in 1 frames" in said


@pytest.mark.parametrize(
    ("old", "new", "said"),
    [
        ("arm 5 6 7", "arm 5 6", "has 2 numbers, its freedoms are 3"),
        ("arm 5 6 7", "arm 5 6 x", "no numbers"),
        ("arm 5 6 7", "arm 5 6 1e999", "infinite"),
        ("1\nroot 1", "root 1", "before any frame number"),
        ("dof rz", "dof rw", "rx, ry, rz"),
        ("direction 0 1 0", "direction 0 0 0", "is 0.5 long along"),
        ("length 0.5\n", "", "has no length"),
        ("arm hand", "arm foot", "there is no bone 'foot'"),
        ("arm hand", "arm arm", "hangs from two bones"),
        ("    arm hand\n", "", "leaves out hand"),
        (":hierarchy", ":other", "no section :hierarchy"),
        ("axis 30 0 0 XYZ", "axis 30 0 0 XXZ", "XYZ was expected"),
    ],
)
def test_damage_is_named(tmp_path, old, new, said):
    assert (old in ASF) != (old in AMC)
    with pytest.raises(UnreadableFile) as error:
        read_amc(put(tmp_path, ASF.replace(old, new), AMC.replace(old, new)))
    assert said in str(error.value)


def test_any_damage_is_an_error_of_ours(tmp_path, rng):
    refused = 0
    for i in range(200):
        texts = [bytearray(ASF.encode()), bytearray(AMC.encode())]
        raw = texts[i % 2]
        for at in rng.integers(0, len(raw), rng.integers(1, 5)):
            raw[at] = rng.integers(0, 256)
        (tmp_path / "a.asf").write_bytes(bytes(texts[0]))
        (tmp_path / "a.amc").write_bytes(bytes(texts[1]))
        try:
            read_amc(tmp_path / "a.amc")
        except KinesphereError:
            refused += 1
    assert refused > 40


@pytest.mark.real
def test_cmu_01_01_is_the_same_as_the_bvh_made_of_it(recordings):
    """B. Hahne's conversion; it leaves the thorax without length, so arms are compared by turns."""
    amc = read_amc(recordings / "formats" / "01_01.amc")
    bvh = read_bvh(recordings / "formats" / "01_01.bvh")
    pairs = {
        "root": "Hips",
        "lfemur": "LeftUpLeg",
        "ltibia": "LeftLeg",
        "lfoot": "LeftFoot",
        "rfemur": "RightUpLeg",
        "rtibia": "RightLeg",
        "rtoes": "RightToeBase",
        "rhumerus": "RightArm",
        "lradius": "LeftForeArm",
        "rhand": "RightFingerBase",
        "thorax": "Spine1",
        "head": "Head",
    }
    ours, theirs = amc.skeleton.limb_names, bvh.skeleton.limb_names
    for name, other in pairs.items():
        i, j = ours.index(name), theirs.index(other)
        turned = amc.rotations[:, i].swapaxes(1, 2) @ bvh.rotations[1:, j]
        assert np.abs(turned - np.eye(3)).max() < 1e-4, name  # four decimals of a degree
        if name in ("root", "lfemur", "ltibia", "lfoot", "rfemur", "rtibia", "rtoes"):
            assert np.abs(amc.origins[:, i] - bvh.origins[1:, j]).max() < 1e-5, name
