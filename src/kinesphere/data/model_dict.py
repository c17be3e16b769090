"""The topological model as plain dictionaries and lists: what a model's JSON file holds.

Lengths are in metres and their keys end in ``_m``. A value nobody knows is ``null``, never NaN.
"""

from typing import Annotated, Any, Literal, TypeAlias

import numpy as np
from pydantic import BaseModel, ConfigDict, Field, ValidationError, model_validator

from kinesphere.data.arrays import Array
from kinesphere.data.history import Json
from kinesphere.data.model import (
    JointModel,
    Landmark,
    MarkerStatistics,
    Segment,
    TopologicalModel,
)
from kinesphere.data.validation import first_problem
from kinesphere.errors import BadModel

MODEL_FORMAT: Literal["kinesphere-model-1"] = "kinesphere-model-1"
WEIGHT_SLACK = 1e-6
"""Weights of a landmark may miss 1 by this much: decimal thirds do."""

_Name: TypeAlias = Annotated[str, Field(min_length=1)]
_Distances: TypeAlias = tuple[tuple[Annotated[float, Field(ge=0)] | None, ...], ...]


_Index: TypeAlias = Annotated[int, Field(ge=0)]
_Share: TypeAlias = Annotated[float, Field(ge=-1, le=1)]


class _Strict(BaseModel):
    """No unknown keys, no NaN: a typing error must not pass as a default."""

    model_config = ConfigDict(extra="forbid", allow_inf_nan=False, frozen=True)


class _Segment(_Strict):
    """A limb as the layout knows it."""

    name: _Name = Field(description="Limb name of the conventions, or limb_01… where unknown.")
    markers: tuple[_Name, ...] = Field(description="Labels that move rigidly with this segment.")
    shared: tuple[_Name, ...] = Field((), description="Labels a neighbour owns, near a joint.")


class _Landmark(_Strict):
    """Where a joint centre is expected before the motion has its say."""

    weights: dict[_Name, float] = Field(
        min_length=1, description="Label → weight; the weights add up to 1."
    )
    scale: tuple[_Name, _Name] | None = Field(
        None, description="Two labels whose distance scales inward, down and forward."
    )
    inward: float = Field(0.0, description="Towards the middle of the body, in scales.")
    down: float = Field(0.0, description="Along the body's axis, in scales.")
    forward: float = Field(0.0, description="To the front, in scales.")
    plane: tuple[_Name, ...] = Field(
        (),
        description="Left and right label of a pair, and one or more behind: inward, down and "
        "forward are along and across the plane of those; empty for the body's own axes.",
    )
    offset_m: tuple[float, float, float] = Field(
        (0.0, 0.0, 0.0), description="Inward, down and forward besides, m; only with a plane."
    )
    spread_m: float = Field(0.03, gt=0, description="Standard deviation of the true centre, m.")
    source: str = Field("", description="Paper or measurement the numbers come from.")

    @model_validator(mode="after")
    def _weights_add_up(self) -> "_Landmark":
        total = sum(self.weights.values())
        if abs(total - 1) > WEIGHT_SLACK:
            raise ValueError(f"weights add up to {total:g}; they must add up to 1")
        if self.scale is None and (self.inward or self.down or self.forward):
            raise ValueError("inward, down and forward need scale: two labels to measure by")
        if self.plane and len(set(self.plane)) < max(3, len(self.plane)):
            raise ValueError(
                f"plane has {', '.join(self.plane)}; it needs three or more labels, each once"
            )
        if any(self.offset_m) and not self.plane:
            raise ValueError("offset_m needs plane: labels that tell its directions")
        return self


class _Joint(_Strict):
    """Two segments that meet."""

    name: _Name
    parent: _Name = Field(description="Name of the segment nearer to the root.")
    child: _Name = Field(description="Name of the segment that hangs from it.")
    n_axes: Literal[1, 2, 3] | None = Field(
        None, description="Movement axes besides twist; null to find out from the motion."
    )
    landmarks: tuple[_Landmark, ...] = Field((), description="Best first.")
    doubtful: bool = Field(
        False, description="Whether motion alone told that they meet, and was not sure of it."
    )


class _Statistics(_Strict):
    """Distances between markers, learnt from one recording."""

    recording: str = Field(description="A name for the recording, never a path.")
    labels: tuple[_Name, ...]
    mean_m: _Distances = Field(
        description="One row a label, m; null where two markers were never seen together."
    )
    deviation_m: _Distances = Field(description="Standard deviation over time, m.")
    handedness: tuple[tuple[_Index, _Index, _Index, _Index, _Share], ...] = Field(
        (),
        description="[a, b, c, d, sign]: four labels, numbered from 0, whose volume keeps its "
        "sign; its mean, −1 to 1.",
    )

    @model_validator(mode="after")
    def _square(self) -> "_Statistics":
        n = len(self.labels)
        for name, rows in (("mean_m", self.mean_m), ("deviation_m", self.deviation_m)):
            widths = {len(row) for row in rows}
            if len(rows) != n or widths - {n}:
                found = f"{len(rows)} rows of {', '.join(map(str, sorted(widths))) or 0}"
                raise ValueError(f"{name} has {found}; {n} labels need {n} rows of {n}")
        if self.handedness and (last := max(max(row[:4]) for row in self.handedness)) >= n:
            raise ValueError(f"handedness names label {last}; {n} labels are numbered from 0")
        return self


class _Model(_Strict):
    """Which markers sit on which segment, and which segments meet at a joint."""

    format: Literal["kinesphere-model-1"] = MODEL_FORMAT
    name: _Name
    description: str = ""
    root: _Name = Field(description="Name of the segment every other hangs from.")
    segments: tuple[_Segment, ...] = Field(min_length=1)
    joints: tuple[_Joint, ...]
    required: tuple[_Name, ...] = Field(
        (), description="Labels that identify the layout; 90 % of them must be there."
    )
    mirror: tuple[tuple[_Name, _Name], ...] = Field((), description="[left, right] labels.")
    aliases: dict[_Name, _Name] = Field({}, description="Other spelling → label of this model.")
    statistics: tuple[_Statistics, ...] = ()


def model_from_dict(content: Any, where: str = "model") -> TopologicalModel:
    """Return the topological model that a decoded JSON object describes.

    Parameters
    ----------
    content
        What ``json.loads`` returned; see ``model_schema`` for its form.
    where
        What to call it in an error: a file or a model name.

    Raises
    ------
    BadModel
        In one line: the first thing that is wrong, its place (``segments[2].markers``), what was
        found there, and how many more there are.
    """
    try:
        m = _Model.model_validate(content)
    except ValidationError as error:
        raise BadModel(f"{where}: {first_problem(error)}") from None
    try:
        return TopologicalModel(
            name=m.name,
            segments=tuple(Segment(s.name, s.markers, s.shared) for s in m.segments),
            joints=tuple(
                JointModel(
                    j.name,
                    j.parent,
                    j.child,
                    j.n_axes,
                    tuple(map(_landmark, j.landmarks)),
                    j.doubtful,
                )
                for j in m.joints
            ),
            root=m.root,
            required=m.required,
            mirror=m.mirror,
            aliases=m.aliases,
            statistics=tuple(
                MarkerStatistics(
                    s.labels,
                    _nan(s.mean_m),
                    _nan(s.deviation_m),
                    s.recording,
                    np.array([row[:4] for row in s.handedness], dtype=np.int64).reshape(-1, 4),
                    np.array([row[4] for row in s.handedness], dtype=np.float64),
                )
                for s in m.statistics
            ),
            description=m.description,
        )
    except BadModel as error:
        raise BadModel(f"{where}: {error}") from None


def model_to_dict(model: TopologicalModel) -> dict[str, Json]:
    """Return the model as ``json.dumps`` takes it; the inverse of ``model_from_dict``.

    Distances that are NaN become None.
    """
    return {
        "format": MODEL_FORMAT,
        "name": model.name,
        "description": model.description,
        "root": model.root,
        "segments": [
            {"name": s.name, "markers": list(s.markers), "shared": list(s.shared)}
            for s in model.segments
        ],
        "joints": [
            {
                "name": j.name,
                "parent": j.parent,
                "child": j.child,
                "n_axes": j.n_axes,
                "landmarks": [_landmark_dict(landmark) for landmark in j.landmarks],
                **({"doubtful": True} if j.doubtful else {}),
            }
            for j in model.joints
        ],
        "required": list(model.required),
        "mirror": [[left, right] for left, right in model.mirror],
        "aliases": dict(model.aliases),
        "statistics": [
            {
                "recording": s.recording,
                "labels": list(s.labels),
                "mean_m": _null(s.mean),
                "deviation_m": _null(s.deviation),
                "handedness": [
                    [*map(int, four), float(sign)]
                    for four, sign in zip(s.quadruples, s.handedness, strict=True)
                ],
            }
            for s in model.statistics
        ],
    }


def model_schema() -> dict[str, Any]:
    """Return the JSON Schema (draft 2020-12) of a model file."""
    schema = _Model.model_json_schema()
    schema["title"] = "Kinesphere topological model"
    return {"$schema": "https://json-schema.org/draft/2020-12/schema", **schema}


def _landmark(found: _Landmark) -> Landmark:
    values = found.model_dump()
    return Landmark(spread=values.pop("spread_m"), offset=values.pop("offset_m"), **values)


def _landmark_dict(landmark: Landmark) -> dict[str, Json]:
    return {
        "weights": dict(landmark.weights),
        "scale": None if landmark.scale is None else list(landmark.scale),
        "inward": landmark.inward,
        "down": landmark.down,
        "forward": landmark.forward,
        "plane": list(landmark.plane),
        "offset_m": list(landmark.offset),
        "spread_m": landmark.spread,
        "source": landmark.source,
    }


def _nan(rows: _Distances) -> Array:
    n = len(rows)
    return np.array(rows, dtype=np.float64).reshape(n, n)  # None becomes NaN


def _null(distances: Array) -> list[Json]:
    rows = distances.tolist()
    return [[None if value != value else value for value in row] for row in rows]
