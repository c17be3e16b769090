"""Labels of a foot's outer edge, as they are customary."""

import pytest

from kinesphere.data.label_sides import lies_at_the_edge


@pytest.mark.parametrize(
    "labels",
    [
        ("LMT5",),
        ("RTOE5", "RNAV"),
        ("Anna:LMTP5",),
        ("right_mt5",),
        ("L.FM5",),
        ("SMALLTOE_L",),
    ],
)
def test_the_fifth_ray_is_the_edge(labels):
    assert lies_at_the_edge(labels)


@pytest.mark.parametrize(
    "labels",
    [
        (),
        ("LNAV",),
        ("LTOE",),
        ("LMT5", "LTOE"),
        ("LMT5", "LMT1"),
        ("LMT5", "foot_3"),
        ("MT55",),
        ("HTOE5",),
    ],
)
def test_what_else_is_there_or_is_not_known_tells_no_edge(labels):
    assert not lies_at_the_edge(labels)
