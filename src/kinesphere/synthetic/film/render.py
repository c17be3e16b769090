"""Images of a moving body, rendered as they are asked for; every frame by itself, and the same."""

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import uniform_filter

from kinesphere.data import Array, Camera, Frame, Image, Mask
from kinesphere.geometry.raster import silhouette, visible_faces
from kinesphere.synthetic.film.body_motion import BodyMotion
from kinesphere.synthetic.film.conditions import Conditions
from kinesphere.synthetic.film.furniture import Furniture, posts_before
from kinesphere.synthetic.film.kernels import shade_kernel
from kinesphere.synthetic.film.studio import empty_room
from kinesphere.synthetic.film.wardrobe import Clothes, cloth_offsets

_THINGS = 4
"""Moving things behind the person, a camera."""
_LAMP = np.array([0.35, 0.85, 0.4])


@dataclass(frozen=True, eq=False)
class RenderedFootage:
    """What cameras see of a body; perfect masks go with it."""

    motion: BodyMotion
    cameras: tuple[Camera, ...]
    clothes: Clothes
    conditions: Conditions
    seed: int
    with_images: bool = True
    """Without, only masks are made: for perfect silhouettes, and quickly."""

    def frames(self, start: int, stop: int, step: int = 1) -> Iterator[Frame]:
        """Yield frames ``start``, ``start + step``, … before ``stop``."""
        for index in range(start, stop, step):
            skin = self.skin(index)
            shown = [self._seen(camera, skin) for camera in self.cameras]
            images = tuple(
                self._image(c, index, skin, *seen) if self.with_images else None
                for c, seen in enumerate(shown)
            )
            masks = tuple(
                silhouette(pixels, self.faces, camera.width, camera.height)
                & ~self._hidden(camera, pixels, depths)
                for camera, (pixels, depths) in zip(self.cameras, shown, strict=True)
            )
            yield Frame(index, images, masks)

    @cached_property
    def faces(self) -> NDArray[np.int32]:
        """(n_faces, 3) of the surface, as kernels want them."""
        return np.ascontiguousarray(self.motion.surface.faces, dtype=np.int32)

    def skin(self, frame: int) -> Array:
        """Return the visible surface of a frame, clothes included, (n_vertices, 3) m."""
        skin = self.motion.vertices(frame)
        if self.conditions.loose > 0:
            time = frame / self.motion.rate
            off = cloth_offsets(self.motion.surface, self.clothes, self.conditions.loose, time)
            skin = skin + off[:, None] * self.motion.surface.normals(skin)
        return np.ascontiguousarray(skin)

    @cached_property
    def plates(self) -> tuple[Image, ...]:
        """The empty room as each camera sees it, without noise."""
        out = []
        for camera, (picture, _) in zip(self.cameras, self._rooms, strict=True):
            nobody, seen = np.empty((0, 3)), (np.empty((0, 2)), np.empty(0))
            shown = self._drawn(camera, nobody, *seen, self._light(0.0, False), picture.copy())
            out.append(np.round(shown).astype(np.uint8))
        return tuple(out)

    @cached_property
    def _rooms(self) -> tuple[tuple[Array, Mask], ...]:
        return tuple(
            empty_room(camera, np.random.default_rng([self.seed, 1]), self.conditions.clutter)
            for camera in self.cameras
        )

    def _seen(self, camera: Camera, skin: Array) -> tuple[Array, Array]:
        return camera.project(skin), camera.depths(skin)

    def _image(self, c: int, index: int, skin: Array, pixels: Array, depths: Array) -> Image:
        camera, how = self.cameras[c], self.conditions
        time = index / self.motion.rate
        lamp, gain, ambient = self._light(time, index >= self.motion.n_frames // 2)
        picture = self._rooms[c][0].copy()
        if how.moving:
            self._move_things(c, time, picture)
        if how.shadows > 0:
            self._cast_shadow(c, skin, lamp, picture)
        picture = self._drawn(camera, skin, pixels, depths, (lamp, gain, ambient), picture)
        rng = np.random.default_rng([self.seed, 2, index, c])
        noise = rng.standard_normal(picture.shape, dtype=np.float32)
        return np.clip(picture * gain + how.noise * noise, 0, 255).astype(np.uint8)

    def _drawn(
        self,
        camera: Camera,
        skin: Array,
        pixels: Array,
        depths: Array,
        light: tuple[Array, float, float],
        picture: Array,
    ) -> Array:
        """Draw the person, if there is a skin, and what stands before it, into a picture."""
        lamp, _, ambient = light
        there, things = len(skin) > 0, self._furniture
        own = self.motion.surface
        faces = self.faces if there else self.faces[:0]
        pixels = np.concatenate([pixels, camera.project(things.vertices)])
        depths = np.concatenate([depths, camera.depths(things.vertices)])
        faces = np.concatenate([faces, things.faces + len(skin)])
        normals = np.concatenate([own.normals(skin) if there else skin, things.normals])
        rest = np.concatenate([own.vertices if there else skin, things.vertices])
        colours = np.concatenate([self.clothes.colours[: len(skin)] * 1.15, things.colours])
        patterned = np.append(self.clothes.patterned[: len(skin)], np.zeros(len(things.vertices)))
        # a pixel's samples lie around its centre: pixel p is at finer · p + (finer − 1) / 2
        finer = self.conditions.finer
        fine = pixels * finer + (finer - 1) / 2
        ids, _ = visible_faces(fine, depths, faces, camera.width * finer, camera.height * finer)
        shade_kernel(
            ids,
            finer,
            fine,
            depths,
            faces,
            normals,
            rest,
            colours,
            patterned,
            lamp,
            ambient,
            picture,
        )
        return picture

    @cached_property
    def _furniture(self) -> Furniture:
        before = self.cameras[: self.conditions.posts]
        return posts_before(before, np.random.default_rng([self.seed, 4]))

    def _hidden(self, camera: Camera, pixels: Array, depths: Array) -> Mask:
        """Return where something stands before the person, or beside them."""
        things = self._furniture
        if not len(things.faces):
            return np.zeros((camera.height, camera.width), dtype=bool)
        ids, _ = visible_faces(
            np.concatenate([pixels, camera.project(things.vertices)]),
            np.concatenate([depths, camera.depths(things.vertices)]),
            np.concatenate([self.faces, things.faces + len(pixels)]),
            camera.width,
            camera.height,
        )
        return np.asarray(ids >= len(self.faces))

    def _light(self, time: float, second_half: bool) -> tuple[Array, float, float]:
        """Return where the light comes from, how bright it is, and its share from everywhere."""
        lamp, gain, ambient = _LAMP, 1.0, 0.55
        if self.conditions.changing_light:
            around = 0.5 * np.sin(2 * np.pi * 0.11 * time)
            turn = np.array([[np.cos(around), 0, np.sin(around)], [0, 1, 0],
                             [-np.sin(around), 0, np.cos(around)]])  # fmt: skip
            lamp = turn @ lamp
            gain = 1.0 + 0.18 * np.sin(2 * np.pi * 0.27 * time) - 0.15 * second_half
            ambient = 0.5 + 0.1 * np.sin(2 * np.pi * 0.19 * time)
        return lamp / np.linalg.norm(lamp), gain, ambient

    def _cast_shadow(self, c: int, skin: Array, lamp: Array, picture: Array) -> None:
        camera, floor = self.cameras[c], self._rooms[c][1]
        ground = skin - (skin[:, 1:2] / lamp[1]) * lamp
        ground[:, 1] = 0.0
        dark = silhouette(camera.project(ground), self.faces, camera.width, camera.height,
                          closed=False)  # fmt: skip
        soft = uniform_filter(dark.astype(np.float32), 7) * floor
        picture *= (1.0 - self.conditions.shadows * soft)[..., None]

    def _move_things(self, c: int, time: float, picture: Array) -> None:
        height, width = picture.shape[:2]
        rng = np.random.default_rng([self.seed, 3, c])
        for _ in range(_THINGS):
            wide, tall = int(width * rng.uniform(0.05, 0.14)), int(height * rng.uniform(0.12, 0.42))
            cell = max(1, width // 64)
            cells = rng.uniform(20, 230, (tall // cell + 1, wide // cell + 1, 3))
            look = cells.repeat(cell, axis=0).repeat(cell, axis=1)[:tall, :wide]
            middle, swing = rng.uniform([0, 0], [width, height]), width * rng.uniform(0.06, 0.34)
            pace, phase = rng.uniform(0.1, 0.5), rng.uniform(0, 2 * np.pi)
            left = int(middle[0] - wide / 2 + swing * np.sin(2 * np.pi * pace * time + phase))
            top = int(middle[1] - tall / 2 + 0.2 * swing * np.sin(2 * np.pi * pace * time))
            x0, x1 = max(0, left), min(width, left + wide)
            y0, y1 = max(0, top), min(height, top + tall)
            if x0 < x1 and y0 < y1:
                picture[y0:y1, x0:x1] = look[y0 - top : y1 - top, x0 - left : x1 - left]
