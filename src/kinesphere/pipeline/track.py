"""The line from images: cameras are checked, the body is tracked, the rest is as with markers."""

import time
from dataclasses import dataclass, replace

from kinesphere.data import Scene, Skeleton, Solution, Surface, bundled_body
from kinesphere.errors import BadScene
from kinesphere.markerless import (
    TrackedMotion,
    motion_from_tracked,
    recording_of,
    tracking_step,
    with_first_frame,
)
from kinesphere.markerless.checks import check_scene
from kinesphere.markerless.tracker import track
from kinesphere.normalization import Facing
from kinesphere.parameterization import parameterize
from kinesphere.pipeline.line import Progress
from kinesphere.pipeline.motion_alone import normalized_somehow
from kinesphere.pipeline.settings import Settings

MESHES = {"average": 0.0, "female": -1.0, "male": 1.0}
"""Names of the bundled bodies, and their step along the direction of shape ``sex``."""
NO_MARKERS = "markerless"
"""What stands for the topological model of a solution without markers."""
TRACKING_STAGES = ("checks", "tracking", "normalization", "parameterization")


@dataclass(frozen=True, eq=False)
class TrackedSolution:
    """A solution from images, with what the tracker knows beyond it."""

    solution: Solution
    tracked: TrackedMotion
    scene: Scene


def solve_scene(
    scene: Scene,
    *,
    calibration: tuple[float, float] | None = None,
    calibration_from: Solution | Skeleton | None = None,
    facing: Facing | None = None,
    settings: Settings | None = None,
    progress: Progress | None = None,
) -> TrackedSolution:
    """Track a person without markers, and run the rest of the line on what was found.

    Parameters
    ----------
    scene
        Cameras and images.
    calibration, calibration_from, facing, settings, progress
        As `kinesphere.solve` takes them; of the tracker ``progress`` tells frames, not stages.

    Raises
    ------
    BadScene
        If the scene cannot be tracked: the person is not found, or no body has that name.
    DegenerateMotion, AmbiguousFacing
        If the motion does not determine what a stage needs.
    """
    settings = Settings() if settings is None else settings
    say: Progress = progress or (lambda *_: None)
    seconds: dict[str, float] = {}
    clock = time.perf_counter()
    say("checks", 0, 1)
    checked = check_scene(scene)
    seconds["scene checks"], clock = time.perf_counter() - clock, time.perf_counter()
    scene = replace(scene, history=(*scene.history, checked))
    tracked = track(scene, surface_for(scene), settings.tracking, say)
    seconds["track"], clock = time.perf_counter() - clock, time.perf_counter()
    step = tracking_step(tracked, tuple(camera.name for camera in scene.cameras))
    tracked = replace(tracked, history=(*tracked.history, step))
    measured = with_first_frame(motion_from_tracked(tracked), scene)
    say("normalization", 0, 1)
    motion = normalized_somehow(measured, settings.normalization, facing)
    seconds["normalization"], clock = time.perf_counter() - clock, time.perf_counter()
    say("parameterization", 0, 1)
    reuse = calibration_from
    parameters = parameterize(
        motion,
        settings.parameterization,
        calibration=calibration,
        reuse=reuse.skeleton if isinstance(reuse, Solution) else reuse,
    )
    seconds["parameterization"] = time.perf_counter() - clock
    solution = Solution(
        recording=recording_of(scene, measured),
        motion=motion,
        parameters=parameters,
        model_name=NO_MARKERS,
        seconds=seconds,
    )
    return TrackedSolution(solution, tracked, scene)


def surface_for(scene: Scene) -> Surface:
    """Return the body that a scene asks for.

    Raises
    ------
    BadScene
        If no bundled body has that name.
    """
    if scene.surface is not None:
        return scene.surface
    mesh = scene.body.mesh
    if mesh not in MESHES:
        raise BadScene(f"no bundled body is called {mesh!r}; known are {', '.join(MESHES)}")
    body = bundled_body()
    return body.shaped({"sex": MESHES[mesh]}) if MESHES[mesh] else body
