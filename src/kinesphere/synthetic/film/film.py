"""A film with its truth: a body of known shape, moving at known angles before known cameras."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from kinesphere.data import Array, Camera, Scene, Step, bundled_body
from kinesphere.data.surface import Surface
from kinesphere.errors import BadSetting
from kinesphere.synthetic.film.body_motion import BodyMotion
from kinesphere.synthetic.film.conditions import CONDITIONS, Conditions
from kinesphere.synthetic.film.movements import MOVEMENTS
from kinesphere.synthetic.film.render import RenderedFootage
from kinesphere.synthetic.film.studio import cameras_around
from kinesphere.synthetic.film.wardrobe import dressed

_RATE = 30.0
_LYING = ("push-ups",)


@dataclass(frozen=True, eq=False)
class Film:
    """A scene and what is true of it."""

    scene: Scene
    motion: BodyMotion
    """The person's true surface and motion."""
    footage: RenderedFootage

    @property
    def joint_centres(self) -> Mapping[str, Array]:
        """Limb → (n_frames, 3) m, where it begins."""
        limbs = self.motion.surface.limbs
        return {name: self.motion.joint_centres[:, i] for i, name in enumerate(limbs)}

    @property
    def elbow_angles(self) -> Array:
        """(n_frames, 2) rad, left and right: 0 where the arm is straight."""
        sides = ("left_forearm", "right_forearm")
        return np.stack([self.motion.angle_at(limb) for limb in sides], axis=-1)


def make_film(
    seed: int,
    movement: str = "arms",
    *,
    conditions: str | Conditions = "plain",
    n_frames: int = 300,
    n_cameras: int = 4,
    rate: float = _RATE,
    surface: Surface | None = None,
    shape: Mapping[str, float] | None = None,
    masks: bool = False,
    plates: bool = False,
    size: tuple[int, int] = (640, 480),
    cameras: Sequence[Camera] | None = None,
) -> Film:
    """Film a body; the images are rendered as they are asked for.

    Parameters
    ----------
    seed
        Decides cameras, clothes, room and noise.
    movement
        One of ``MOVEMENTS``.
    conditions
        One of ``CONDITIONS``, or your own.
    surface
        Who is filmed; the bundled body, if None.
    shape
        Steps along the surface's directions of shape.
    masks
        Whether the scene comes with perfect masks instead of a segmentation to be made.
    plates
        Whether it comes with images of the empty room.
    size
        Width and height of the images.
    cameras
        Instead of a ring of ``n_cameras``.

    Raises
    ------
    BadSetting
        For a movement or conditions nobody knows, or no frames.
    """
    if movement not in MOVEMENTS:
        raise BadSetting(f"no movement is called {movement!r}; known are {', '.join(MOVEMENTS)}")
    if isinstance(conditions, str):
        if conditions not in CONDITIONS:
            known = ", ".join(CONDITIONS)
            raise BadSetting(f"no conditions are called {conditions!r}; known are {known}")
        conditions = CONDITIONS[conditions]
    if n_frames < 1:
        raise BadSetting(f"a film of {n_frames} frames shows nothing; at least 1 is needed")
    body = (bundled_body() if surface is None else surface).shaped(dict(shape or {}))
    motion = MOVEMENTS[movement](body, n_frames, rate)
    rng = np.random.default_rng([seed, 0])
    if cameras is None:
        lying = movement in _LYING
        cameras = cameras_around(
            rng,
            n_cameras,
            width=size[0],
            height=size[1],
            aim=(0.0, 0.3, 0.0) if lying else (0.0, 0.88, 0.0),
            view=1.9 if lying else 2.25,
            distance=3.0 if lying else 3.2,
        )
    clothes = dressed(body, rng, pattern=conditions.pattern)
    footage = RenderedFootage(motion, tuple(cameras), clothes, conditions, seed)
    step = Step(
        "film",
        settings={"seed": seed, "movement": movement, "n_frames": n_frames},
        findings={"cameras": [camera.name for camera in cameras]},
    )
    scene = Scene(
        name=f"{movement}, seed {seed}",
        cameras=tuple(cameras),
        rate=rate,
        n_frames=n_frames,
        footage=footage if masks else _Unmasked(footage),
        plates=footage.plates if plates else (None,) * len(cameras),
        offsets=(0,) * len(cameras),
        world_from_file=np.eye(3),
        has_masks=masks,
        history=(step,),
    )
    return Film(scene, motion, footage)


@dataclass(frozen=True, eq=False)
class _Unmasked:
    """Footage whose masks are there to be compared with only."""

    footage: RenderedFootage

    def frames(self, start: int, stop: int, step: int = 1):  # type: ignore[no-untyped-def]
        for frame in self.footage.frames(start, stop, step):
            none = (None,) * len(frame.masks)
            yield replace(frame, masks=none, references=frame.masks)
