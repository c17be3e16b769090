"""What is wrong with a recording, and which way is up in it."""

from kinesphere.data.directions import world_from_up as world_from_up
from kinesphere.quality.at_zero import check_at_zero as check_at_zero
from kinesphere.quality.at_zero import with_zeros_as_gaps as with_zeros_as_gaps
from kinesphere.quality.checks import check_recording as check_recording
from kinesphere.quality.findings import Finding as Finding
from kinesphere.quality.gaps import Gap as Gap
from kinesphere.quality.gaps import find_gaps as find_gaps
from kinesphere.quality.gathered import gathered as gathered
from kinesphere.quality.orientation import OrientationSettings as OrientationSettings
from kinesphere.quality.orientation import orient as orient
from kinesphere.quality.orientation import right_handed as right_handed
