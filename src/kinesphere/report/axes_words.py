"""Where each axis of a joint comes from and how well it is determined, in words."""

from collections.abc import Iterable, Mapping, Sequence

from kinesphere.data import Json, Step


def origins_in_words(sources: Sequence[str], reused_from: Sequence[str | None]) -> str:
    """Return where a joint's axes come from; axis by axis where they differ, empty without any.

    Parameters
    ----------
    sources, reused_from
        Of each axis, as `Joint.axes_sources` and `Joint.axes_reused_from` tell them; the latter
        empty where none is reused.
    """
    origins = [
        f"reused from {name}" if name else f"from {source}"
        for source, name in zip(sources, reused_from or [""] * len(sources), strict=True)
    ]
    if len(set(origins)) <= 1:
        return f"{len(origins)} {origins[0]}" if origins else ""
    return ", ".join(f"axis {k} {origin}" for k, origin in enumerate(origins, start=1))


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
