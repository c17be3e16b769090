"""Solved motion changed by its joint parameters."""

from kinesphere.editing.apply import apply_edits as apply_edits
from kinesphere.editing.mesh import SurfaceSettings as SurfaceSettings
from kinesphere.editing.mesh import attach_surface as attach_surface
from kinesphere.editing.mesh import skin as skin
