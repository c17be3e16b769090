"""A mesh of one's own, from the command line."""

import json

import numpy as np
import pytest

from kinesphere.cli.surface_words import surface_in_words
from kinesphere.data import bundled_body


@pytest.fixture
def obj(tmp_path):
    """Return the bundled body as an OBJ file in mm, z up, without limbs."""
    x, y, z = 1000 * bundled_body().vertices.T
    lines = [f"v {a:.4f} {b:.4f} {c:.4f}" for a, b, c in zip(x, -z, y, strict=True)]
    lines += [f"f {a} {b} {c}" for a, b, c in bundled_body().faces + 1]
    path = tmp_path / "body.obj"
    path.write_text("\n".join(lines))
    return path


def test_info_tells_what_a_mesh_is(call, obj):
    said = " ".join(call("info", obj).out.split())  # a long path breaks the lines elsewhere
    assert "a mesh of 8,000 triangles, 4,002 vertices" in said
    assert "none; found when it is attached" in said
    told = json.loads(call("info", obj, "--json").out)
    assert told["extent"][2] == pytest.approx(np.ptp(bundled_body().vertices[:, 1]) * 1e3, abs=1)


@pytest.mark.slow
def test_solve_takes_a_mesh(call, trc, obj, tmp_path):
    done = call("solve", trc, "--set", f"surface.body={obj}", "-o", tmp_path / "out")
    assert done.code == 0, done.err
    words = " ".join(done.out.split())
    for part in ("body.obj, A-pose", "up +z", "facing +x", "unit mm", "weights found"):
        assert part in words
    stages = json.loads((tmp_path / "out" / "summary.json").read_text())["stages"]
    found = next(stage for stage in stages if stage["name"] == "surface")
    assert found["findings"]["unit"] == "mm"
    assert found["findings"]["inverted_triangles"] == 0
    assert (tmp_path / "out" / "motion.glb").stat().st_size > 100_000


def test_a_skeleton_without_a_body_is_said(call, trc, tmp_path):
    plain = call("solve", trc, "--set", "surface.body=none", "-o", tmp_path / "a")
    assert "no body, as asked" in plain.out
    why = {"body": "none: the root is called limb_01; a body needs pelvis or trunk"}
    assert surface_in_words({"body": "bundled", **why}, {}).startswith(
        "no body: the root is called"
    )


@pytest.mark.slow
@pytest.mark.parametrize(
    ("content", "said"),
    [
        (None, "known are bundled, none, or a file with a mesh"),
        ("", "is empty"),
        ("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", "1 triangles with an area"),
        ("cube", "the mesh is no person standing alone"),
        ("nan", "is [nan"),
    ],
)
def test_what_is_no_body_costs_no_wait(call, trc, tmp_path, content, said):
    path = tmp_path / "thing.obj"
    if content in ("cube", "nan"):
        at = np.stack(np.meshgrid(*[np.arange(9)] * 2), axis=-1).reshape(-1, 2)
        lines = [f"v {a} {b} {(a * b) % 5}" for a, b in at]
        lines[5] = "v nan 0 0" if content == "nan" else lines[5]
        k = [9 * i + j + 1 for i in range(8) for j in range(8)]
        lines += [f"f {a} {a + 1} {a + 10} {a + 9}" for a in k]
        content = "\n".join(lines)
    if content is not None:
        path.write_text(content)
    done = call("solve", trc, "--set", f"surface.body={path}", "-o", tmp_path / "out")
    assert done.code == 2
    assert len(done.error_lines) == 1
    assert said in done.err
    assert not (tmp_path / "out").exists()


def test_a_recording_is_no_body(call, trc, tmp_path):
    done = call("solve", trc, "--set", f"surface.body={trc}", "-o", tmp_path / "out")
    assert done.code == 2
    assert "holds a Recording; surface.body wants a mesh" in done.err
