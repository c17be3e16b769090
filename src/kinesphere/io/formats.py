"""The formats Kinesphere knows, each with the marks it is recognised by."""

from kinesphere.io.registry import Format, register


def _is_c3d(head: bytes) -> bool:
    # byte 1 points at the parameter section, byte 2 is always 80; text holds no null character
    return len(head) > 1 and head[0] > 1 and head[1] == 80 and b"\0" in head


register(
    Format(
        name="C3D",
        suffixes=(".c3d",),
        recognises=_is_c3d,
        reader="kinesphere.io.c3d:read_c3d",
        writers={"Recording": "kinesphere.io.c3d:write_c3d"},
    )
)
