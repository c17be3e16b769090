"""What motion alone told, drawn: bodies in colour, their tree, what is uncertain, and the count."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from kinesphere.data import Solution
from kinesphere.report.wording import number_in_words

STEP = "discovery"
"""Name of the step whose findings are drawn."""
GOLDEN_ANGLE = 137.508
"""deg between one hue and the next: any number of colours, none near to those just before."""
UNSURE = 0.5
"""Confidence below which a marker or body counts as unsure."""

ROW, COLUMN, MARGIN = 78, 98, 34
NAME = 16
"""How far below a body's circle its name reaches; joints to what hangs from it begin there."""
CURVE = (360, 190)


@dataclass(frozen=True)
class Node:
    """A body in the drawing of the tree."""

    name: str
    colour: str
    x: float
    y: float
    radius: float


@dataclass(frozen=True)
class Line:
    """A joint in the drawing of the tree."""

    x1: float
    y1: float
    x2: float
    y2: float
    confidence: str
    doubtful: bool
    title: str


@dataclass(frozen=True)
class BodyRow:
    """A body in the table."""

    name: str
    colour: str
    markers: str
    unsure: str
    within: str
    confidence: float


@dataclass(frozen=True)
class Bodies:
    """Everything the section shows."""

    n_bodies: int
    trees: int
    count_confidence: str
    names_confidence: str
    nodes: tuple[Node, ...]
    lines: tuple[Line, ...]
    width: float
    height: float
    rows: tuple[BodyRow, ...]
    loose: str
    ghosts: str
    others: tuple[str, ...]
    curve: str
    """Points of an SVG polyline."""
    curve_size: tuple[int, int]
    found_x: float
    """Where the number of bodies found lies on the curve."""
    ticks: tuple[tuple[float, int], ...]
    top: str
    """Largest value of the curve, in words."""


def colour_of(number: int) -> str:
    """Return the colour of a body by its number."""
    return f"hsl({number * GOLDEN_ANGLE % 360:.0f} 62% 52%)"


def marker_colours(solution: Solution) -> dict[str, list[str]]:
    """Return label → colour of its body and, at a joint, of the next; empty with a model."""
    found = _findings(solution)
    if found is None:
        return {}
    colours = {name: colour_of(i) for i, name in enumerate(solution.skeleton.limb_names)}
    shared = found["at_joints"]
    return {
        label: [
            colours[limb.name],
            *([colours[shared[label]]] if shared.get(label) in colours else []),
        ]
        for limb in solution.skeleton.limbs
        for label in limb.markers
    }


def find_bodies(solution: Solution) -> Bodies | None:
    """Return what the section shows, None where the labels came with a model."""
    found = _findings(solution)
    if found is None:
        return None
    colours = {name: colour_of(i) for i, name in enumerate(solution.skeleton.limb_names)}
    places = _places(solution)
    joints = found["joints_found"]
    radii = {limb.name: 6 + min(len(limb.markers), 8) for limb in solution.skeleton.limbs}
    return Bodies(
        n_bodies=found["bodies_found"],
        trees=found["trees"],
        count_confidence=number_in_words(found["count_confidence"]),
        names_confidence=number_in_words(found["names_confidence"]),
        nodes=tuple(
            Node(name.replace("_", " "), colours[name], x, y, radii[name])
            for name, (x, y) in places.items()
        ),
        lines=tuple(
            Line(
                *_below(places[joint["parent"]], radii[joint["parent"]] + NAME),
                *places[joint["child"]],
                _confidence(joint),
                joint.get("doubtful", False),
                f"{name.replace('_', ' ')}: cost {number_in_words(joint['cost_mm'], 'mm')}, "
                f"next best {number_in_words(joint['next_best_mm'], 'mm')}",
            )
            for name, joint in joints.items()
            if joint["parent"] in places and joint["child"] in places
        ),
        width=max(x for x, _ in places.values()) + COLUMN / 2,
        height=max(y for _, y in places.values()) + ROW / 2,
        rows=tuple(_row(name, body, colours, found) for name, body in found["bodies"].items()),
        loose=", ".join(found["loose"]),
        ghosts=", ".join(found["ghosts"]),
        others=tuple(", ".join(markers) for markers in found["other_trees"]),
        **_curve(found["merge_curve_mm"], found["bodies_found"]),
    )


def _below(place: tuple[float, float], by: float) -> tuple[float, float]:
    return place[0], place[1] + by


def _findings(solution: Solution) -> dict[str, Any] | None:
    step = next((step for step in solution.history if step.name == STEP), None)
    return None if step is None else dict(step.findings)


def _confidence(joint: Mapping[str, Any]) -> str:
    """Return a joint's confidence; of a doubtful one without a rival a question mark."""
    if joint.get("doubtful", False) and joint["next_best_mm"] is None:
        return "?"
    return f"{joint['confidence']:.2f}"


def _row(
    name: str, body: Mapping[str, Any], colours: Mapping[str, str], found: Mapping[str, Any]
) -> BodyRow:
    sure = found["marker_confidence"]
    labels = body["markers"].split(", ")
    return BodyRow(
        name=name.replace("_", " "),
        colour=colours.get(name, "transparent"),
        markers=body["markers"],
        unsure=", ".join(label for label in labels if sure.get(label, 1.0) < UNSURE),
        within=number_in_words(body["within_mm"], "mm"),
        confidence=body["confidence"],
    )


def _places(solution: Solution) -> dict[str, tuple[float, float]]:
    """Return limb → (x, y): depth downward, every leaf a column, parents amid their children."""
    skeleton = solution.skeleton
    children: dict[str, list[str]] = {name: [] for name in skeleton.limb_names}
    for joint in skeleton.joints:
        children[joint.parent].append(joint.child)
    places: dict[str, tuple[float, float]] = {}
    columns = 0

    def place(name: str, depth: int) -> float:
        nonlocal columns
        below = [place(child, depth + 1) for child in children[name]]
        if below:
            x = (below[0] + below[-1]) / 2
        else:
            x = COLUMN / 2 + columns * COLUMN
            columns += 1
        places[name] = (x, MARGIN + depth * ROW)
        return x

    place(skeleton.limb_names[0], 0)
    return places


def _curve(curve: Mapping[str, float], n_bodies: int) -> dict[str, Any]:
    wide, high = CURVE
    counts = [int(k) for k in curve]
    values = [float(value) for value in curve.values()]
    most, top = max([*counts, n_bodies, 2]), max([*values, 1e-9])

    def x(count: int) -> float:
        return round(wide * (count - 1) / (most - 1), 1)

    return {
        "curve": " ".join(
            f"{x(count)},{high * (1 - value / top):.1f}"
            for count, value in zip(counts, values, strict=True)
        ),
        "curve_size": CURVE,
        "found_x": x(n_bodies),
        "ticks": tuple((x(k), k) for k in range(5, most + 1, 5)),
        "top": number_in_words(top, "mm"),
    }
