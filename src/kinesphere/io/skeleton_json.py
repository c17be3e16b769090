"""``skeleton.json``: limbs, joints, tree, lengths, axes, rest positions, uncertainty."""

from pathlib import Path
from typing import Annotated, Any, Literal, TypeAlias

import numpy as np
from pydantic import BaseModel, ConfigDict, Field, ValidationError

from kinesphere.data import AxesSource, Joint, Limb, Observability, Skeleton, Step
from kinesphere.data.conventions import CONVENTIONS
from kinesphere.data.validation import first_problem
from kinesphere.errors import BadModel, UnreadableFile
from kinesphere.io.json_files import read_json, write_json

SKELETON_FORMAT: Literal["kinesphere-skeleton-1"] = "kinesphere-skeleton-1"

_Triple: TypeAlias = tuple[float, float, float]
_Matrix: TypeAlias = tuple[_Triple, _Triple, _Triple]
_Unknown: TypeAlias = tuple[float | None, float | None, float | None]


class _Loose(BaseModel):
    """Other programs may add keys of their own."""

    model_config = ConfigDict(extra="ignore", allow_inf_nan=False, frozen=True)


class _Limb(_Loose):
    name: str
    parent: str | None
    markers: tuple[str, ...]
    marker_positions_m: tuple[_Triple, ...]
    length_m: float | None
    long_axis: _Triple


class _Uncertainty(_Loose):
    residual_m: float | None
    covariance_m2: tuple[_Unknown, _Unknown, _Unknown]
    axes_rad: tuple[float | None, ...] | None


class _Joint(_Loose):
    name: str
    parent: str
    child: str
    centre_in_parent_m: _Triple
    centre_in_child_m: _Triple
    axes: Annotated[tuple[_Triple, ...], Field(min_length=1, max_length=3)] | None
    rest: _Matrix | None
    uncertainty: _Uncertainty
    observability: Observability
    range_of_motion_rad: float | None
    axes_source: AxesSource | None
    axes_sources: tuple[AxesSource, ...] = ()
    axes_reused_from: tuple[str | None, ...] = ()
    note: str = ""


class _Skeleton(_Loose):
    format: Literal["kinesphere-skeleton-1"] = SKELETON_FORMAT
    limbs: tuple[_Limb, ...] = Field(min_length=1)
    joints: tuple[_Joint, ...]


def skeleton_to_dict(skeleton: Skeleton) -> dict[str, Any]:
    """Return what ``skeleton.json`` holds; arrays are still arrays and NaN still NaN."""
    return {
        "format": SKELETON_FORMAT,
        "conventions": CONVENTIONS,
        "limbs": [
            {
                "name": limb.name,
                "parent": limb.parent,
                "markers": limb.markers,
                "marker_positions_m": limb.marker_positions,
                "length_m": limb.length,
                "long_axis": limb.long_axis,
            }
            for limb in skeleton.limbs
        ],
        "joints": [
            {
                "name": joint.name,
                "parent": joint.parent,
                "child": joint.child,
                "centre_in_parent_m": joint.centre_in_parent,
                "centre_in_child_m": joint.centre_in_child,
                "axes": joint.axes,
                "rest": joint.rest,
                "uncertainty": {
                    "residual_m": joint.residual,
                    "covariance_m2": joint.covariance,
                    "axes_rad": joint.axes_uncertainty,
                },
                "observability": joint.observability,
                "range_of_motion_rad": joint.range_of_motion,
                "axes_source": joint.axes_source,
                "axes_sources": joint.axes_sources,
                "axes_reused_from": [name or None for name in joint.axes_reused_from],
                "note": joint.note,
            }
            for joint in skeleton.joints
        ],
    }


def write_skeleton(skeleton: Skeleton, path: str | Path) -> None:
    """Write ``skeleton.json``; NaN becomes null, numbers are printed to the last bit."""
    write_json(skeleton_to_dict(skeleton), path)


def read_skeleton(path: str | Path) -> Skeleton:
    """Read ``skeleton.json``.

    Raises
    ------
    UnreadableFile
        Naming the place that is wrong (``joints[2].axes``), or what contradicts what.
    """
    path = Path(path)
    content = read_json(path)
    try:
        s = _Skeleton.model_validate(content)
        step = Step(
            name="read",
            settings={"format": "skeleton", "file": path.name},
            findings={"n_limbs": len(s.limbs), "n_joints": len(s.joints)},
        )
        return Skeleton(
            limbs=tuple(map(_limb, s.limbs)), joints=tuple(map(_joint, s.joints)), history=(step,)
        )
    except ValidationError as error:
        raise UnreadableFile(f"{path}: {first_problem(error)}") from None
    except (BadModel, ValueError) as error:
        raise UnreadableFile(f"{path}: {error}") from None


def _limb(found: _Limb) -> Limb:
    return Limb(
        name=found.name,
        parent=found.parent,
        markers=found.markers,
        marker_positions=np.array(found.marker_positions_m, dtype=np.float64).reshape(-1, 3),
        length=_nan(found.length_m),
        long_axis=np.array(found.long_axis),
    )


def _joint(found: _Joint) -> Joint:
    uncertainty = found.uncertainty
    axes = None if found.axes is None else np.array(found.axes)
    spread = None if uncertainty.axes_rad is None else np.array(uncertainty.axes_rad, np.float64)
    return Joint(
        name=found.name,
        parent=found.parent,
        child=found.child,
        centre_in_parent=np.array(found.centre_in_parent_m),
        centre_in_child=np.array(found.centre_in_child_m),
        residual=_nan(uncertainty.residual_m),
        range_of_motion=_nan(found.range_of_motion_rad),
        covariance=np.array(uncertainty.covariance_m2, dtype=np.float64),
        observability=found.observability,
        axes=axes,
        rest=None if found.rest is None else np.array(found.rest),
        axes_source=found.axes_source,
        axes_assumed=_assumed(found),
        axes_reused_from=tuple(name or "" for name in found.axes_reused_from),
        axes_uncertainty=spread,
        note=found.note,
    )


def _assumed(found: _Joint) -> tuple[bool, ...]:
    """Return which axes are the body frame's among others; files of old do not tell."""
    assumed = tuple(source == "body" for source in found.axes_sources)
    return assumed if found.axes_source != "body" and any(assumed) else ()


def _nan(value: float | None) -> float:
    return np.nan if value is None else value
