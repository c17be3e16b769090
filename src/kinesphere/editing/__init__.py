"""Solved motion changed by its joint parameters, and put on other skeletons."""

from kinesphere.editing.apply import apply_edits as apply_edits
from kinesphere.editing.retarget import retarget_motion as retarget_motion
from kinesphere.editing.retarget_settings import RetargetSettings as RetargetSettings
from kinesphere.editing.scaling import scaled_skeleton as scaled_skeleton
from kinesphere.editing.stature import stature as stature
