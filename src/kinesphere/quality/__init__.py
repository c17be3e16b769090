"""What is wrong with a recording, and which way is up in it."""

from kinesphere.quality.orientation import OrientationSettings as OrientationSettings
from kinesphere.quality.orientation import orient as orient
from kinesphere.quality.orientation import world_from_up as world_from_up
