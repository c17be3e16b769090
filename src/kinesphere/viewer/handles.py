"""Handles in the scene: a ring about each axis of the picked joint, to be dragged."""

from collections.abc import Callable
from typing import TYPE_CHECKING, Any

import numpy as np

from kinesphere.data import Array
from kinesphere.geometry.rotations import rotation_between, tangent_basis
from kinesphere.viewer.figure import wxyz_from_rotations
from kinesphere.viewer.shapes import ring

if TYPE_CHECKING:
    import viser

COLOURS = ((232, 89, 12), (16, 152, 173), (156, 54, 181))
"""Of a joint's first, second and third axis."""
TWIST = (116, 128, 148)
RADIUS, WIDER = 0.15, 0.035
"""m; of the innermost ring, and from one to the next."""
_TUBE = 0.035  # of a radius
_EDGE_ON = 0.17  # sine of the angle below which a ring is dragged beside, not within, its plane

Turned = Callable[[int, float, bool], None]
"""Called with which axis, by how many degrees since it was grabbed, and whether it was let go."""


class Handles:
    """Rings about the axes of one joint; placed anew for every pose, save while one is held."""

    def __init__(self, server: "viser.ViserServer", count: int, turned: Turned) -> None:
        self._turned = turned
        self._held: int | None = None
        self._centre = np.zeros(3)
        self._way = np.array([1.0, 0.0, 0.0])
        self._before = np.zeros(3)
        self._angle = 0.0
        self.ways: Array = np.empty((0, 3))
        """(n, 3) in the world, the axes the rings go about."""
        self._nodes = [self._add(server, k) for k in range(count)]

    def place(self, centre: Array, ways: Array) -> None:
        """Put a ring about each axis, (n, 3) in the world; the last is the twist."""
        self.ways = ways
        there = bool(np.isfinite(centre).all() and np.isfinite(ways).all())
        for k, node in enumerate(self._nodes):
            node.visible = there and k < len(ways)
            if not node.visible or k == self._held:
                continue
            node.position = centre
            node.wxyz = wxyz_from_rotations(rotation_between(np.array([1.0, 0, 0]), ways[k])[None])[
                0
            ]
            node.color = TWIST if k == len(ways) - 1 else COLOURS[k]

    def hide(self) -> None:
        """Show none."""
        for node in self._nodes:
            node.visible = False

    def point_on(self, k: int, angle: float) -> Array:
        """Return a point of the k-th ring, (3,) m in the world; angles (rad) go about its axis."""
        first, second = tangent_basis(self.ways[k])
        around = np.cos(angle) * first + np.sin(angle) * second
        return np.asarray(self._nodes[k].position + (RADIUS + WIDER * k) * around)

    def _add(self, server: "viser.ViserServer", k: int) -> Any:
        vertices, faces = ring(_TUBE)
        node = server.scene.add_mesh_simple(
            f"/handles/{k}", (RADIUS + WIDER * k) * vertices, faces, color=TWIST, opacity=0.9,
            visible=False, cast_shadow=False, receive_shadow=False,
        )  # fmt: skip

        async def dragged(event: Any) -> None:
            if event.phase == "start":
                self._grab(k, np.array(event.start_position))
            if self._held != k:
                return
            eye, at = np.array(event.client.camera.position), np.array(event.end_position)
            now = within_plane(eye, at, self._centre, self._way)
            self._angle += turn_about(self._way, self._before, now)
            self._before = now
            ended = event.phase == "end"
            if ended:
                self._held = None
            self._turned(k, float(np.rad2deg(self._angle)), ended)

        node.on_drag(dragged)
        return node

    def _grab(self, k: int, at: Array) -> None:
        self._held, self._angle = k, 0.0
        self._centre, self._way = np.array(self._nodes[k].position), self.ways[k]
        self._before = _flat(at - self._centre, self._way)


def within_plane(eye: Array, at: Array, centre: Array, way: Array) -> Array:
    """Return where the line from the eye through a point meets a ring's plane, from its centre.

    A plane seen edge-on is met nowhere near: the point itself is taken then, without what leads
    out of the plane.
    """
    line = at - eye
    slope = float(line @ way)
    if abs(slope) < _EDGE_ON * float(np.linalg.norm(line)):
        return _flat(at - centre, way)
    return np.asarray(eye + line * ((centre - eye) @ way / slope) - centre)


def turn_about(way: Array, before: Array, now: Array) -> float:
    """Return by how much one vector must turn about an axis to point as another does, rad."""
    return float(np.arctan2(np.cross(before, now) @ way, before @ now))


def _flat(vector: Array, way: Array) -> Array:
    flat: Array = vector - (vector @ way) * way
    return flat
