"""Before tracking: whether calibration and synchronisation fit the silhouettes."""

import numpy as np

from kinesphere import __version__
from kinesphere.data import Frame, Mask, Scene, Step
from kinesphere.markerless.alignment import moved_cameras
from kinesphere.markerless.consistency import (
    Sight,
    disagreement,
    find_culprit,
    find_lateness,
    sights,
)
from kinesphere.markerless.silhouettes import largest_piece, plate_difference

AGREE = 0.008
"""Of the image's diagonal: cameras whose silhouettes contradict each other by more are badly
calibrated. A camera turned by half a degree gives 0.006, perfect ones 0.001, a good calibration of
real footage 0.005."""
_MENDS = 0.4
"""Share of the disagreement that a shift in time must mend to be believed."""
_FRAMES = 9
_WINDOW = 18
_MOST = 5


def check_scene(scene: Scene) -> Step:
    """Return what silhouettes say of calibration and synchronisation, as a step of the history.

    Needs masks or plates in two cameras at least; without them the step says that nothing was
    checked before tracking. Never stops: a bad mask may look like a bad calibration.
    """
    first = scene.start.frame
    spread = np.linspace(0, scene.n_frames - 1, _FRAMES).astype(int)
    able = sum(p is not None for p in scene.plates) if not scene.has_masks else len(scene.cameras)
    if able < 2:
        return _step(
            {"checked": False},
            "neither masks nor plates: whether calibration and offsets fit was not checked before "
            "tracking; look at the overlap of each camera",
        )
    every = max(1, int(spread[1] - spread[0])) if scene.n_frames > 1 else 1
    some = [silhouettes(scene, frame) for frame in scene.frames(0, None, every)]
    seen = sights(scene.cameras, some)
    apart = disagreement(seen)
    diagonal = float(np.mean([np.hypot(c.width, c.height) for c in scene.cameras]))
    found: dict[str, object] = {
        "checked": True,
        "n_frames": len(some),
        "disagreement_px": apart,
        "disagreement_of_diagonal": apart / diagonal,
    }
    if not np.isfinite(apart):
        return _step(found, "no two cameras see a silhouette at the same time: nothing checked")
    warnings = [
        f"{camera.name} shows no silhouette in any frame looked at"
        for c, camera in enumerate(scene.cameras)
        if all(row[c] is None for row in seen)
    ]
    if scene.n_frames > 2 * _MOST:
        begin = min(first, max(0, scene.n_frames - _WINDOW))
        window = [silhouettes(scene, f) for f in scene.frames(begin, begin + _WINDOW)]
        late = find_lateness(sights(scene.cameras, window), min(_MOST, (len(window) - 1) // 2))
        if late.frames != 0 and late.mended > _MENDS:
            name, n = scene.cameras[late.camera].name, abs(late.frames)
            later = "later" if late.frames > 0 else "earlier"
            found |= {"late_camera": name, "late_frames": late.frames, "mended": late.mended}
            offset = scene.offsets[late.camera]
            warnings.append(
                f"{name} seems to show everything {n} {'frame' if n == 1 else 'frames'} {later} "
                f"than the other cameras ({late.mended:.0%} of their disagreement would go); try "
                f"offset = {offset + late.frames} in its [[camera]]"
            )
    if apart > AGREE * diagonal:
        warnings.append(_culprit(scene, seen, apart))
    if apart > AGREE / 2 * diagonal:
        warnings += moved_cameras(scene.cameras, some[:: max(1, len(some) - 1)])
    return _step(found, *warnings)


def silhouettes(scene: Scene, frame: Frame) -> tuple[Mask | None, ...]:
    """Return the person's silhouette in each camera, from masks or plates; None without either."""
    found: list[Mask | None] = []
    for mask, image, plate in zip(frame.masks, frame.images, scene.plates, strict=True):
        if mask is not None:
            found.append(np.asarray(largest_piece(mask.astype(np.uint8) * 255) > 0))
        elif image is not None and plate is not None:
            found.append(np.asarray(plate_difference(image, plate) > 0))
        else:
            found.append(None)
    return tuple(found)


def _culprit(scene: Scene, seen: list[list[Sight | None]], apart: float) -> str:
    head = f"the cameras' silhouettes contradict each other by {apart:.0f} px: "
    if (wrong := find_culprit(seen)) is not None:
        return (
            head + f"{scene.cameras[wrong].name} does not fit the others; its calibration, its "
            "offset or the way its images were cropped is wrong"
        )
    return head + (
        "calibration, offsets or masks are wrong (units, the order of the cameras, cropped images)"
    )


def _step(findings: dict[str, object], *warnings: str) -> Step:
    return Step("scene checks", findings=findings, warnings=warnings, version=__version__)  # type: ignore[arg-type]
