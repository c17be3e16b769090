"""skeleton.json and the topological model: to the last bit, and errors that name the place."""

import json
from dataclasses import fields, replace

import numpy as np
import pytest
from numpy.testing import assert_array_equal

from kinesphere.data import (
    JointModel,
    Landmark,
    MarkerStatistics,
    Segment,
    TopologicalModel,
    model_schema,
    model_to_dict,
)
from kinesphere.errors import BadModel, UnreadableFile
from kinesphere.io import (
    read,
    read_model,
    read_skeleton,
    write,
    write_model,
    write_model_schema,
    write_skeleton,
)
from kinesphere.io.json_files import json_text, read_json


def refuse(constant):
    raise AssertionError(f"{constant} is no JSON")


def assert_same(a, b):
    """Compare dataclasses field by field, arrays bit for bit."""
    assert type(a) is type(b)
    for f in fields(a):
        x, y = getattr(a, f.name), getattr(b, f.name)
        if isinstance(x, np.ndarray):
            assert_array_equal(x, y, err_msg=f.name)
            assert np.array_equal(np.signbit(x), np.signbit(y))
        else:
            assert x == y or (x != x and y != y), f.name


@pytest.fixture
def skeleton(odd_parameters, rng):
    joints = list(odd_parameters.skeleton.joints)
    joints[0] = replace(joints[0], axes=None, rest=None, axes_source=None)
    joints[1] = replace(
        joints[1],
        residual=np.nan,
        range_of_motion=np.nan,
        covariance=np.full((3, 3), np.nan),
        axes_uncertainty=[0.1, np.nan],
        note="range of motion 8°, centre undetermined",
        observability="undetermined",
    )
    joints[2] = replace(joints[2], covariance=rng.normal(size=(3, 3)), axes_source="body")
    joints[3] = replace(joints[3], centre_in_child=[-0.0, 1 / 3, 1e-17])
    return replace(odd_parameters.skeleton, joints=tuple(joints))


def test_a_skeleton_to_the_last_bit(skeleton, tmp_path):
    write(skeleton, tmp_path / "skeleton.json")
    again = read(tmp_path / "skeleton.json")
    for a, b in zip(skeleton.limbs, again.limbs, strict=True):
        assert_same(a, b)
    for a, b in zip(skeleton.joints, again.joints, strict=True):
        assert_same(a, b)


def test_what_a_skeleton_looks_like(skeleton, tmp_path):
    write_skeleton(skeleton, tmp_path / "skeleton.json")
    text = (tmp_path / "skeleton.json").read_text(encoding="utf-8")
    content = json.loads(text, parse_constant=refuse)
    root, head = content["limbs"][:2]
    assert root["parent"] is None
    assert head["parent"] == "trunk"
    assert head["markers"] == list(skeleton.limbs[1].markers)
    assert head["length_m"] == skeleton.limbs[1].length
    assert content["limbs"][3]["length_m"] is None
    joint = content["joints"][1]
    assert joint["note"] == "range of motion 8°, centre undetermined"
    assert joint["observability"] == "undetermined"
    assert joint["uncertainty"]["residual_m"] is None
    assert np.shape(content["joints"][2]["axes"]) == (3, 3)
    assert np.shape(content["joints"][2]["rest"]) == (3, 3)
    assert content["joints"][0]["axes"] is None
    assert len(max(text.splitlines(), key=len)) < 300  # rows on lines, a person can read it


@pytest.mark.parametrize(
    ("change", "said"),
    [
        (lambda c: c["joints"][2].pop("axes"), r"joints\[2\]\.axes is missing"),
        (lambda c: c["joints"][2].update(axes=[[1, 2]]), r"joints\[2\]\.axes\[0\]\[2\] is missing"),
        (lambda c: c["joints"][2].update(axes=[]), r"joints\[2\]\.axes"),
        (lambda c: c["joints"][2].update(rest="up"), r"joints\[2\]\.rest .*found 'up'"),
        (lambda c: c["joints"][2].update(observability="good"), r"observability .*found 'good'"),
        (lambda c: c["limbs"][1].update(parent="tail"), "does not join head to tail"),
        (lambda c: c["limbs"][1].update(markers=["one"]), "head markers must have shape"),
        (lambda c: c["joints"][1].update(name=c["joints"][0]["name"]), "joint neck is there twice"),
        (lambda c: c["limbs"].pop(), "11 limbs need 10 joints"),
        (lambda c: c.update(format="kinesphere-skeleton-9"), "format must be"),
        (lambda c: c.clear(), "limbs is missing"),
    ],
)
def test_a_damaged_skeleton_is_named(skeleton, tmp_path, change, said):
    path = tmp_path / "skeleton.json"
    write_skeleton(skeleton, path)
    content = json.loads(path.read_text(encoding="utf-8"))
    change(content)
    path.write_text(json.dumps(content))
    with pytest.raises(UnreadableFile, match=said) as caught:
        read_skeleton(path)
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("", "empty"),
        ("{", "line 1, column 2"),
        ('{"limbs": [\n1,]}', "line 2"),
        ('{"limbs": NaN}', "holds NaN; null"),
        ("[" * 100_000, "is no JSON"),
        ('{"a": ' + "1" * 5000 + "}", "is no JSON"),
        ("[]", "the whole must be an object"),
        ("3", "the whole must be an object"),
    ],
)
def test_what_is_no_json_is_named(tmp_path, text, said):
    path = tmp_path / "skeleton.json"
    path.write_text(text)
    with pytest.raises(UnreadableFile, match=said):
        read_skeleton(path)


def test_json_text_is_json_whatever_is_in_it():
    content = {
        "a": np.arange(6.0).reshape(2, 3) / 7,
        "nan": [np.nan, np.float64(2.5), np.inf, {"deep": (np.nan,)}],
        "empty": [{}, [], (), np.empty((0, 3))],
        "é": np.int64(7),
        "flag": np.bool_(True),
    }
    again = json.loads(json_text(content), parse_constant=refuse)
    assert_array_equal(again["a"], content["a"])
    assert again["nan"] == [None, 2.5, None, {"deep": [None]}]
    assert again["empty"] == [{}, [], [], []]
    assert again["é"] == 7
    assert again["flag"] is True


@pytest.fixture
def model():
    apart = np.array([[0, 0.31, np.nan], [0.31, 0, 1 / 3], [np.nan, 1 / 3, 0]])
    return TopologicalModel(
        name="two",
        segments=(Segment("trunk", ("C7", "T10"), ("LSHO",)), Segment("left_upper_arm", ("LSHO",))),
        joints=(
            JointModel(
                "left_shoulder",
                "trunk",
                "left_upper_arm",
                2,
                (
                    Landmark({"LSHO": 1.0}, ("C7", "T10"), 0.1, 0.2, -0.3, 0.015, "a paper"),
                    Landmark({"LSHO": 1 / 3, "C7": 2 / 3}),
                    Landmark(
                        {"LSHO": 1.0},
                        ("C7", "T10"),
                        plane=("C7", "T10", "LSHO"),
                        offset=(1 / 3, 0.0, -0.01),
                    ),
                ),
                doubtful=True,
            ),
        ),
        root="trunk",
        required=("C7", "LSHO"),
        mirror=(("LSHO", "RSHO"),),
        aliases={"C07": "C7"},
        statistics=(MarkerStatistics(("C7", "T10", "LSHO"), apart, apart / 100, "walk"),),
        description="test",
    )


def test_a_model_to_the_last_bit(model, tmp_path):
    write(model, tmp_path / "model.json")
    again = read(tmp_path / "model.json")
    for f in fields(model):
        if f.name != "statistics":
            assert getattr(again, f.name) == getattr(model, f.name), f.name
    assert_same(again.statistics[0], model.statistics[0])


def test_a_short_model_by_hand_is_enough(tmp_path):
    path = tmp_path / "by_hand.json"
    path.write_text(
        '{"name": "hand", "root": "a", "segments": [{"name": "a", "markers": ["x"]}], "joints": []}'
    )
    assert read(path).labels == ("x",)


@pytest.mark.parametrize(
    ("change", "said"),
    [
        (lambda c: c.pop("root"), "root is missing"),
        (lambda c: c.update(root="tail"), "root 'tail' is no segment; there are trunk"),
        (lambda c: c["segments"][1].update(marker=["x"]), r"segments\[1\]\.marker is no key"),
        (lambda c: c["segments"][1].update(markers="x"), r"segments\[1\]\.markers must be a list"),
        (lambda c: c["segments"][1].update(markers=["C7"]), "C7 belongs to both"),
        (
            lambda c: c["joints"][0].update(n_axes=4),
            r"joints\[0\]\.n_axes must be 1, 2 or 3, found 4",
        ),
        (lambda c: c["joints"][0].update(child="tail"), "names segment 'tail'"),
        (
            lambda c: c["joints"][0]["landmarks"][0].update(weights={"C7": 0.5, "LSHO": 0.4}),
            r"joints\[0\]\.landmarks\[0\] weights add up to 0\.9; they must add up to 1",
        ),
        (lambda c: c["joints"][0]["landmarks"][0].update(weights={}), "weights"),
        (lambda c: c["joints"][0]["landmarks"][0].update(scale=None), "need scale"),
        (lambda c: c["joints"][0]["landmarks"][1].update(spread_m=0), r"spread_m must be greater"),
        (lambda c: c["statistics"][0].update(mean_m=[[0]]), "3 labels need 3 rows of 3"),
        (lambda c: c["statistics"][0]["mean_m"][1].pop(), "3 labels need 3 rows of 3"),
        (lambda c: c["statistics"][0]["deviation_m"].pop(), "3 labels need 3 rows of 3"),
        (lambda c: c["mirror"].append(["LSHO"]), r"mirror\[1\]\[1\] is missing"),
        (lambda c: c.update(aliases=["C07"]), "aliases must be an object"),
        (lambda c: c["joints"][0]["landmarks"][1].update(forward=0.1), "forward need scale"),
        (lambda c: c["joints"][0]["landmarks"][2].update(plane=["C7", "T10"]), "three or more"),
        (
            lambda c: c["joints"][0]["landmarks"][2].update(plane=["C7", "T10", "T10"]),
            "plane has C7, T10, T10; it needs three or more labels, each once",
        ),
        (lambda c: c["joints"][0]["landmarks"][2].update(plane=[]), "offset_m needs plane"),
        (lambda c: c.update(segments=[]), "segments"),
        (lambda c: c.update(name=""), "name"),
        (lambda c: c["joints"][0].update(n_axes="x" * 999), r"n_axes must be .{,40}'x{59}$"),
        (lambda c: c.update(name=7, root=8), r"name must be text, found 7 \(and 1 more\)"),
    ],
)
def test_a_wrong_model_is_named(model, tmp_path, change, said):
    content = model_to_dict(model)
    change(content)
    path = tmp_path / "model.json"
    path.write_text(json.dumps(content))
    with pytest.raises(BadModel, match=said) as caught:
        read_model(path)
    assert str(caught.value).startswith(str(path))
    assert "\n" not in str(caught.value)


def test_the_schema_names_every_key_of_a_model(model, tmp_path):
    write_model(model, tmp_path / "model.json")
    write_model_schema(tmp_path / "schema.json")
    content, schema = (read_json(tmp_path / f"{name}.json") for name in ("model", "schema"))
    assert schema == model_schema()
    assert schema["additionalProperties"] is False
    assert set(schema["properties"]) == set(content)
    for part, name in (
        (content["segments"][0], "_Segment"),
        (content["joints"][0], "_Joint"),
        (content["joints"][0]["landmarks"][0], "_Landmark"),
        (content["statistics"][0], "_Statistics"),
    ):
        assert set(schema["$defs"][name]["properties"]) == set(part)
