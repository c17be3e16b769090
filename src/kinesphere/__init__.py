"""Kinesphere: optical motion capture into motion that means something, without manual work.

>>> import kinesphere as ks
>>> solution = ks.solve(ks.read("walk.c3d"))  # doctest: +SKIP
>>> ks.write(solution, "walk/")  # doctest: +SKIP

Importing is quick and touches nothing: each name below is fetched when it is first used.
"""

from importlib import import_module
from importlib.metadata import PackageNotFoundError, version
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from kinesphere.comparison import Comparison as Comparison
    from kinesphere.comparison import compare as compare
    from kinesphere.data import Analog as Analog
    from kinesphere.data import Event as Event
    from kinesphere.data import Joint as Joint
    from kinesphere.data import Limb as Limb
    from kinesphere.data import Motion as Motion
    from kinesphere.data import Output as Output
    from kinesphere.data import Parameters as Parameters
    from kinesphere.data import Recording as Recording
    from kinesphere.data import Skeleton as Skeleton
    from kinesphere.data import Solution as Solution
    from kinesphere.data import Surface as Surface
    from kinesphere.data import TopologicalModel as TopologicalModel
    from kinesphere.data import bundled_body as bundled_body
    from kinesphere.data import motion_from_parameters as motion_from_parameters
    from kinesphere.data.edits import Edit as Edit
    from kinesphere.data.isb import IsbAngles as IsbAngles
    from kinesphere.data.isb import isb_angles as isb_angles
    from kinesphere.editing import apply_edits as apply_edits
    from kinesphere.editing import attach_surface as attach_surface
    from kinesphere.editing import skin as skin
    from kinesphere.errors import KinesphereError as KinesphereError
    from kinesphere.io import read as read
    from kinesphere.io import read_rig as read_rig
    from kinesphere.io import write as write
    from kinesphere.io import write_on_rig as write_on_rig
    from kinesphere.labelling import LiveLabeller as LiveLabeller
    from kinesphere.labelling import built_in_model as built_in_model
    from kinesphere.labelling import label as label
    from kinesphere.pipeline import Settings as Settings
    from kinesphere.pipeline import retarget as retarget
    from kinesphere.pipeline import solve as solve
    from kinesphere.report import report_html as report_html

try:
    __version__ = version("kinesphere")
except PackageNotFoundError:  # run from a source tree that nobody installed
    __version__ = "0+unknown"

_ROOMS = {
    "comparison": "Comparison compare",
    "data": (
        "Analog Event Joint Limb Motion Output Parameters Recording Skeleton Solution "
        "Surface TopologicalModel bundled_body motion_from_parameters"
    ),
    "data.edits": "Edit",
    "data.isb": "IsbAngles isb_angles",
    "editing": "apply_edits attach_surface skin",
    "errors": "KinesphereError",
    "io": "read read_rig write write_on_rig",
    "labelling": "LiveLabeller built_in_model label",
    "pipeline": "Settings retarget solve",
    "report": "report_html",
}
_ROOM_OF = {name: room for room, names in _ROOMS.items() for name in names.split()}


def __getattr__(name: str) -> Any:
    if name not in _ROOM_OF:
        raise AttributeError(f"module 'kinesphere' has no attribute {name!r}")
    return getattr(import_module(f"kinesphere.{_ROOM_OF[name]}"), name)


def __dir__() -> list[str]:
    return sorted([*globals(), *_ROOM_OF])
