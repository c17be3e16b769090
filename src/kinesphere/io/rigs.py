"""Rigs: skeletons of other programs to put a motion on, given back in their own format."""

from pathlib import Path
from typing import Literal

from kinesphere.data import Motion, Skeleton
from kinesphere.errors import UnknownFormat
from kinesphere.io.bvh_motion import read_bvh_skeleton
from kinesphere.io.registry import HEAD_BYTES, read_bytes
from kinesphere.io.rig_bvh import write_bvh_rig
from kinesphere.io.rig_gltf import read_gltf_skeleton, write_gltf_rig

RigFormat = Literal["bvh", "glb", "gltf"]


def rig_format(path: str | Path) -> RigFormat | None:
    """Return the format of a rig by its content; None if it is no rig."""
    path = Path(path)
    if path.is_dir():
        return None
    head = read_bytes(path, HEAD_BYTES)
    text = head.removeprefix(b"\xef\xbb\xbf").lstrip()
    if head.startswith(b"glTF"):
        return "glb"
    if text[:9].upper() == b"HIERARCHY":
        return "bvh"
    return "gltf" if text.startswith(b"{") and path.suffix.lower() == ".gltf" else None


def read_rig(path: str | Path) -> Skeleton:
    """Read the skeleton of a BVH or glTF file.

    Its limb frames stand parallel in the file's rest pose, as those of a normalized skeleton do.

    Raises
    ------
    UnknownFormat
        If it is neither.
    UnreadableFile
        If it is damaged, or holds no skeleton.
    """
    match rig_format(path):
        case "bvh":
            return read_bvh_skeleton(path)
        case "glb" | "gltf":
            return read_gltf_skeleton(path)
    raise UnknownFormat(f"{path} is no rig; a BVH, .glb or .gltf file with a skeleton is")


def write_on_rig(motion: Motion, rig: str | Path, path: str | Path) -> tuple[str, ...]:
    """Write a motion of a rig's skeleton in the rig's own format, everything else as it stands.

    Parameters
    ----------
    motion
        On the skeleton that ``read_rig`` gives.
    rig
        The file it came from.

    Returns
    -------
    tuple of str
        What the rig has no place for.
    """
    write = write_bvh_rig if rig_format(rig) == "bvh" else write_gltf_rig
    return write(motion, Path(rig), Path(path))
