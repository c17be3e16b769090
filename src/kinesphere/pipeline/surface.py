"""The surface that a solution shows, where its skeleton is that of a person."""

from dataclasses import replace
from pathlib import Path

from kinesphere import __version__
from kinesphere.data import Motion, Step, Surface, bundled_body, settings_as_json
from kinesphere.editing import SurfaceSettings, attach_surface, prepared_surface
from kinesphere.errors import BadSetting, BadSurface
from kinesphere.io import read

BUNDLED, NONE = "bundled", "none"


def body_for(settings: SurfaceSettings) -> Surface | None:
    """Return the body that is to ride on the skeleton, with its limbs; None for none.

    Raises
    ------
    BadSetting
        If ``body`` is neither a name nor a file.
    UnreadableFile, BadSurface
        If the file is damaged, holds no mesh, or one that is no person.
    """
    if settings.body == NONE:
        return None
    if settings.body == BUNDLED:
        return bundled_body()
    if not Path(settings.body).exists():
        raise BadSetting(
            f"surface.body is {settings.body!r}; known are {BUNDLED}, {NONE}, or a file with a mesh"
        )
    found = read(settings.body)
    if not isinstance(found, Surface):
        raise BadSurface(
            f"{settings.body} holds a {type(found).__name__}; surface.body wants a mesh (OBJ, PLY, "
            "STL, glTF, GLB)"
        )
    try:
        return prepared_surface(found, settings)
    except BadSurface as error:
        raise BadSurface(f"{settings.body}: {error}") from None


def surface_for(
    motion: Motion, settings: SurfaceSettings, body: Surface | None = None
) -> tuple[Surface | None, Step]:
    """Return the body on its skeleton and the step that tells of it; None where none can ride.

    A body that somebody asked for and that cannot ride is a warning.

    Parameters
    ----------
    motion
        Normalized.
    settings
    body
        As `body_for` gives it, where that was called already.
    """
    said = settings_as_json(settings)
    body = body_for(settings) if body is None else body
    if body is None:
        return None, Step("surface", said, {"body": NONE}, (), __version__)
    given = settings.body != BUNDLED
    try:
        surface = attach_surface(motion, body, settings)
    except BadSurface as error:
        doubts = (f"the body of {settings.body} is not shown: {error}",) if given else ()
        return None, Step("surface", said, {"body": f"none: {error}"}, doubts, __version__)
    step = surface.history[-1]
    about = {k: v for s in surface.history if s.name == "rigging" for k, v in s.findings.items()}
    warnings = tuple(warning for s in surface.history for warning in s.warnings)
    findings = {**about, **step.findings}
    return surface, replace(step, settings=said, findings=findings, warnings=warnings)
