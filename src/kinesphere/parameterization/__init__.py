"""Movement filter, movement axes, rest position, angles and twist: poses into parameters."""

from kinesphere.parameterization.anatomy import n_told as n_told
from kinesphere.parameterization.angles import unwrapped as unwrapped
from kinesphere.parameterization.reused import told_of as told_of
from kinesphere.parameterization.settings import AngleSettings as AngleSettings
from kinesphere.parameterization.settings import AxesSettings as AxesSettings
from kinesphere.parameterization.settings import FilterSettings as FilterSettings
from kinesphere.parameterization.settings import (
    ParameterizationSettings as ParameterizationSettings,
)
from kinesphere.parameterization.settings import RestSettings as RestSettings
from kinesphere.parameterization.settings import TwistSettings as TwistSettings
from kinesphere.parameterization.stage import parameterize as parameterize
