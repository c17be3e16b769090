"""Markers as nodes of a glTF file: small octahedra that move, and vanish where unseen."""

from typing import Any

import numpy as np

from kinesphere.data import Recording
from kinesphere.data.gaps import held
from kinesphere.io.gltf.document import INDICES, VERTICES, Document

_RADIUS = 0.007  # m
_CORNERS = np.array(
    [[1, 0, 0], [-1, 0, 0], [0, 1, 0], [0, -1, 0], [0, 0, 1], [0, 0, -1]], dtype=np.float32
)
_SIDES = np.array(
    [[0, 2, 4], [2, 1, 4], [1, 3, 4], [3, 0, 4], [2, 0, 5], [1, 2, 5], [3, 1, 5], [0, 3, 5]]
)


def add_markers(
    document: Document,
    recording: Recording,
    times: int | None,
    channels: list[dict[str, Any]],
    samplers: list[dict[str, Any]],
) -> int | None:
    """Add a node per marker below one called ``markers``; return its index, None without any.

    Parameters
    ----------
    recording
        In the world, y up; its frames are those of the motion.
    times
        Accessor of the frames' times; None where there is no frame.
    channels, samplers
        Of the animation; appended to. Unseen markers keep their last place at a size of zero.
    """
    seen = recording.seen
    shown = np.flatnonzero(seen.any(axis=0))
    if times is None or not len(shown):
        return None
    mesh = _octahedron(document)
    nodes = []
    for m in shown:
        places = held(recording.markers[:, m], np.zeros(3)).astype(np.float32)
        content = {"name": recording.labels[m], "mesh": mesh, "translation": places[0].tolist()}
        node = document.add("nodes", content)
        nodes.append(node)
        _animate(document, node, "translation", times, places, "LINEAR", channels, samplers)
        if not seen[:, m].all():
            sizes = np.repeat(seen[:, m, None], 3, axis=1).astype(np.float32)
            _animate(document, node, "scale", times, sizes, "STEP", channels, samplers)
    return document.add("nodes", {"name": "markers", "children": nodes})


def _animate(
    document: Document,
    node: int,
    path: str,
    times: int,
    values: Any,
    interpolation: str,
    channels: list[dict[str, Any]],
    samplers: list[dict[str, Any]],
) -> None:
    channels.append({"sampler": len(samplers), "target": {"node": node, "path": path}})
    samplers.append(
        {"input": times, "output": document.array(values), "interpolation": interpolation}
    )


def _octahedron(document: Document) -> int:
    material = document.add(
        "materials",
        {
            "name": "marker",
            "pbrMetallicRoughness": {
                "baseColorFactor": [0.85, 0.25, 0.1, 1.0],
                "metallicFactor": 0.0,
                "roughnessFactor": 0.6,
            },
        },
    )
    corners = _CORNERS * np.float32(_RADIUS)
    primitive = {
        "attributes": {
            "POSITION": document.array(corners, VERTICES, bounds=True),
            "NORMAL": document.array(_CORNERS, VERTICES),
        },
        "indices": document.array(_SIDES.ravel().astype(np.uint16), INDICES),
        "material": material,
    }
    return document.add("meshes", {"name": "marker", "primitives": [primitive]})
