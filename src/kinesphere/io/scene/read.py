"""``SCENE.toml`` to a scene: every file it names is opened, and what does not fit is said."""

import math
import tomllib
from dataclasses import dataclass
from pathlib import Path

from pydantic import ValidationError

from kinesphere.data import (
    Array,
    BodyChoice,
    Camera,
    Image,
    Json,
    Scene,
    StartChoice,
    Step,
)
from kinesphere.data.directions import world_from_up
from kinesphere.data.validation import first_problem
from kinesphere.errors import BadScene, UnreadableFile
from kinesphere.io.calibration import CalibratedCamera, read_calibration
from kinesphere.io.gltf.body import read_body
from kinesphere.io.scene.footage import RecordedFootage, mask_offset, median_plate
from kinesphere.io.scene.spec import CameraSpec, SceneSpec
from kinesphere.io.scene.streams import ImageFolder, Stream, open_stream
from kinesphere.io.scene.world import camera_in_world, settle_unit, settle_up
from kinesphere.io.text import read_text

_FEWEST = 2
_SAME_RATE = 0.005
"""Cameras whose rates differ by less run at one rate: 59.94 and 60 Hz do."""
_ANGLES_END = "_m"
"""Start values of parameters so named are lengths, the others angles."""


@dataclass(frozen=True)
class _Opened:
    """A camera of the scene with its files open."""

    spec: CameraSpec
    calibrated: CalibratedCamera
    stream: Stream
    masks: Stream | None
    reference: Stream | None


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
    found, unit, up, where = _calibrated(spec, folder)
    known = {camera.name for camera in found}
    named = [camera.name for camera in spec.camera]
    if twice := sorted({name for name in named if named.count(name) > 1}):
        raise BadScene(f"{path}: camera {', '.join(twice)} is there twice")
    if len(named) < _FEWEST:
        raise BadScene(f"{path}: the scene has {len(named)} camera; two see how far away things are")
    if missing := [name for name in named if name not in known]:
        raise BadScene(
            f"{path}: camera {', '.join(missing)} is not calibrated; {where} knows "
            f"{', '.join(sorted(known))}"
        )
    warnings: list[str] = []
    if unseen := sorted(known - set(named)):
        warnings.append(f"{', '.join(unseen)} is calibrated, but the scene has no images of it")
    by_name = {camera.name: camera for camera in found}
    opened = [_open(camera, by_name[camera.name], folder) for camera in spec.camera]

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
    body = _body(spec, folder)
    rate = _rate(spec, opened, path)
    first, n_frames, uneven = _span(spec, opened, path)
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
        plates=tuple(_plate(one, folder) for one in opened),
        offsets=offsets,
        world_from_file=turn,
        body=body,
        surface=None if body.model in ("full", "upper") else read_body(body.model),
        start=_start(spec, turn, first, n_frames),
        has_masks=any(one.masks is not None for one in opened),
        first_frame=offsets[0],
        history=(step,),
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


def _calibrated(
    spec: SceneSpec, folder: Path
) -> tuple[tuple[CalibratedCamera, ...], str, str, str]:
    """Return the cameras, unit, up and name of the calibration or of the cameras' own ones."""
    own = [camera for camera in spec.camera if camera.calibration is not None]
    if spec.calibration is None and len(own) < len(spec.camera):
        lacking = next(c.name for c in spec.camera if c.calibration is None)
        raise BadScene(
            f'no calibration for {lacking}: write calibration = "FILE" for the scene or the camera'
        )
    cameras: dict[str, CalibratedCamera] = {}
    units, ups, names = set(), set(), []
    if spec.calibration is not None:
        whole = read_calibration(folder / spec.calibration)
        cameras |= {camera.name: camera for camera in whole.cameras}
        units.add(whole.unit)
        ups.add(whole.up)
        names.append(spec.calibration)
    for camera in own:
        one = read_calibration(folder / str(camera.calibration))
        by_name = {c.name: c for c in one.cameras}
        if camera.name not in by_name and len(by_name) > 1:
            raise BadScene(
                f"{camera.calibration} calibrates {', '.join(by_name)}, not {camera.name}"
            )
        chosen = by_name.get(camera.name, one.cameras[0])
        cameras[camera.name] = CalibratedCamera(
            camera.name, chosen.size, chosen.matrix, chosen.distortion, chosen.rotation,
            chosen.translation,
        )  # fmt: skip
        units.add(one.unit)
        ups.add(one.up)
        names.append(str(camera.calibration))
    where = ", ".join(names[:3]) + (", …" if len(names) > 3 else "")
    if len(units) > 1 or len(ups) > 1:
        raise BadScene(
            f"{where} differ in unit or up axis ({', '.join(sorted(u or 'unsaid' for u in units))})"
        )
    said_unit, said_up = units.pop(), ups.pop()
    if spec.unit and said_unit and spec.unit != said_unit:
        raise BadScene(f"the scene says unit = {spec.unit!r}, but {where} is in {said_unit}")
    return tuple(cameras.values()), spec.unit or said_unit, spec.up or said_up, where


def _open(camera: CameraSpec, calibrated: CalibratedCamera, folder: Path) -> _Opened:
    stream = open_stream(folder / camera.images)
    step = stream.step if isinstance(stream, ImageFolder) else 1
    masks = None if camera.masks is None else open_stream(folder / camera.masks, step)
    reference = camera.reference_masks
    return _Opened(
        spec=camera,
        calibrated=calibrated,
        stream=stream,
        masks=masks,
        reference=None if reference is None else open_stream(folder / reference, step),
    )


def _rate(spec: SceneSpec, opened: list[_Opened], path: Path) -> float:
    told = {o.spec.name: o.stream.rate for o in opened if o.stream.rate is not None}
    if told:
        low, high = min(told, key=lambda n: told[n]), max(told, key=lambda n: told[n])
        if told[high] > told[low] * (1 + _SAME_RATE):
            raise BadScene(
                f"{path}: {low} runs at {told[low]:g} Hz and {high} at {told[high]:g} Hz; cameras "
                "must run at one rate"
            )
    if spec.rate_hz is not None:
        return spec.rate_hz
    if told:
        return float(told[next(iter(told))])
    if min(o.stream.n_frames for o in opened) == 1:
        return 1.0  # one instant has no rate
    raise BadScene(f"{path}: images alone have no rate; write rate_hz = 60")


def _span(spec: SceneSpec, opened: list[_Opened], path: Path) -> tuple[int, int, list[str]]:
    """Return the first frame used, how many there are, and what is said of uneven streams."""
    begin = max(0, *(-o.spec.offset for o in opened))
    ends = {o.spec.name: o.stream.n_frames - o.spec.offset for o in opened}
    n = min(ends.values())
    if n <= begin:
        short = min(ends, key=lambda name: ends[name])
        raise BadScene(
            f"{path}: no instant is covered by every camera: after its offset {short} has "
            f"{max(0, ends[short])} frames, and the scene begins at {begin}"
        )
    warnings = []
    if len(set(ends.values())) > 1:
        counts = ", ".join(f"{name} {count}" for name, count in ends.items())
        warnings.append(
            f"the cameras cover unequal numbers of frames ({counts}); the scene ends after {n}, "
            "and unequal counts may mean that one camera dropped frames or began earlier"
        )
    first, last = begin, n - 1
    if spec.frames is not None:
        first, last = spec.frames
        if not begin <= first <= last < n:
            raise BadScene(
                f"{path}: frames = [{first}, {last}], but the cameras cover frames {begin} to "
                f"{n - 1}"
            )
    return first, last - first + 1, warnings


def _plate(one: _Opened, folder: Path) -> Image | None:
    if one.spec.plate is None:
        return None
    stream = open_stream(folder / one.spec.plate)
    plate = median_plate(stream)
    if plate.shape[:2] != (one.stream.size[1], one.stream.size[0]):
        raise BadScene(
            f"{stream.path} is {plate.shape[1]} × {plate.shape[0]} pixels, but the images of "
            f"{one.spec.name} are {one.stream.size[0]} × {one.stream.size[1]}"
        )
    return plate


def _body(spec: SceneSpec, folder: Path) -> BodyChoice:
    body = spec.body
    model = body.model
    if model not in ("full", "upper"):
        if not (folder / model).is_file():
            raise BadScene(
                f"body.model = {model!r}: neither 'full' nor 'upper', and no file {folder / model}"
            )
        model = str(folder / model)
    return BodyChoice(model, body.mesh, body.height_m, body.fit)


def _start(spec: SceneSpec, turn: Array, first: int, n_frames: int) -> StartChoice:
    start = spec.start
    frame = max(start.frame, first)
    if frame >= first + n_frames:
        raise BadScene(
            f"start.frame = {start.frame}, but the scene has frames {first} to "
            f"{first + n_frames - 1}"
        )
    if start.pose == "given" and not start.values:
        raise BadScene('start.pose = "given" needs start.values, the body model\'s parameters')
    where = None if start.position_m is None else tuple((turn @ start.position_m).tolist())
    facing = None if start.facing is None else tuple((turn @ start.facing).tolist())
    values = {
        name: value if name.endswith(_ANGLES_END) else math.radians(value)
        for name, value in start.values.items()
    }
    return StartChoice(start.pose, frame - first, where, facing, values)
