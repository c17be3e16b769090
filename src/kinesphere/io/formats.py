"""The formats Kinesphere knows, each with the marks it is recognised by."""

from pathlib import Path

from kinesphere.io.meshes.marks import is_obj, is_ply, is_stl
from kinesphere.io.registry import Format, register


def _is_c3d(head: bytes) -> bool:
    # byte 1 points at the parameter section, byte 2 is always 80, a P: in text, which holds no null
    # character, and in PNG images as well
    marked = len(head) > 1 and head[0] > 1 and head[1] == 80
    return marked and b"\0" in head and not head.startswith(b"\x89PNG")


register(
    Format(
        name="C3D",
        suffixes=(".c3d",),
        recognises=_is_c3d,
        reader="kinesphere.io.c3d:read_c3d",
        writers={"Recording": "kinesphere.io.c3d:write_c3d"},
    )
)


def _is_trc(head: bytes) -> bool:
    return _text(head).startswith(b"PathFileType")


def _is_parameters(head: bytes) -> bool:
    return _text(head).startswith(b"time_s,root.x_m,")


def _is_csv(head: bytes) -> bool:
    return _text(head).startswith(b"time_s,") and b".x_m" in head.split(b"\n", 1)[0]


def _is_model(head: bytes) -> bool:
    named = b'"kinesphere-model-' in head or (b'"format"' not in head and b'"segments"' in head)
    return _text(head).startswith(b"{") and named


def _is_skeleton(head: bytes) -> bool:
    named = b'"kinesphere-skeleton-' in head or (b'"format"' not in head and b'"limbs"' in head)
    return _text(head).startswith(b"{") and named


def _is_solution(folder: Path) -> bool:
    return (folder / "solution.npz").is_file()


def _is_bvh(head: bytes) -> bool:
    return _text(head)[:9].upper() == b"HIERARCHY"


def _is_gltf(head: bytes) -> bool:
    return head.startswith(b"glTF") or (_text(head).startswith(b"{") and b'"asset"' in head)


def _is_asf(head: bytes) -> bool:
    return _has_section(head, b":version", b":units", b":root", b":bonedata")


def _is_amc(head: bytes) -> bool:
    return _has_section(head, b":fully-specified", b":degrees", b":radians")


def _has_section(head: bytes, *names: bytes) -> bool:
    lines = [line.strip().lower() for line in head.splitlines()]
    told = next((line for line in lines if line and not line.startswith(b"#")), b"")
    return told.startswith(names)


def _text(head: bytes) -> bytes:
    return head.removeprefix(b"\xef\xbb\xbf").lstrip()


register(
    Format(
        name="TRC",
        suffixes=(".trc",),
        recognises=_is_trc,
        reader="kinesphere.io.trc:read_trc",
        writers={"Recording": "kinesphere.io.trc:write_trc"},
    )
)
register(
    Format(
        name="parameter table",
        suffixes=(".csv",),
        recognises=_is_parameters,
        reader="kinesphere.io.parameters_csv:read_parameters",
        writers={"Parameters": "kinesphere.io.parameters_csv:write_parameters"},
    )
)
register(
    Format(
        name="clinical angle table",
        suffixes=(".csv",),
        writers={"IsbAngles": "kinesphere.io.isb_csv:write_isb_angles"},
    )
)
register(
    Format(
        name="CSV",
        suffixes=(".csv",),
        recognises=_is_csv,
        reader="kinesphere.io.csv:read_csv",
        writers={"Recording": "kinesphere.io.csv:write_csv"},
    )
)
register(
    Format(
        name="topological model",
        suffixes=(".json",),
        recognises=_is_model,
        reader="kinesphere.io.model_json:read_model",
        writers={"TopologicalModel": "kinesphere.io.model_json:write_model"},
    )
)
register(
    Format(
        name="skeleton",
        suffixes=(".json",),
        recognises=_is_skeleton,
        reader="kinesphere.io.skeleton_json:read_skeleton",
        writers={"Skeleton": "kinesphere.io.skeleton_json:write_skeleton"},
    )
)
register(
    Format(
        name="BVH",
        suffixes=(".bvh",),
        recognises=_is_bvh,
        reader="kinesphere.io.bvh_motion:read_bvh",
        writers={"Motion": "kinesphere.io.bvh:write_bvh"},
    )
)
register(
    Format(
        name="Acclaim motion",
        suffixes=(".amc",),
        recognises=_is_amc,
        reader="kinesphere.io.amc:read_amc",
    )
)
register(
    Format(
        name="Acclaim skeleton",
        suffixes=(".asf",),
        recognises=_is_asf,
        reader="kinesphere.io.asf:read_asf",
    )
)
register(
    Format(
        name="glTF",
        suffixes=(".glb", ".gltf"),
        recognises=_is_gltf,
        reader="kinesphere.io.meshes.gltf:read_gltf",
        writers={
            "Motion": "kinesphere.io.gltf:write_gltf",
            "Solution": "kinesphere.io.gltf:write_solution_gltf",
        },
    )
)
register(
    Format(
        name="limb frame table",
        suffixes=(".limbs.csv",),
        writers={"Motion": "kinesphere.io.limbs_csv:write_limbs"},
    )
)
register(
    Format(
        name="OpenSim model",
        suffixes=(".osim",),
        writers={"Skeleton": "kinesphere.io.opensim:write_osim"},
    )
)
register(
    Format(
        name="OpenSim motion",
        suffixes=(".mot",),
        writers={"Parameters": "kinesphere.io.opensim_motion:write_mot"},
    )
)
register(
    Format(
        name="solution folder",
        suffixes=("",),
        recognises_folder=_is_solution,
        reader="kinesphere.io.solution:read_solution",
        writers={"Solution": "kinesphere.io.solution:write_solution"},
    )
)
for _name, _suffix, _is_one in (
    ("PLY", ".ply", is_ply),
    ("OBJ", ".obj", is_obj),
    ("STL", ".stl", is_stl),  # last of all: binary STL is told by a triangle that may be one
):
    register(
        Format(
            name=_name,
            suffixes=(_suffix,),
            recognises=_is_one,
            reader="kinesphere.io.meshes.read:read_mesh",
        )
    )
