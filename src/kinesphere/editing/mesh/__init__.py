"""A surface on the normalized skeleton (Sar Dessai et al. 2006, figure 5): bound, then skinned."""

from kinesphere.editing.mesh.attach import attach_surface as attach_surface
from kinesphere.editing.mesh.attach import prepared_surface as prepared_surface
from kinesphere.editing.mesh.settings import SurfaceSettings as SurfaceSettings
from kinesphere.editing.mesh.skin import skin as skin
