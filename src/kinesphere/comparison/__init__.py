"""Two solutions of one motion, brought to one time, one world and one set of limb frames."""

from kinesphere.comparison.alignment import LimbAlignment as LimbAlignment
from kinesphere.comparison.alignment import WorldAlignment as WorldAlignment
from kinesphere.comparison.kinship import Kinship as Kinship
from kinesphere.comparison.measures import Agreement as Agreement
from kinesphere.comparison.measures import agreement as agreement
from kinesphere.comparison.offset import TimeOffset as TimeOffset
from kinesphere.comparison.result import Comparison as Comparison
from kinesphere.comparison.result import JointComparison as JointComparison
from kinesphere.comparison.result import ParameterComparison as ParameterComparison
from kinesphere.comparison.stage import compare as compare
from kinesphere.comparison.timing import find_offset as find_offset
