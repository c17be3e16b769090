"""Calibrations in every format give back the cameras they were made of."""

import numpy as np
import pytest
from numpy.testing import assert_allclose
from scipy.spatial.transform import Rotation

from kinesphere.errors import UnreadableFile
from kinesphere.io.calibration import read_calibration, write_calibration

cv2 = pytest.importorskip("cv2")
ROUNDED = 1e-6  # what files of six decimals leave


def assert_same(found, cameras, *, scale=1.0, bends=5):
    assert [c.name for c in found.cameras] == [c.name for c in cameras]
    for one, camera in zip(found.cameras, cameras, strict=True):
        assert one.size in (None, (camera.width, camera.height))
        assert_allclose(one.matrix, camera.matrix, atol=ROUNDED * 1e3)
        assert_allclose(one.distortion[:bends], camera.distortion[:bends], atol=ROUNDED)
        assert_allclose(one.rotation, camera.rotation, atol=ROUNDED)
        assert_allclose(one.translation, scale * camera.translation, atol=ROUNDED * scale)


def test_our_own_is_exact(tmp_path, cameras):
    write_calibration(cameras, tmp_path / "c.toml", up="+z")
    found = read_calibration(tmp_path / "c.toml")
    assert (found.unit, found.up) == ("m", "+z")
    for one, camera in zip(found.cameras, cameras, strict=True):
        assert_allclose(one.matrix, camera.matrix, rtol=0, atol=0)
        assert_allclose(one.rotation, camera.rotation, rtol=0, atol=0)


def pose2sim(cameras, **changes):
    lines = []
    for camera in cameras:
        values = {
            "size": [float(camera.width), float(camera.height)],
            "matrix": camera.matrix.tolist(),
            "distortions": camera.distortion[:4].tolist(),
            "rotation": Rotation.from_matrix(camera.rotation).as_rotvec().tolist(),
            "translation": camera.translation.tolist(),
            "fisheye": "false",
            **changes,
        }
        lines += [f"[{camera.name}_img]", f'name = "{camera.name}"']
        lines += [f"{key} = {value}" for key, value in values.items() if value is not None]
    return "\n".join([*lines, "[metadata]", "adjusted = false", "error = 0.0"])


def test_pose2sim(tmp_path, cameras):
    (tmp_path / "c.toml").write_text(pose2sim(cameras))
    found = read_calibration(tmp_path / "c.toml")
    assert found.unit == ""  # it says none
    assert_same(found, cameras, bends=4)


@pytest.mark.parametrize(
    ("changes", "said"),
    [
        ({"fisheye": "true"}, "is a fisheye"),
        ({"rotation": None}, "has no rotation"),
        ({"matrix": "[[1.0, 2.0], [3.0, 4.0]]"}, "matrix of cam1 must be 3 × 3"),
        ({"translation": '["a", 1, 2]'}, "translation of cam1 must be 3 numbers"),
        ({"distortions": "[0.1, 0.0, 0.0, 0.0, 0.0, 0.2]"}, "has 6 coefficients"),
        ({"size": "[640.5, 480.0]"}, "whole pixels are needed"),
        ({"translation": "[nan, 1.0, 2.0]"}, "no finite number"),
    ],
)
def test_what_is_wrong_with_pose2sim_is_said(tmp_path, cameras, changes, said):
    (tmp_path / "c.toml").write_text(pose2sim(cameras, **changes))
    with pytest.raises(UnreadableFile, match=said):
        read_calibration(tmp_path / "c.toml")


def qualisys(cameras, left=7, top=11, extra=""):
    parts = []
    for camera in cameras:
        axes = np.diag([1, -1, -1]) @ camera.rotation  # y up, looking along −z
        turned = " ".join(f'r{i + 1}{j + 1}="{axes[i, j]!r}"' for i in range(3) for j in range(3))
        x, y, z = 1000 * camera.centre
        k1, k2, p1, p2, k3 = camera.distortion
        fx, fy = 64 * camera.matrix[[0, 1], [0, 1]]
        cu, cv = 64 * (camera.matrix[[0, 1], [2, 2]] + [left, top])
        parts.append(
            f'<camera active="1" serial="{camera.name}" viewrotation="0" {extra}>'
            f'<fov_video left="{left}" top="{top}" right="{left + camera.width - 1}" '
            f'bottom="{top + camera.height - 1}"/><transform x="{x}" y="{y}" z="{z}" {turned}/>'
            f'<intrinsic focalLengthU="{fx}" focalLengthV="{fy}" centerPointU="{cu}" '
            f'centerPointV="{cv}" skew="0.0" radialDistortion1="{k1}" radialDistortion2="{k2}" '
            f'radialDistortion3="{k3}" tangentalDistortion1="{p1}" tangentalDistortion2="{p2}"/>'
            "</camera>"
        )
    text = "".join(parts).replace("np.float64(", "").replace(")", "")
    return f"<?xml version='1.0'?><calibration><cameras>{text}</cameras></calibration>"


def test_qualisys(tmp_path, cameras):
    (tmp_path / "c.qca.txt").write_text(qualisys(cameras))
    found = read_calibration(tmp_path / "c.qca.txt")
    assert found.unit == "mm"
    assert_same(found, cameras, scale=1000.0)


def test_qualisys_faults_are_said(tmp_path, cameras):
    path = tmp_path / "c.qca.txt"
    path.write_text(qualisys(cameras).replace('viewrotation="0"', 'viewrotation="90"'))
    with pytest.raises(UnreadableFile, match="turned by 90"):
        read_calibration(path)
    path.write_text(qualisys(cameras).replace("<transform", "<other"))
    with pytest.raises(UnreadableFile, match="has no <transform>"):
        read_calibration(path)
    path.write_text(qualisys(cameras).replace('active="1"', 'active="0"'))
    with pytest.raises(UnreadableFile, match="calibrates no camera"):
        read_calibration(path)
    path.write_text("<?xml version='1.0'?><measurement/>")
    with pytest.raises(UnreadableFile, match="<calibration> was expected"):
        read_calibration(path)


def test_opencv_one_camera_a_file(tmp_path, cameras):
    camera = cameras[0]
    storage = cv2.FileStorage(str(tmp_path / "cam1.yml"), cv2.FILE_STORAGE_WRITE)
    storage.write("image_width", camera.width)
    storage.write("image_height", camera.height)
    storage.write("camera_matrix", camera.matrix)
    storage.write("distortion_coefficients", camera.distortion[None])
    storage.write("rvec", cv2.Rodrigues(camera.rotation)[0])
    storage.write("tvec", camera.translation[:, None])
    storage.release()
    assert_same(read_calibration(tmp_path / "cam1.yml"), cameras[:1])


def test_opencv_several_cameras_a_file(tmp_path, cameras):
    storage = cv2.FileStorage(str(tmp_path / "all.yml"), cv2.FILE_STORAGE_WRITE)
    for camera in cameras:
        storage.write(f"K_{camera.name}", camera.matrix)
        storage.write(f"dist_{camera.name}", camera.distortion[None])
        storage.write(f"Rot_{camera.name}", camera.rotation)
        storage.write(f"T_{camera.name}", camera.translation[:, None])
    storage.release()
    assert_same(read_calibration(tmp_path / "all.yml"), cameras)


def test_yaml_written_by_hand(tmp_path):
    (tmp_path / "left.yaml").write_text(
        "image_width: 640\nimage_height: 480\n"
        "camera_matrix:\n  rows: 3\n  cols: 3\n  data: [700, 0, 320, 0, 700, 240, 0, 0, 1]\n"
        "R: [1, 0, 0, 0, 1, 0, 0, 0, 1]\nT: [0.5, 0, 2]\n"
    )
    (camera,) = read_calibration(tmp_path / "left.yaml").cameras
    assert (camera.name, camera.size) == ("left", (640, 480))
    assert_allclose(camera.matrix, [[700, 0, 320], [0, 700, 240], [0, 0, 1]])
    assert_allclose(camera.distortion, 0)
    assert_allclose(camera.translation, [0.5, 0, 2])


@pytest.mark.parametrize(
    ("name", "text", "said"),
    [
        ("c.yml", "%YAML:1.0\n---\nfoo: 3\n", "calibrates no camera"),
        ("c.yml", "%YAML:1.0\n---\nK: [1, 2\n", "cannot read it"),
        ("c.yml", "%YAML:1.0\n---\nK: [1, 0, 0, 0, 1, 0, 0, 0, 1]\n", "has no rotation"),
        ("c.toml", "a = 3\n", "calibrates no camera"),
        ("c.toml", "a = = 3\n", "no TOML"),
        ("c.toml", "camera = []\n", "calibrates no camera"),
        ("c.toml", "camera = [3]\n", "list of tables"),
        ("c.toml", "", "is empty"),
        ("c.toml", "[[camera]]\nnme = 'x'\n", "nme is no key here"),
        ("c.txt", "<?xml version='1.0'?><!DOCTYPE a><a/>", "document type"),
    ],
)
def test_no_calibration_is_said(tmp_path, name, text, said):
    (tmp_path / name).write_text(text)
    with pytest.raises(UnreadableFile, match=said):
        read_calibration(tmp_path / name)


def test_twice_the_same_camera_is_said(tmp_path, cameras):
    (tmp_path / "c.qca.txt").write_text(qualisys((cameras[0], cameras[0])))
    with pytest.raises(UnreadableFile, match="cam1 is there twice"):
        read_calibration(tmp_path / "c.qca.txt")
