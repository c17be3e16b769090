"""``SCENE.toml`` to a scene: every file it names is opened, and what does not fit is said."""

import tomllib
from dataclasses import replace
from pathlib import Path

from pydantic import ValidationError

from kinesphere.data import Camera, Json, Scene, Step
from kinesphere.data.directions import world_from_up
from kinesphere.data.validation import first_problem
from kinesphere.errors import BadScene, UnreadableFile
from kinesphere.io.gltf.body import read_body
from kinesphere.io.scene.calibrated import calibrated_cameras
from kinesphere.io.scene.choices import body_choice, start_choice
from kinesphere.io.scene.footage import RecordedFootage, mask_offset
from kinesphere.io.scene.keypoints import start_keypoints
from kinesphere.io.scene.opened import open_camera, plate_of
from kinesphere.io.scene.spec import SceneSpec
from kinesphere.io.scene.timing import common_rate, common_span
from kinesphere.io.scene.world import camera_in_world, settle_unit, settle_up
from kinesphere.io.text import read_text

_FEWEST = 2
"""Cameras that see how far away something is."""


def read_scene(path: str | Path) -> Scene:
    """Read a scene; images are decoded only when they are asked for.

    Raises
    ------
    UnreadableFile
        If the file, or one it names, is missing, damaged or not what it should be.
    BadScene
        If cameras, calibrations, images and times do not fit together.
    """
    path = Path(path)
    spec = read_scene_spec(path)
    folder = path.parent
    found, unit, up, where = calibrated_cameras(spec, folder)
    known = {camera.name for camera in found}
    named = [camera.name for camera in spec.camera]
    if twice := sorted({name for name in named if named.count(name) > 1}):
        raise BadScene(f"{path}: camera {', '.join(twice)} is there twice")
    if len(named) < _FEWEST:
        raise BadScene(f"{path}: {len(named)} camera cannot see how far away things are; two can")
    if missing := [name for name in named if name not in known]:
        raise BadScene(
            f"{path}: camera {', '.join(missing)} is not calibrated; {where} knows "
            f"{', '.join(sorted(known))}"
        )
    _check_own_files(spec, path)
    warnings: list[str] = []
    if unseen := sorted(known - set(named)):
        warnings.append(f"{', '.join(unseen)} is calibrated, but the scene has no images of it")
    by_name = {camera.name: camera for camera in found}
    opened = [open_camera(camera, by_name[camera.name], folder) for camera in spec.camera]

    units = settle_unit(unit, found, where)
    up_axis, guessed = settle_up(up, found, where)
    warnings += [*units.warnings, *guessed]
    turn = world_from_up(up_axis)
    cameras: list[Camera] = []
    for one in opened:
        camera, scaled = camera_in_world(
            one.calibrated, one.stream.size, one.spec.calibration_pixel, units.metres, turn
        )
        cameras.append(camera)
        warnings += scaled
    body = body_choice(spec, folder)
    rate, doubted = common_rate(spec, opened, path)
    warnings += doubted
    first, n_frames, uneven = common_span(spec, opened, path)
    warnings += uneven
    offsets = tuple(one.spec.offset + first for one in opened)
    footage = RecordedFootage(
        tuple(cameras),
        tuple(one.stream for one in opened),
        tuple(one.masks for one in opened),
        offsets,
        tuple(
            0
            if one.masks is None
            else mask_offset(one.masks, one.stream, offset, one.spec.first_mask)
            for one, offset in zip(opened, offsets, strict=True)
        ),
        tuple(one.reference for one in opened),
        tuple(
            0
            if one.reference is None
            else mask_offset(one.reference, one.stream, offset, one.spec.first_mask)
            for one, offset in zip(opened, offsets, strict=True)
        ),
    )
    warnings += [sentence for one in opened for sentence in one.stream.notes]
    start = start_choice(spec, turn, first, n_frames)
    if spec.start.keypoints is not None:
        covered = min(one.stream.n_frames - one.spec.offset for one in opened)
        keypoints, doubts = start_keypoints(
            folder / spec.start.keypoints,
            spec.start.keypoints_axes,
            opened,
            cameras,
            turn,
            start.frame + first,
            covered,
        )
        start = replace(start, keypoints=keypoints)
        warnings += doubts
    step = Step(
        "scene",
        settings={"file": path.name, "calibration": where},
        findings={
            "cameras": list[Json](named),
            "n_frames": n_frames,
            "rate_hz": rate,
            "unit": units.name,
            "up": up_axis,
            "offsets": list(offsets),
            "world_from_file": turn.tolist(),
        },
        warnings=tuple(warnings),
    )
    return Scene(
        name=spec.name or path.resolve().parent.name,
        cameras=tuple(cameras),
        rate=rate,
        n_frames=n_frames,
        footage=footage,
        plates=tuple(plate_of(one, folder) for one in opened),
        offsets=offsets,
        world_from_file=turn,
        body=body,
        surface=None if body.model in ("full", "upper") else read_body(body.model),
        start=start,
        has_masks=any(one.masks is not None for one in opened),
        first_frame=offsets[0],
        history=(step,),
    )


def _check_own_files(spec: SceneSpec, path: Path) -> None:
    """Refuse images or masks that two cameras are said to have taken."""
    for what in ("images", "masks", "reference_masks", "plate"):
        owners: dict[Path, str] = {}
        for camera in spec.camera:
            if (said := getattr(camera, what)) is None:
                continue
            owner = owners.setdefault((path.parent / said).resolve(), camera.name)
            if owner != camera.name:
                raise BadScene(
                    f"{path}: {owner} and {camera.name} have the same {what}, {said}; each camera "
                    "needs its own"
                )


def read_scene_spec(path: str | Path) -> SceneSpec:
    """Return what a ``SCENE.toml`` says, before any file it names is opened.

    Raises
    ------
    UnreadableFile
        If it is no TOML or a key in it means nothing; it says which and where.
    """
    path = Path(path)
    try:
        said = tomllib.loads(read_text(path))
    except tomllib.TOMLDecodeError as error:
        raise UnreadableFile(f"{path}: no TOML: {error}") from error
    try:
        return SceneSpec.model_validate(said)
    except ValidationError as error:
        raise UnreadableFile(
            f'{path}: {first_problem(error)}; a scene reads calibration = "cameras.toml", then '
            'for each camera [[camera]], name = "cam01", images = "cam01.mp4"'
        ) from error
