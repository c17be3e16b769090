"""How well each axis of a joint is determined, in words."""

from collections.abc import Iterable, Mapping

from kinesphere.data import Json, Step


def axes_in_detail(name: str, history: Iterable[Step]) -> str:
    """Return a line for each axis that a joint's movement told; empty for those of the body.

    Its standard deviation in any direction, the arc that the limb went about it, and its
    conditioning: how many times larger the rotation about it was than about any other, rms.
    """
    told = _told(name, history)
    lines = []
    deviations, arcs, ratios, sources = (
        _listed(told.get(key))
        for key in ("axes_uncertainty_deg", "ranges_deg", "conditioning", "axes_sources")
    )
    for k, deviation in enumerate(deviations):
        figures = [f"± {deviation:.1f}°"] if isinstance(deviation, float) else []
        if k < len(arcs) and isinstance(arcs[k], float):
            figures.append(f"over {arcs[k]:.0f}°")
        if k < len(ratios) and isinstance(ratios[k], float):
            figures.append(f"rotation {ratios[k]:.3g} times larger than about others")
        if isinstance(deviation, float):
            lines.append(f"axis {k + 1} {', '.join(figures)}")
        elif k < len(sources) and sources[k] == "body" and set(sources) != {"body"}:
            lines.append(f"axis {k + 1} put across, nearest the body frame's")
    return "; ".join(lines)


def _told(name: str, history: Iterable[Step]) -> Mapping[str, Json]:
    for step in reversed(tuple(history)):
        joints = step.findings.get("joints")
        if step.name == "parameterization" and isinstance(joints, Mapping):
            found = joints.get(name)
            return found if isinstance(found, Mapping) else {}
    return {}


def _listed(value: Json) -> list[Json]:
    return list(value) if isinstance(value, list | tuple) else []
