"""Solved motion in a browser, live: played, picked, and changed by its own angles."""

from kinesphere.viewer.clock import Clock as Clock
from kinesphere.viewer.poses import EditedPoses as EditedPoses
from kinesphere.viewer.serve import serve as serve
from kinesphere.viewer.session import Scope as Scope
from kinesphere.viewer.session import Session as Session
from kinesphere.viewer.session import Target as Target
from kinesphere.viewer.session import session_from_edits as session_from_edits
from kinesphere.viewer.take import Take as Take
from kinesphere.viewer.take import take_from as take_from
