"""The line from images: cameras are checked, the body is tracked, the rest is as with markers."""

from collections.abc import Callable
from dataclasses import dataclass, replace

from kinesphere import __version__
from kinesphere.data import Scene, Solution, Step, Surface, bundled_body
from kinesphere.errors import BadScene
from kinesphere.markerless import (
    TrackedMotion,
    motion_from_tracked,
    recording_of,
    tracking_step,
    with_first_frame,
)
from kinesphere.markerless.checks import check_scene
from kinesphere.markerless.entrance import with_person_in_view
from kinesphere.markerless.rig import standing_as_bundled
from kinesphere.markerless.tracker import track
from kinesphere.normalization import Facing
from kinesphere.pipeline.clock import Clock, Progress
from kinesphere.pipeline.reuse import Sources, calibrated, check_reuse
from kinesphere.pipeline.settings import Settings
from kinesphere.pipeline.surface import BUNDLED, body_for, surface_for
from kinesphere.pipeline.wishes import (
    check_wishes,
    normalized_at_any_rate,
    parameterized_at_any_rate,
)

MESHES = {"average": 0.0, "female": -1.0, "male": 1.0}
"""Names of the bundled bodies, and their step along the direction of shape ``sex``."""
NO_MARKERS = "markerless"
"""What stands for the topological model of a solution without markers."""
TRACKING_STAGES = ("scene checks", "track", "normalization", "parameterization", "surface")


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
    calibration_from: Sources = None,
    facing: Facing | None = None,
    settings: Settings | None = None,
    progress: Progress | None = None,
    notice: Callable[[str], None] | None = None,
    after_tracking: Callable[[], None] | None = None,
) -> TrackedSolution:
    """Track a person without markers, and run the rest of the line on what was found.

    Tracking takes long, so nothing that comes after it may lose it: a facing, a calibration window
    or another recording that does not help is left out, aloud. Interrupted while frames are
    tracked (Ctrl-C), it goes on with those it has.

    Parameters
    ----------
    scene
        Cameras and images.
    calibration, calibration_from, facing, settings, progress
        As `kinesphere.solve` takes them; of the tracker ``progress`` tells frames, not stages.
    notice
        Told what looks wrong before tracking begins, a doubtful start among it; the history has
        it as well.
    after_tracking
        Called when tracking has ended: what comes is short, and interrupting it loses all.

    Raises
    ------
    BadScene
        If the scene cannot be tracked: the person is not found, or next to nothing speaks for
        the start that is found, or no body has that name.
    BadSetting
        If the calibration window lies beyond the scene, or no facing has that name.
    DegenerateMotion, AmbiguousFacing
        If the motion does not determine what a stage needs.
    """
    settings = Settings() if settings is None else settings
    check_wishes(scene, calibration, facing)
    check_reuse(settings.parameterization, calibration_from)
    riding = None if settings.surface.body == BUNDLED else body_for(settings.surface)
    clock = Clock(progress, len(TRACKING_STAGES))
    with clock.stage("scene checks"):
        scene = with_person_in_view(scene)
        scene = replace(scene, history=(*scene.history, check_scene(scene)))
    if notice is not None:
        for warning in (w for step in scene.history for w in step.warnings):
            notice(warning)
    with clock.stage("track"):
        tracked = track(scene, body_of(scene), settings.tracking, progress, notice=notice)
        if after_tracking is not None:
            after_tracking()
        step = tracking_step(tracked, tuple(camera.name for camera in scene.cameras))
        tracked = replace(tracked, history=(*tracked.history, *_reading(scene), step))
        measured = with_first_frame(motion_from_tracked(tracked), scene)
    with clock.stage("normalization"):
        motion = normalized_at_any_rate(measured, settings.normalization, facing)
    with clock.stage("parameterization"):
        others = calibrated(calibration_from)
        parameters = parameterized_at_any_rate(
            motion, settings.parameterization, calibration, others
        )
    with clock.stage("surface"):
        body = tracked.surface if settings.surface.body == BUNDLED else riding
        surface, step = surface_for(motion, settings.surface, body)
        parameters = replace(parameters, history=(*parameters.history, step))
    solution = Solution(
        recording=recording_of(scene, measured),
        motion=motion,
        parameters=parameters,
        model_name=NO_MARKERS,
        seconds=clock.seconds,
        surface=surface,
    )
    return TrackedSolution(solution, tracked, scene)


def _reading(scene: Scene) -> tuple[Step, ...]:
    """Return a step that tells of images that could not be read; none where all could."""
    known = {warning for step in scene.history for warning in step.warnings}
    new = tuple(note for note in scene.notes if note not in known)
    return (Step("reading images", warnings=new, version=__version__),) if new else ()


def body_of(scene: Scene) -> Surface:
    """Return the body that a scene asks for.

    Raises
    ------
    BadScene
        If no bundled body has that name.
    """
    if scene.surface is not None:
        return standing_as_bundled(scene.surface)
    mesh = scene.body.mesh
    if mesh not in MESHES:
        raise BadScene(f"no bundled body is called {mesh!r}; known are {', '.join(MESHES)}")
    body = bundled_body()
    return body.shaped({"sex": MESHES[mesh]}) if MESHES[mesh] else body
