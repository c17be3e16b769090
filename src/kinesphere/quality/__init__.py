"""What is wrong with a recording, and which way is up in it."""

from kinesphere.data.directions import world_from_up as world_from_up
from kinesphere.quality.at_zero import check_at_zero as check_at_zero
from kinesphere.quality.at_zero import with_zeros_as_gaps as with_zeros_as_gaps
from kinesphere.quality.checks import check_at_size as check_at_size
from kinesphere.quality.checks import check_recording as check_recording
from kinesphere.quality.findings import Finding as Finding
from kinesphere.quality.gaps import Gap as Gap
from kinesphere.quality.gaps import find_gaps as find_gaps
from kinesphere.quality.gathered import gathered as gathered
from kinesphere.quality.orientation import OrientationSettings as OrientationSettings
from kinesphere.quality.orientation import orient as orient
from kinesphere.quality.orientation import right_handed as right_handed
from kinesphere.quality.unit import check_unit as check_unit
from kinesphere.quality.unit import times_in_words as times_in_words
from kinesphere.quality.unit import told_unit as told_unit
