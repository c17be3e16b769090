"""kinesphere retarget and convert, as a user calls them."""

import json
from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose

import kinesphere as ks
from kinesphere.data import Solution
from kinesphere.io import read, read_rig, write, write_bvh


@pytest.fixture(scope="module")
def solved(performance, tmp_path_factory):
    """Return a solved folder as truth has it."""
    folder = tmp_path_factory.mktemp("solved") / "walk"
    truth = Solution(performance.recording, performance.motion, performance.parameters, "cmu41")
    write(truth, folder)
    (folder / "report.html").write_text("<p></p>", encoding="utf-8")
    return folder


def test_onto_a_bvh_rig(call, solved, performance, tmp_path):
    rig, out = tmp_path / "rig.bvh", tmp_path / "out.bvh"
    write_bvh(performance.motion, rig, rest="t-pose", names="motionbuilder")
    done = call("retarget", solved, "--onto", rig, "-o", out)
    assert done.code == 0, done.err
    assert "names" in done.out
    back = read(out)
    assert back.skeleton.limb_names == read(rig).skeleton.limb_names
    assert back.n_frames == performance.motion.n_frames
    assert out.read_text(encoding="utf-8").startswith(
        rig.read_text(encoding="utf-8").partition("MOTION")[0]
    )


def test_another_height_keeps_every_parameter_but_the_legs(call, solved, tmp_path):
    done = call("retarget", solved, "--height", "1.4", "-o", tmp_path / "small", "--json")
    assert done.code == 0, done.err
    told = json.loads(done.out)
    small, walk = read(tmp_path / "small"), read(solved)
    assert told["scale"] == pytest.approx(1.4 / ks_stature(walk.motion))
    assert (tmp_path / "small" / "report.html").exists()
    for j, joint in enumerate(walk.skeleton.joints):
        if joint.name.endswith(("hip", "knee", "ankle")):
            continue
        assert_allclose(small.parameters.angles[:, j], walk.parameters.angles[:, j], atol=0)
        assert_allclose(small.parameters.twists[:, j], walk.parameters.twists[:, j], atol=0)
        assert_allclose(small.skeleton.joints[j].axes, joint.axes, atol=0)
    for a, b in zip(small.skeleton.limbs, walk.skeleton.limbs, strict=True):
        assert_allclose(a.length, told["scale"] * b.length)


def ks_stature(motion):
    from kinesphere.editing import stature

    return stature(motion)


def test_parameters_rebuild_the_retargeted_legs(solved):
    walk = read(solved)
    large = ks.retarget(walk, 1.3, settings=ks.Settings())
    again = ks.motion_from_parameters(large.parameters)
    hinged = [j.name.endswith(("knee", "elbow")) for j in walk.skeleton.joints]
    at = [j + 1 for j, hinge in enumerate(hinged) if not hinge and "ankle" not in
          walk.skeleton.joints[j].name]  # fmt: skip
    thighs = [i for i in at if walk.skeleton.limb_names[i].endswith("thigh")]
    assert_allclose(again.rotations[:, thighs], large.motion.rotations[:, thighs], atol=1e-6)


def test_onto_another_persons_folder(call, solved, performance, tmp_path):
    from kinesphere.editing import scaled_skeleton

    other = scaled_skeleton(performance.skeleton, 0.9, {"left_thigh": 1.1, "right_thigh": 1.1})
    truth = Solution(
        performance.recording,
        replace(performance.motion, skeleton=other),
        replace(performance.parameters, skeleton=other),
        "cmu41",
    )
    write(truth, tmp_path / "other")
    done = call("retarget", solved, "--onto", tmp_path / "other", "-o", tmp_path / "out")
    assert done.code == 0, done.err
    out = read(tmp_path / "out")
    assert [limb.length for limb in out.skeleton.limbs] == [limb.length for limb in other.limbs]
    assert out.recording.labels == tuple(m for limb in other.limbs for m in limb.markers)


def test_a_mapping_and_settings_are_heeded(call, solved, performance, tmp_path):
    rig, map_file = tmp_path / "rig.bvh", tmp_path / "map.toml"
    write_bvh(performance.motion, rig)
    text = rig.read_text(encoding="utf-8").replace("left_forearm", "Unterarm_L")
    rig.write_text(text, encoding="utf-8")
    map_file.write_text('[rig]\nleft_forearm = "Unterarm_L"\n', encoding="utf-8")
    out = tmp_path / "out.bvh"
    done = call(
        *("retarget", solved, "--onto", rig, "--map", map_file, "-o", out, "--json"),
        *("--set", "retargeting.feet=free"),
    )
    assert done.code == 0, done.err
    told = json.loads(done.out)
    assert told["parts_from"] == "given"
    assert told["settings"]["feet"] == "free"
    motion = read(out)
    i = motion.skeleton.limb_names.index("Unterarm_L")
    j = performance.skeleton.limb_names.index("left_forearm")
    assert_allclose(motion.rotations[:, i], performance.motion.rotations[:, j], atol=1e-6)


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (["-o", "x.bvh"], "either --onto RIG or --height M"),
        (["--onto", "RIG", "--height", "1.7", "-o", "x.bvh"], "not both"),
        (["--onto", "RIG", "-o", "RIG"], "is read from"),
        (["--onto", "none.bvh", "-o", "x.bvh"], "no such file"),
        (["--onto", "MAP", "-o", "x.bvh"], "holds text"),
        (["--onto", "RIG", "--map", "MAP", "-o", "x.bvh"], "tables are [rig] and [source]"),
        (["--height", "-1", "-o", "x.bvh"], "0.01 to 100"),
        (["--height", "1.7", "-o", "x.xyz"], "names no format"),
    ],
)
def test_what_cannot_be_meant_is_one_line(call, solved, performance, tmp_path, words, said):
    write_bvh(performance.motion, tmp_path / "rig.bvh")
    (tmp_path / "map.toml").write_text('[wrong]\nhead = "x"\n', encoding="utf-8")
    named = {"RIG": tmp_path / "rig.bvh", "MAP": tmp_path / "map.toml"}
    words = [
        named.get(w, tmp_path / w if w in ("x.bvh", "x.xyz", "none.bvh") else w) for w in words
    ]
    done = call("retarget", solved, *words)
    assert done.code == 2
    assert said in done.err
    assert len(done.error_lines) == 1
    assert not (tmp_path / "x.bvh").exists()


def test_convert_and_info_know_motions(call, solved, tmp_path):
    a, b = tmp_path / "a.bvh", tmp_path / "b.limbs.csv"
    done = call("convert", solved, a, "--set", "bvh.names=unity", "--set", "bvh.rest=t-pose")
    assert done.code == 0, done.err
    assert "LeftUpperLeg" in a.read_text(encoding="utf-8")
    assert call("convert", a, b).code == 0
    assert b.read_text(encoding="utf-8").startswith("time_s,Hips.x_m")
    for name in ("a.c3d", "a.trc", "a.csv"):
        assert call("convert", a, tmp_path / name).code == 0
        points = read(tmp_path / name)
        assert {"Hips", "LeftFoot", "Head_end"} <= set(points.labels)
        i = points.labels.index("LeftFoot")
        motion = read(a)
        j = motion.skeleton.joint_names.index("LeftFoot")
        assert_allclose(points.markers[:, i], motion.joint_centres()[:, j], atol=1e-6)
    done = call("info", a, "--json")
    told = json.loads(done.out)
    assert told["kind"] == "motion"
    assert told["figure"]["left_thigh"] == "LeftUpperLeg"
    shown = call("info", a)
    assert "cm is guessed" in shown.out
    assert np.isclose(told["rate_hz"], 10.0)


def test_onto_the_gltf_of_a_solved_folder(call, solved, tmp_path):
    rig, out = solved / "motion.glb", tmp_path / "out.glb"
    done = call("retarget", solved, "--onto", rig, "-o", out)
    assert done.code == 0, done.err
    told = json.loads(call("info", out, "--json").out)
    assert told["figure"]["left_thigh"] == "left_thigh"
    assert "part" in call("info", out).out
    as_bvh = call("retarget", solved, "--onto", rig, "-o", tmp_path / "out.bvh")
    assert as_bvh.code == 0, as_bvh.err
    names = read_rig(rig).limb_names
    assert set(read(tmp_path / "out.bvh").skeleton.limb_names) == set(names)


def test_the_body_rides_along(performance):
    from kinesphere.pipeline.surface import surface_for

    truth = Solution(performance.recording, performance.motion, performance.parameters, "cmu41")
    surface, _ = surface_for(truth.motion, ks.Settings().surface)
    dressed = replace(truth, surface=surface)
    small = ks.retarget(dressed, 0.8)
    assert small.surface is not None
    assert ks.retarget(truth, 0.8).surface is None
    assert np.ptp(small.surface.vertices[:, 1]) < 0.9 * np.ptp(surface.vertices[:, 1])
