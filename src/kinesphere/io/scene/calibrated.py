"""The calibration of every camera of a scene, from one file or a file each."""

from pathlib import Path

from kinesphere.errors import BadScene
from kinesphere.io.calibration import CalibratedCamera, read_calibration
from kinesphere.io.scene.spec import SceneSpec


def calibrated_cameras(
    spec: SceneSpec, folder: Path
) -> tuple[tuple[CalibratedCamera, ...], str, str, str]:
    """Return the cameras, unit, up and name of the calibration or of the cameras' own ones.

    Raises
    ------
    UnreadableFile
        If a file is missing or no calibration.
    BadScene
        If a camera has none, or files differ in unit or up axis.
    """
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
