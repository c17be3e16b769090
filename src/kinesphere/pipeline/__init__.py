"""The order of things: the one room that knows it."""

from kinesphere.pipeline.choice import MOTION_ALONE as MOTION_ALONE
from kinesphere.pipeline.choice import model_for as model_for
from kinesphere.pipeline.clock import Progress as Progress
from kinesphere.pipeline.line import STAGES as STAGES
from kinesphere.pipeline.line import solve as solve
from kinesphere.pipeline.retargeting import retarget as retarget
from kinesphere.pipeline.settings import Settings as Settings
from kinesphere.pipeline.settings import changes_from_text as changes_from_text
from kinesphere.pipeline.settings import merged as merged
from kinesphere.pipeline.settings import read_settings as read_settings
from kinesphere.pipeline.settings import settings_fields as settings_fields
from kinesphere.pipeline.settings import settings_from as settings_from
from kinesphere.pipeline.settings import stage_settings as stage_settings
from kinesphere.pipeline.values import type_as_text as type_as_text
