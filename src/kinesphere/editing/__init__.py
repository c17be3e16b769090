"""Solved motion changed by its joint parameters, and put on other skeletons."""

from kinesphere.editing.apply import apply_edits as apply_edits
from kinesphere.editing.mesh import SurfaceSettings as SurfaceSettings
from kinesphere.editing.mesh import attach_surface as attach_surface
from kinesphere.editing.mesh import skin as skin
from kinesphere.editing.retarget import retarget_motion as retarget_motion
from kinesphere.editing.retarget_settings import RetargetSettings as RetargetSettings
from kinesphere.editing.scaling import scaled_skeleton as scaled_skeleton
from kinesphere.editing.stature import stature as stature
