"""Files of pose edits."""

import pytest

from kinesphere.data.edits import Edit
from kinesphere.errors import UnreadableFile
from kinesphere.io import read_edits, write_edits

GOOD = """
[[edit]]
joint = "left_elbow"
axis = 1
add_deg = 30
frames = [100, 200]
blend_s = 0.25

[[edit]]
joint = "neck"
axis = "twist"
set_deg = -5.5
"""


def test_edits_come_back(tmp_path):
    path = tmp_path / "edits.toml"
    path.write_text(GOOD, encoding="utf-8")
    edits = read_edits(path)
    assert edits[0] == Edit(
        joint="left_elbow", axis=1, add_deg=30.0, frames=(100, 200), blend_s=0.25
    )
    assert edits[1] == Edit(joint="neck", axis="twist", set_deg=-5.5)
    write_edits(edits, tmp_path / "again.toml")
    assert read_edits(tmp_path / "again.toml") == edits


def test_any_name_survives(tmp_path):
    edits = (
        Edit(joint="root", axis="y", add_m=0.125, frames=(1, 2)),
        Edit(joint="root", axis=3, add_deg=-12.5),
    )
    write_edits(edits, tmp_path / "root.toml")
    assert read_edits(tmp_path / "root.toml") == edits
    edits = (Edit(joint='a "quoted"\\ näme\n', axis=2, add_deg=1e-7, seconds=(0.0, 0.1)),)
    write_edits(edits, tmp_path / "edits.toml")
    assert read_edits(tmp_path / "edits.toml") == edits


@pytest.mark.parametrize(
    ("text", "says"),
    [
        ("", "is empty"),
        ("# nothing", "edit is missing"),
        ("edit = []", "edit"),
        ("[[edit]", "no TOML"),
        ('[[edit]]\njoint = "neck"\naxis = 1', "needs either add_deg or set_deg"),
        ('[[edit]]\njoint = "neck"\naxis = 1\nadd_deg = 1\nset_deg = 2', "and not both"),
        ('[[edit]]\njoint = "neck"\naxis = 4\nadd_deg = 1', r"edit\[0\].axis"),
        ('[[edit]]\njoint = "neck"\naxis = 1\nadd_deg = nan', r"edit\[0\].add_deg"),
        ('[[edit]]\njoint = "neck"\naxis = 1\nadd_deg = "x"', r"edit\[0\].add_deg"),
        ('[[edit]]\njoint = "neck"\naxis = 1\nadd_deg = 1\nframes = [9, 3]', "first, last"),
        ('[[edit]]\njoint = "neck"\naxis = 1\nadd_deg = 1\nangle = 3', "no key this place knows"),
        ('[[edit]]\njoint = "neck"\naxis = 1\nadd_deg = 1\nblend_s = -1', "blend_s"),
        ('[[edit]]\njoint = "neck"\naxis = "x"\nadd_m = 1.0', "for the root; joints turn"),
        ('[[edit]]\njoint = "root"\naxis = "x"\nadd_deg = 1', "along x needs add_m"),
        ('[[edit]]\njoint = "root"\naxis = 2\nadd_m = 1', "add_m needs axis"),
        ('[[edit]]\njoint = "root"\naxis = 2\nset_deg = 1', "the root turns about axis"),
        ('[[edit]]\njoint = "root"\naxis = "twist"\nadd_deg = 1', "the root turns about axis"),
    ],
)
def test_what_means_nothing_is_refused_with_its_place(tmp_path, text, says):
    path = tmp_path / "edits.toml"
    path.write_text(text, encoding="utf-8")
    with pytest.raises(UnreadableFile, match=says):
        read_edits(path)
