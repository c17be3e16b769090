"""Segment rotations that some files carry behind their points: taken along as they are."""

from kinesphere.io.c3d.header import BLOCK
from kinesphere.io.c3d.layout import Layout
from kinesphere.io.c3d.parameters import Section, words
from kinesphere.io.c3d.processor import INTEL

_GROUP = "ROTATION"


def rotations_from_bytes(content: bytes, layout: Layout, warnings: list[str]) -> bytes:
    """Return what ROTATION:DATA_START points at, to the end of the file; nothing if unused."""
    section = layout.section
    if not section.count(_GROUP, "USED"):
        return b""
    start = ((section.count(_GROUP, "DATA_START") or 0) - 1) * BLOCK
    if not layout.end <= start < len(content) or layout.processor is not INTEL:
        warnings.append("the rotations that the file speaks of cannot be taken along")
        return b""
    warnings.append("the file's rotations are taken along, but not looked at")
    return content[start:]


def with_rotations(section: Section, rotations: bytes, block: int) -> Section:
    """Return the parameters pointing at rotations that start at ``block``, or at none."""
    if rotations:
        return section.with_parameters(_GROUP, words("DATA_START", block))
    if section.count(_GROUP, "USED"):
        return section.with_parameters(_GROUP, words("USED", 0))
    return section
