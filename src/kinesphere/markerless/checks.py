"""Before tracking: whether calibration and synchronisation fit the silhouettes."""

import numpy as np

from kinesphere import __version__
from kinesphere.data import Frame, Mask, Scene, Step
from kinesphere.markerless.alignment import moved_cameras
from kinesphere.markerless.consistency import (
    Lateness,
    Sight,
    cost,
    disagreement,
    distances,
    find_culprit,
    find_lateness,
    sights,
)
from kinesphere.markerless.mixups import find_swap, person_size, same_pictures, turned_inside_out
from kinesphere.markerless.silhouettes import largest_piece, plate_difference
from kinesphere.markerless.tracked import CHECKS, CULPRIT

AGREE = 0.008
"""Of the image's diagonal: cameras whose silhouettes contradict each other by more are badly
calibrated. A camera turned by half a degree gives 0.006, perfect ones 0.001, a good calibration of
real footage 0.005."""
_MENDS = 0.4
"""Share of the disagreement that a shift in time must mend to be believed."""
_UNDONE = 0.6
"""The same of an exchange of two cameras: 0.9 where two were exchanged, 0.0 where none was."""
_SIZES = (0.7, 3.2)
"""m; a child and a tall person with arms stretched out and the legs apart lie between."""
_SPECK = 1e-3
"""Share of the image below which what differs from the plate is nobody."""
_FRAMES = 9
_WINDOW = 18
_ODD = 0.1
"""Share of the disagreement that is left without a camera that stands out, however little it is
off: below 0.01 with one of four perfect cameras turned by half a degree, 0.26 or more on real
cameras, whose calibrations all err a little."""
_MOST, _WIDE = 5, 15
"""Frames by which a camera may be late; and if it seems to be by the first of them, or more."""
_LEAST = 3
"""Frames by which a camera must be able to be late before it is asked."""


def check_scene(scene: Scene) -> Step:
    """Return what silhouettes say of calibration and synchronisation, as a step of the history.

    Needs masks or plates in two cameras at least; without them the step says that nothing was
    checked before tracking. Never stops: a bad mask may look like a bad calibration.
    """
    doubts = []
    if twins := same_pictures(scene.cameras, scene.frame(scene.start.frame)):
        doubts.append(
            f"{twins[0]} and {twins[1]} show the same picture, to the last pixel; each camera "
            "needs images of its own"
        )
    spread = np.linspace(0, scene.n_frames - 1, _FRAMES).astype(int)
    able = sum(p is not None for p in scene.plates) if not scene.has_masks else len(scene.cameras)
    if able < 2:
        return _step(
            {"checked": False},
            *doubts,
            "neither masks nor plates: whether calibration and offsets fit was not checked before "
            "tracking; look at the overlap of each camera",
        )
    every = max(1, int(spread[1] - spread[0])) if scene.n_frames > 1 else 1
    some = [silhouettes(scene, frame) for frame in scene.frames(0, None, every)]
    if scene.start.frame % every:  # where masks are few, the start has one
        some.append(silhouettes(scene, scene.frame(scene.start.frame)))
    seen = sights(scene.cameras, some)
    apart = disagreement(seen)
    diagonal = float(np.mean([np.hypot(c.width, c.height) for c in scene.cameras]))
    found: dict[str, object] = {
        "checked": True,
        "n_frames": len(some),
        "disagreement_px": apart,
        "disagreement_of_diagonal": apart / diagonal,
    }
    if not apart <= AGREE * diagonal:
        meant = turned_inside_out(scene.cameras, scene.world_from_file)
        if disagreement(sights(meant, some)) <= AGREE * diagonal:
            return _step(
                found,
                *doubts,
                "the calibration seems to be camera-to-world: read the other way round, its "
                "cameras agree; rotation and translation must take points of the world to the "
                "camera (transpose R, and t becomes -Rᵀt)",
            )
    if not np.isfinite(apart):
        return _step(
            found,
            *doubts,
            "no two cameras see a silhouette at the same time, or they look past each other "
            "(units, axes, the order of the cameras): nothing checked",
        )
    warnings = doubts + [
        f"{camera.name} shows no silhouette in any frame looked at"
        for c, camera in enumerate(scene.cameras)
        if all(row[c] is None for row in seen)
    ]
    found["person_m"] = size = round(person_size(scene.cameras, some), 2)
    if not _SIZES[0] <= size <= _SIZES[1]:
        warnings.append(
            f"the person seems {size:.2g} m large; the calibration's unit is wrong, or what moves "
            "is no person"
        )
        return _step(found, *warnings)  # whatever else seems wrong comes of it
    swap = find_swap(scene.cameras, some)
    if swap is not None and swap.mended > _UNDONE:
        one, other = scene.cameras[swap.first].name, scene.cameras[swap.second].name
        found |= {"swapped": [one, other], "mended": round(swap.mended, 2)}
        warnings.append(
            f"the images of {one} and {other} seem to be exchanged: the other way round "
            f"{swap.mended:.0%} of the cameras' disagreement would go"
        )
        return _step(found, *warnings)
    told, warning = _lateness(scene)
    found |= told
    warnings += warning
    wrong = find_culprit(seen) if apart > AGREE / 4 * diagonal else None
    left = np.nan if wrong is None else cost(distances(seen, without=wrong))
    odd = left < _ODD * cost(distances(seen))
    if apart > AGREE * diagonal or odd:
        warnings.append(_contradiction(scene, wrong, apart))
        if wrong is not None:
            found[CULPRIT] = scene.cameras[wrong].name
    if apart > AGREE / 2 * diagonal or odd:
        some = some[:: max(1, len(some) - 1)]
        warnings += moved_cameras(scene.cameras, some, only=wrong if odd else None)
    return _step(found, *warnings)


def silhouettes(scene: Scene, frame: Frame) -> tuple[Mask | None, ...]:
    """Return the person's silhouette in each camera, from masks or plates.

    None without either, and where nobody is.
    """
    found: list[Mask | None] = []
    for mask, image, plate in zip(frame.masks, frame.images, scene.plates, strict=True):
        if mask is not None:
            person = np.asarray(largest_piece(mask.astype(np.uint8) * 255) > 0)
            found.append(person if person.any() else None)
        elif image is not None and plate is not None:
            differs = np.asarray(plate_difference(image, plate) > 0)
            found.append(differs if differs.mean() > _SPECK else None)
        else:
            found.append(None)
    return tuple(found)


def _lateness(scene: Scene) -> tuple[dict[str, object], list[str]]:
    """Return what is found and said of a camera whose clock seems off; nothing where none is."""
    late = _latest(scene, _MOST, _WINDOW)
    if any(abs(one.frames) == _MOST for one in late):  # or by more
        late = _latest(scene, _WIDE, 2 * _WIDE + _WINDOW // 2) or late
    late = [one for one in late if one.mended > _MENDS]
    if not late:
        return {}, []
    names = [scene.cameras[each.camera].name for each in late]
    told: dict[str, object] = {
        "late_camera": names[0],
        "late_frames": late[0].frames,
        "mended": late[0].mended,
    }
    shifts = [
        f"{abs(each.frames)} {'frame' if abs(each.frames) == 1 else 'frames'} "
        f"{'later' if each.frames > 0 else 'earlier'}"
        for each in late
    ]
    others = (f", or {n} {shift}" for n, shift in zip(names[1:], shifts[1:], strict=True))
    offsets = " or ".join(
        f"offset = {scene.offsets[each.camera] + each.frames} in the [[camera]] of {name}"
        for name, each in zip(names, late, strict=True)
    )
    return told, [
        f"{names[0]} seems to show everything {shifts[0]} than the others{''.join(others)} "
        f"({late[0].mended:.0%} of their disagreement would go); try {offsets}"
    ]


def _latest(scene: Scene, most: int, n_frames: int) -> list[Lateness]:
    begin = min(scene.start.frame, max(0, scene.n_frames - n_frames))
    window = [silhouettes(scene, f) for f in scene.frames(begin, begin + n_frames)]
    seen = _while_all_see(sights(scene.cameras, window))
    most = min(most, (len(seen) - 1) // 2)
    return find_lateness(seen, most) if most >= _LEAST else []


def _while_all_see(seen: list[list[Sight | None]]) -> list[list[Sight | None]]:
    """Return the longest run of frames in which every camera that ever sees somebody does."""
    able = [any(row[c] is not None for row in seen) for c in range(len(seen[0]))]
    best: list[list[Sight | None]] = []
    run: list[list[Sight | None]] = []
    for row in seen:
        whole = all(sight is not None for sight, sees in zip(row, able, strict=True) if sees)
        run = [*run, row] if whole else []
        best = max(best, run, key=len)
    return best


def _contradiction(scene: Scene, wrong: int | None, apart: float) -> str:
    head = f"the cameras' silhouettes contradict each other by {apart:.0f} px: "
    if wrong is not None:
        return (
            head + f"{scene.cameras[wrong].name} does not fit the others; its calibration, its "
            "offset or the way its images were cropped is wrong"
        )
    return head + (
        "calibration, offsets or masks are wrong (units, the order of the cameras, cropped images)"
    )


def _step(findings: dict[str, object], *warnings: str) -> Step:
    return Step(CHECKS, findings=findings, warnings=warnings, version=__version__)  # type: ignore[arg-type]
