"""Rigged glTF files as bodies: the bundled body under other names, axes and bones comes back."""

import numpy as np
import pytest
from numpy.testing import assert_allclose

from kinesphere.data import bundled_body
from kinesphere.errors import BadSurface, UnreadableFile
from kinesphere.io.gltf.body import read_body
from kinesphere.io.gltf.bone_names import limb_of_bone
from kinesphere.io.gltf.document import Document

MIXAMO = {
    "pelvis": "mixamorig:Hips",
    "trunk": "mixamorig:Spine",
    "head": "mixamorig:Neck",
    **{
        f"{side}_{ours}": f"mixamorig:{side.capitalize()}{theirs}"
        for side in ("left", "right")
        for ours, theirs in (
            ("upper_arm", "Arm"),
            ("forearm", "ForeArm"),
            ("hand", "Hand"),
            ("thigh", "UpLeg"),
            ("shank", "Leg"),
            ("foot", "Foot"),
        )
    },
}
FLOAT32 = 2e-6  # m, what single precision leaves of a body's size
AHEAD_Z = np.array([[0.0, 0, -1], [0, 1, 0], [1, 0, 0]])
"""From a body that looks along x to one that looks along z, as glTF has them."""


def written(path, names=MIXAMO, turn=AHEAD_Z, split=True, **skip):
    """Write the bundled body, its hands divided into two bones, its seams split."""
    body = bundled_body()
    document = Document({"version": "2.0"})
    points, centres = body.vertices @ turn.T, body.joint_centres @ turn.T
    faces, weights = body.faces, body.weights
    if split:  # every triangle with corners of its own, as flat shading has it
        points, weights = points[faces.ravel()], weights[faces.ravel()]
        faces = np.arange(len(points)).reshape(-1, 3)
    n = len(body.limbs)
    for i, limb in enumerate(body.limbs):
        parent = body.parents[i]
        offset = centres[i] - (centres[parent] if parent >= 0 else 0)
        document.add("nodes", {"name": names.get(limb, limb), "translation": offset.tolist()})
    for i in range(n):
        children = [int(c) for c in np.flatnonzero(body.parents == i)]
        if children:
            document.json["nodes"][i]["children"] = children
    finger = document.add(
        "nodes", {"name": "mixamorig:LeftHandIndex1", "translation": [0, -0.05, 0]}
    )
    hand = document.json["nodes"][body.limbs.index("left_hand")]
    hand["children"] = [finger]
    shares = np.concatenate([weights, np.zeros((len(weights), 1))], axis=1)
    left = body.limbs.index("left_hand")
    shares[:, n] = shares[:, left] * 0.5
    shares[:, left] *= 0.5
    places = np.concatenate([centres, centres[left][None] + [0, -0.05, 0]])
    inverse = np.tile(np.eye(4, dtype=np.float32), (n + 1, 1, 1))
    inverse[:, 3, :3] = -places  # column by column
    top = np.argsort(-shares, axis=1)[:, :4]
    attributes = {
        "POSITION": document.array(points.astype(np.float32)),
        "JOINTS_0": document.array(top.astype(np.uint8)),
        "WEIGHTS_0": document.array(np.take_along_axis(shares, top, axis=1).astype(np.float32)),
    }
    indices = document.array(faces.astype(np.uint32).ravel())
    document.add("meshes", {"primitives": [{"attributes": attributes, "indices": indices}]})
    skin = {"joints": list(range(n + 1)), "inverseBindMatrices": document.array(inverse)}
    document.add("skins", skin)
    document.add("nodes", {"mesh": 0, "skin": 0, **skip})
    document.write(path)
    return body


@pytest.mark.parametrize("suffix", [".glb", ".gltf"])
def test_the_body_comes_back_under_the_names_of_the_house(tmp_path, suffix):
    body = written(tmp_path / f"b{suffix}")
    found = read_body(tmp_path / f"b{suffix}")
    assert sorted(found.limbs) == sorted(body.limbs)
    at = [found.limbs.index(limb) for limb in body.limbs]
    assert_allclose(found.joint_centres[at], body.joint_centres, atol=FLOAT32)
    for i, limb in enumerate(body.limbs):
        parent = body.parents[i]
        theirs = found.parents[at[i]]
        assert (parent < 0) == (theirs < 0)
        if parent >= 0:
            assert found.limbs[theirs] == body.limbs[parent], limb
    # split corners are one vertex again: the surface is closed
    assert found.n_vertices == body.n_vertices
    assert len(found.faces) == len(body.faces)
    edges = np.sort(found.faces[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2), axis=1)
    assert (np.unique(edges, axis=0, return_counts=True)[1] == 2).all()


def test_fingers_belong_to_the_hand_and_ends_are_where_they_were(tmp_path):
    body = written(tmp_path / "b.glb")
    found = read_body(tmp_path / "b.glb")
    order = np.lexsort(np.round(found.vertices, 4).T)
    expected = np.lexsort(np.round(body.vertices, 4).T)
    hand = found.limbs.index("left_hand"), body.limbs.index("left_hand")
    assert found.weights[:, hand[0]].sum() == pytest.approx(
        body.weights[:, hand[1]].sum(), rel=1e-3
    )
    assert_allclose(
        found.vertices[order].sum(axis=0), body.vertices[expected].sum(axis=0), atol=1e-2
    )
    for limb in ("left_forearm", "right_shank", "trunk", "left_hand", "right_foot", "head"):
        i, j = found.limbs.index(limb), body.limbs.index(limb)
        assert np.linalg.norm(found.ends[i] - body.ends[j]) < 0.03, limb


def test_any_way_it_looks_it_looks_along_x(tmp_path):
    for i, turn in enumerate((np.eye(3), AHEAD_Z, AHEAD_Z @ AHEAD_Z)):
        written(tmp_path / f"{i}.glb", turn=turn)
        found = read_body(tmp_path / f"{i}.glb")
        toes, ankle = (a[found.limbs.index("left_foot")] for a in (found.ends, found.joint_centres))
        assert (toes - ankle)[0] > 0.1
        assert found.joint_centres[found.limbs.index("right_hand"), 2] > 0.2


def test_a_limb_without_a_name_is_said(tmp_path):
    written(tmp_path / "b.glb", names={**MIXAMO, "left_forearm": "bone_17"})
    with pytest.raises(BadSurface, match="no bone is named like left_forearm; there are mixamorig"):
        read_body(tmp_path / "b.glb")


def test_a_body_in_centimetres_is_said(tmp_path):
    written(tmp_path / "b.glb", turn=100 * np.eye(3))
    with pytest.raises(BadSurface, match="166 m tall; glTF is in metres"):
        read_body(tmp_path / "b.glb")


def test_what_is_no_rigged_gltf_is_said(tmp_path):
    path = tmp_path / "b.glb"
    path.write_bytes(b"glTF\x02\0\0\0")
    with pytest.raises(UnreadableFile, match="is no glTF file"):
        read_body(path)
    path.write_text("{}")
    with pytest.raises(UnreadableFile, match="is no glTF file"):
        read_body(path)
    path.write_text('{"asset": {"version": "1.0"}}')
    with pytest.raises(UnreadableFile, match=r"is glTF 1.0; 2.0 was expected"):
        read_body(path)
    path.write_text('{"asset": {"version": "2.0"}}')
    with pytest.raises(UnreadableFile, match="holds no skinned mesh"):
        read_body(path)


def test_cut_off_and_hostile_files_are_said(tmp_path):
    written(tmp_path / "b.glb")
    raw = (tmp_path / "b.glb").read_bytes()
    (tmp_path / "c.glb").write_bytes(raw[: len(raw) // 2])
    with pytest.raises(UnreadableFile):
        read_body(tmp_path / "c.glb")
    (tmp_path / "d.gltf").write_text(
        '{"asset": {"version": "2.0"}, "nodes": [{"children": [1]}, {"children": [0], "mesh": 0, '
        '"skin": 0}], "skins": [{"joints": [0]}], "meshes": [{"primitives": [{"attributes": '
        '{"POSITION": 0, "JOINTS_0": 0, "WEIGHTS_0": 0}}]}], "accessors": [{"count": 3}]}'
    )
    with pytest.raises(UnreadableFile, match="no tree"):
        read_body(tmp_path / "d.gltf")
    (tmp_path / "e.gltf").write_text(
        '{"asset": {"version": "2.0"}, "buffers": [{"uri": "../../etc/passwd"}], "bufferViews": '
        '[{"buffer": 0, "byteLength": 9}], "accessors": [{"bufferView": 0, "componentType": 5126, '
        '"type": "VEC3", "count": 1}]}'
    )
    from kinesphere.io.gltf.read import GltfFile

    with pytest.raises(UnreadableFile, match="lies elsewhere"):
        GltfFile(tmp_path / "e.gltf").array(0)


@pytest.mark.parametrize(
    ("bone", "limb"),
    [
        ("mixamorig:LeftForeArm", "left_forearm"),
        ("mixamorig:RightUpLeg", "right_thigh"),
        ("mixamorig:Spine", "trunk"),
        ("upperarm_l", "left_upper_arm"),
        ("lowerarm_r", "right_forearm"),
        ("calf_l", "left_shank"),
        ("thigh.R", "right_thigh"),
        ("UpperArm.L", "left_upper_arm"),
        ("Bip01 L Clavicle", "left_clavicle"),
        ("Bip01 R Calf", "right_shank"),
        ("J_Bip_L_UpperLeg", "left_thigh"),
        ("CC_Base_L_Hand", "left_hand"),
        ("RightShoulder", "right_clavicle"),
        ("left_foot", "left_foot"),
        ("LeftHandThumb1", None),
        ("lowerarm_twist_01_l", None),
        ("Hips", "pelvis"),
        ("root", None),
        ("LeftToeBase", None),
        ("neck_01", "head"),
    ],
)
def test_bones_are_told_by_their_names(bone, limb):
    assert limb_of_bone(bone) == limb
