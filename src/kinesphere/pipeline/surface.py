"""The surface that a solution shows, where its skeleton is that of a person."""

from dataclasses import replace

from kinesphere import __version__
from kinesphere.data import Motion, Step, Surface, settings_as_json
from kinesphere.editing import SurfaceSettings, attach_surface
from kinesphere.errors import BadSurface


def surface_for(motion: Motion, settings: SurfaceSettings) -> tuple[Surface | None, Step]:
    """Return the body on its skeleton and the step that tells of it; None where none can ride."""
    said = settings_as_json(settings)
    if settings.body == "none":
        return None, Step("surface", said, {"body": "none"}, (), __version__)
    try:
        surface = attach_surface(motion, settings=settings)
    except BadSurface as error:
        return None, Step("surface", said, {"body": f"none: {error}"}, (), __version__)
    step = replace(surface.history[-1], settings=said)
    return surface, step
