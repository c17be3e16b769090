"""Some frames tracked with a body that is not quite right yet, to learn its proportions from."""

from kinesphere.data import Scene
from kinesphere.markerless.shape_fit import Instant
from kinesphere.markerless.tracking import Tracking
from kinesphere.markerless.watching import backwards, pictures_of


def rehearse(scene: Scene, tracking: Tracking, first: int, masks: bool) -> list[Instant]:
    """Track some frames from the first one on, and return some of them with their poses.

    Forward where there are frames enough, else from the scene's beginning backwards in time.
    The instants are evenly spread, the first frame among them; frames in which a limb is held
    lost are left out.
    """
    settings = tracking.fitter.settings
    n = settings.shape_frames
    every = max(1, n // settings.shape_instants)
    ahead = scene.n_frames - first
    frames = scene.frames(first, first + n) if ahead >= min(n, first) else backwards(scene, first)
    kept: list[Instant] = []

    for i, frame in enumerate(frames):
        if i >= n:
            break
        pictures = pictures_of(frame, masks)
        found = tracking.begin(pictures) if i == 0 else tracking.step(pictures)
        if i % every == 0 and tracking.fitter.open_eyes and (i == 0 or not found.lost.any()):
            views = tuple(
                None if p is None else eye.canvas.view.image(p)
                for eye, p in zip(tracking.fitter.eyes, pictures, strict=True)
            )
            kept.append(Instant(views, found.pose))
    return kept
