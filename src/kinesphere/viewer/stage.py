"""The scene: nodes are added once, and of each only what changed is sent."""

from collections.abc import Callable
from typing import TYPE_CHECKING, Any

import numpy as np

from kinesphere.data import Array, Skeleton, Surface, default_origins
from kinesphere.data.sticks import side_of
from kinesphere.viewer.figure import Figure, Placed, markers_placed, wxyz_from_rotations
from kinesphere.viewer.shapes import arrow, ball, bone

if TYPE_CHECKING:
    import viser

SIDES = {"left": (59, 91, 219), "right": (217, 72, 15), "middle": (137, 148, 168)}
AXES = ((232, 89, 12), (16, 152, 173), (156, 54, 181))
PICKED = (250, 176, 5)
BODY, BODY_OPACITY = (196, 203, 214), 0.5
MARKER, LOOSE = {False: (44, 54, 78), True: (236, 240, 248)}, (150, 156, 168)
_GRIDS = {
    False: ((214, 219, 228), (176, 184, 198)),
    True: ((62, 70, 84), (86, 96, 114)),
}
MARKER_RADIUS = 0.009
FRAME_LENGTH = 0.09
"""m."""

Shown = tuple[Array | None, Array | None, Array]
"""Rotations and origins of the limbs, None without a skeleton; markers."""


class Stage:
    """Everything of one take that moves."""

    def __init__(
        self,
        server: "viser.ViserServer",
        skeleton: Skeleton | None,
        labels: tuple[str, ...],
        centre: Array,
        floor: float,
        *,
        surface: Surface | None = None,
        dark: bool = False,
    ) -> None:
        self.server = server
        self.figure = None if skeleton is None else Figure(skeleton)
        self.kinds = {"markers": True} if labels else {}
        """What there is to show, and whether it is shown."""
        if skeleton is not None:
            self.kinds["skeleton"] = True
            if any(joint.n_axes for joint in skeleton.joints):
                self.kinds["axes"] = False
            self.kinds["frames"] = False
        self._nodes: dict[str, Any] = {}
        scene = server.scene
        scene.set_up_direction("+y")
        cell, section = _GRIDS[dark]
        scene.add_grid(
            "/floor", width=8, height=8, plane="xz", cell_size=0.5, section_size=2.0,
            position=(float(centre[0]), floor, float(centre[2])), cell_color=cell,
            section_color=section,
        )  # fmt: skip
        worn = {m for limb in skeleton.limbs for m in limb.markers} if skeleton else {*labels}
        colours = np.array([MARKER[dark] if label in worn else LOOSE for label in labels])
        if len(labels):
            self._add("markers", ball(), len(labels), colours.reshape(-1, 3), flat=False)
        if skeleton is None or self.figure is None:
            return
        limbs = [skeleton.limbs[i].name for i in self.figure.stick_limbs]
        self._stick_colours = np.array([SIDES[side_of(name)] for name in limbs])
        self._add("skeleton", bone(), len(limbs), self._stick_colours, flat=True)
        arrows = np.array([AXES[k] for k in self.figure.axis_numbers]).reshape(-1, 3)
        if len(arrows):
            self._add("axes", arrow(), len(arrows), arrows, flat=False)
        if surface is not None:
            self._add_body(surface, skeleton)
        n = len(skeleton.limbs)
        self._nodes["frames"] = scene.add_batched_axes(
            "/frames", np.tile((1.0, 0, 0, 0), (n, 1)), np.zeros((n, 3)),
            np.ones((n, 3)), axes_length=FRAME_LENGTH, axes_radius=0.004, visible=False,
        )  # fmt: skip

    def _add(
        self, name: str, mesh: tuple[Array, Any], count: int, colours: Array, *, flat: bool
    ) -> None:
        self._nodes[name] = self.server.scene.add_batched_meshes_simple(
            f"/{name}", *mesh, np.tile((1.0, 0, 0, 0), (count, 1)), np.zeros((count, 3)),
            batched_scales=np.ones((count, 3)), batched_colors=colours.astype(np.uint8),
            flat_shading=flat, lod="off", visible=self.kinds[name], cast_shadow=False,
            receive_shadow=False,
        )  # fmt: skip

    def _add_body(self, surface: Surface, skeleton: Skeleton) -> None:
        self.kinds["mesh"] = True
        n = len(skeleton.limbs)
        self._nodes["mesh"] = self.server.scene.add_mesh_skinned(
            "/mesh", surface.vertices, surface.faces, bone_wxyzs=np.tile((1.0, 0, 0, 0), (n, 1)),
            bone_positions=default_origins(skeleton), skin_weights=surface.weights, color=BODY,
            opacity=BODY_OPACITY, cast_shadow=False, receive_shadow=False,
        )  # fmt: skip

    def _pose_body(self, rotations: Array, origins: Array) -> None:
        """Turn the body's limbs; one without a pose stays where it was in the scene."""
        known = np.isfinite(rotations).all(axis=(1, 2)) & np.isfinite(origins).all(axis=1)
        wxyzs = wxyz_from_rotations(rotations)
        for limb in np.flatnonzero(known):
            bone = self._nodes["mesh"].bones[limb]
            bone.wxyz, bone.position = wxyzs[limb], origins[limb]

    def show(self, shown: Shown) -> None:
        """Move everything on view to a pose."""
        rotations, origins, markers = shown
        with self.server.atomic():
            if self._on("markers"):
                self._place("markers", markers_placed(markers, MARKER_RADIUS))
            if self.figure is None or rotations is None or origins is None:
                return
            if self._on("mesh"):
                self._pose_body(rotations, origins)
            for name, of in (
                ("skeleton", self.figure.sticks),
                ("frames", self.figure.frames),
                ("axes", self.figure.axes),
            ):
                if self._on(name):
                    self._place(name, of(rotations, origins))

    def set_visible(self, name: str, visible: bool, shown: Shown) -> None:
        """Show or hide a kind of thing."""
        self.kinds[name] = visible
        if name in self._nodes:
            self.show(shown)
            self._nodes[name].visible = visible

    def pick_limb(self, limb: int | None) -> None:
        """Colour a limb as picked."""
        if self.figure is None:
            return
        colours = self._stick_colours.copy()
        if limb is not None:
            colours[self.figure.stick_limbs == limb] = PICKED
        self._nodes["skeleton"].batched_colors = colours.astype(np.uint8)

    def on_limb(self, call: Callable[[int], None]) -> None:
        """Call with the index of a limb whenever one is clicked."""
        if self.figure is None:
            return
        limbs = self.figure.stick_limbs

        async def clicked(event: Any) -> None:
            if event.instance_index is not None:
                call(int(limbs[event.instance_index]))

        self._nodes["skeleton"].on_click(clicked)

    def on_marker(self, call: Callable[[int], None]) -> None:
        """Call with the index of a marker whenever one is clicked."""

        async def clicked(event: Any) -> None:
            if event.instance_index is not None:
                call(int(event.instance_index))

        if "markers" in self._nodes:
            self._nodes["markers"].on_click(clicked)

    def _on(self, name: str) -> bool:
        return self.kinds.get(name, False)

    def _place(self, name: str, placed: Placed) -> None:
        node = self._nodes[name]
        node.batched_positions = placed.positions.astype(np.float32)
        node.batched_wxyzs = placed.wxyzs.astype(np.float32)
        # sizes change only where a pose comes or goes
        scales = placed.scales.astype(np.float32)
        if not np.array_equal(node.batched_scales, scales):
            node.batched_scales = scales
