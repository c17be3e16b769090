"""read_segments, from OpenSim, JSON and TOML; XML that is out to do harm is refused."""

import pytest

from kinesphere.errors import UnreadableFile
from kinesphere.io import read_segments
from kinesphere.io.segments import limb_of_body


def marker(label, parent):
    return f'<Marker name="{label}">{parent}<location>0 0 0</location></Marker>'


def socket(body):
    return f"<socket_parent_frame>\n /bodyset/{body} </socket_parent_frame>"


MARKER_SET = (
    '<?xml version="1.0" encoding="UTF-8" ?><OpenSimDocument Version="40000">'
    '<MarkerSet name="markerset"><objects>'
    + marker("RKNE", socket("femur_r"))
    + marker("RTHI", socket("femur_r"))
    + marker("LANK", "<body>tibia_l</body>")
    + marker("TIP", socket("racket"))
    + "</objects></MarkerSet></OpenSimDocument>"
)
FOUND = {"right_thigh": ("RKNE", "RTHI"), "left_shank": ("LANK",), "racket": ("TIP",)}


@pytest.fixture
def segments_of(tmp_path):
    def read_it(content):
        path = tmp_path / "segments"
        path.write_bytes(content.encode() if isinstance(content, str) else content)
        return read_segments(path)

    return read_it


def test_a_marker_set(segments_of):
    found = segments_of(MARKER_SET)
    assert found == FOUND
    assert list(found) == list(FOUND)


def test_the_markers_of_a_whole_model(segments_of):
    body = '<BodySet><objects><Body name="femur_r"><mass>1</mass></Body></objects></BodySet>'
    model = MARKER_SET.replace("<MarkerSet", f'<Model name="m">{body}<MarkerSet').replace(
        "</MarkerSet>", "</MarkerSet></Model>"
    )
    assert segments_of(model) == FOUND


@pytest.mark.parametrize(
    "text",
    [
        '{"right_thigh": ["RKNE", "RTHI"], "left_shank": ["LANK"], "racket": ["TIP"]}',
        '{"segments": {"right_thigh": ["RKNE", "RTHI"], "left_shank": ["LANK"],'
        ' "racket": ["TIP"]}}',
        'right_thigh = ["RKNE", "RTHI"]\nleft_shank = ["LANK"]\nracket = ["TIP"]\n',
        '[segments]\nright_thigh = ["RKNE", "RTHI"]\nleft_shank = ["LANK"]\nracket = ["TIP"]\n',
    ],
)
def test_a_simple_mapping(segments_of, text):
    assert segments_of(text) == FOUND


@pytest.mark.parametrize(
    ("body", "limb"),
    [
        ("humerus_r", "right_upper_arm"),
        ("radius_l", "left_forearm"),
        ("ulna_r", "right_forearm"),
        ("hand_l", "left_hand"),
        ("femur_r", "right_thigh"),
        ("tibia_l", "left_shank"),
        ("fibula_r", "right_shank"),
        ("calcn_r", "right_foot"),
        ("talus_l", "left_foot"),
        ("toes_r", "right_foot"),
        ("torso", "trunk"),
        ("pelvis", "pelvis"),
        ("head", "head"),
        ("femur", "femur"),
        ("racket_r", "racket_r"),
        ("_r", "_r"),
    ],
)
def test_bodies_become_limbs(body, limb):
    assert limb_of_body(body) == limb


BOMB = (
    '<?xml version="1.0"?><!DOCTYPE a [<!ENTITY x0 "ha">'
    + "".join(f'<!ENTITY x{i} "{f"&x{i - 1};" * 10}">' for i in range(1, 12))
    + "]><a>&x11;</a>"
)


@pytest.mark.parametrize(
    ("content", "said"),
    [
        (BOMB, "declares an XML document type"),
        ('<!DOCTYPE a SYSTEM "file:///etc/hostname"><a/>', "declares an XML document type"),
        ('<!DOCTYPE a [<!ENTITY e SYSTEM "file:///etc/hostname">]><a>&e;</a>', "document type"),
        (MARKER_SET[:-30], r"line \d, column \d+ is no XML"),
        ("<a>&nothing;</a>", "undefined entity"),
        ('<?xml version="1.0" encoding="klingon"?><a/>', "is no XML"),
        ("<a/>", "holds no Marker"),
        (MARKER_SET.replace(' name="TIP"', ""), "marker '' has no name"),
        (MARKER_SET.replace(socket("racket"), ""), "marker 'TIP' has no body"),
        (MARKER_SET.replace("TIP", "RKNE"), "RKNE is there twice, on right_thigh and racket"),
        (MARKER_SET.replace("RTHI", "RKNE"), "RKNE is there twice, on right_thigh"),
        ("{}", "limb → list of labels was expected"),
        ('{"a": "x"}', "a holds 'x'; a list"),
        ('{"a": []}', "a list of labels"),
        ('{"a": [1]}', "a list of labels"),
        ('{"a": ["x"]', "line 1, column"),
        ("a = [1\n", "neither OpenSim XML nor JSON nor TOML"),
        ("just text", "neither OpenSim XML nor JSON nor TOML"),
        (b"\x00\x01", "binary"),
        ("", "empty"),
    ],
)
def test_damage_is_named(segments_of, content, said):
    with pytest.raises(UnreadableFile, match=said) as caught:
        segments_of(content)
    assert "\n" not in str(caught.value)
