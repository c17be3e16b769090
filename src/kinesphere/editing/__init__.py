"""Solved motion changed by its joint parameters, and put on other skeletons."""

from kinesphere.editing.apply import Moves as Moves
from kinesphere.editing.apply import apply_edits as apply_edits
from kinesphere.editing.apply import find_moves as find_moves
from kinesphere.editing.apply import moved_markers as moved_markers
from kinesphere.editing.apply import moved_poses as moved_poses
from kinesphere.editing.mesh import SurfaceSettings as SurfaceSettings
from kinesphere.editing.mesh import attach_surface as attach_surface
from kinesphere.editing.mesh import prepared_surface as prepared_surface
from kinesphere.editing.mesh import skin as skin
from kinesphere.editing.parameters import edit_parameters as edit_parameters
from kinesphere.editing.retarget import retarget_motion as retarget_motion
from kinesphere.editing.retarget_settings import RetargetSettings as RetargetSettings
from kinesphere.editing.scaling import scaled_skeleton as scaled_skeleton
from kinesphere.editing.stature import stature as stature
from kinesphere.editing.weights import edit_weights as edit_weights
