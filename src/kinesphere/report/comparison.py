"""One HTML file that shows two solutions of one motion side by side."""

import base64
import hashlib
from typing import Any

import numpy as np
from markupsafe import Markup

import kinesphere
from kinesphere.comparison import Comparison, ParameterComparison
from kinesphere.data.sticks import side_of
from kinesphere.report.assets_of import asset, environment
from kinesphere.report.plots import Curve, curves, dots
from kinesphere.report.tiles import Tile
from kinesphere.report.wording import counted, in_words, number_in_words

KINDS = {
    "bend": "bend: the angle between two limbs",
    "clinical": "clinical (ISB)",
    "own": "about the first's own axes",
}


def comparison_html(
    found: Comparison, first: str = "first", second: str = "second", joint: str | None = None
) -> str:
    """Return the report of a comparison as one self-contained HTML page.

    Parameters
    ----------
    found
        As ``kinesphere.compare`` returns it.
    first, second
        What the two are called.
    joint
        The one whose curves are shown at first; the one that moves most, if None.

    Raises
    ------
    KeyError
        If there is no such joint.
    """
    names = list(dict.fromkeys(p.joint for p in found.parameters))
    shown = joint or widest_joint(found)
    if shown not in names:
        raise KeyError(shown)
    script = Markup(asset("comparison.js"))
    page = environment().from_string(asset("comparison.html.j2"))
    return page.render(
        first=first,
        second=second,
        version=kinesphere.__version__,
        warnings=found.warnings,
        tiles=_tiles(found),
        names=[(name, in_words(name)) for name in names],
        shown=shown,
        kinds=list(KINDS.items()),
        figures=[_figure(found, p) for p in found.parameters],
        joints=_joint_rows(found),
        one_skeleton=found.kinship.limbs,
        limbs=[(in_words(limb.limb), _deg(limb.turn), _deg(limb.spread)) for limb in found.limbs],
        only=[
            (who, ", ".join(in_words(n) for n in things))
            for who, things in (
                (f"limbs of {first} only", found.limbs_only_first),
                (f"limbs of {second} only", found.limbs_only_second),
                (f"joints of {first} only", found.joints_only_first),
                (f"joints of {second} only", found.joints_only_second),
            )
            if things
        ],
        style=Markup(asset("page.css") + asset("comparison.css")),
        script=script,
        script_hash=base64.b64encode(hashlib.sha256(script.encode()).digest()).decode(),
    )


def widest_joint(found: Comparison) -> str:
    """Return the joint that bends through the widest range; an elbow or knee in most recordings."""
    bends = [p for p in found.parameters if p.kind == "bend"]

    def range_of(p: ParameterComparison) -> float:
        known = p.first[np.isfinite(p.first)]
        return float(np.ptp(np.percentile(known, [5, 95]))) if len(known) else 0.0

    return max(bends, key=range_of).joint


def _tiles(found: Comparison) -> list[Tile]:
    offset = found.offset
    before = [joint.orientation_before for joint in found.joints]
    after = [joint.orientation_after for joint in found.joints]
    centres = [joint.centre for joint in found.joints]
    left = [joint.centre_after for joint in found.joints]
    return [
        Tile(
            "Time offset",
            f"{offset.seconds * 1e3:+.1f} ms".replace("-", "−"),
            offset.source,
        ),
        Tile(
            "In common",
            counted(len(found.times), "frame"),
            f"{offset.overlap:.2f} s at {found.rate:g} Hz, {len(found.joints)} joints",
        ),
        Tile(
            "World",
            *_world(found),
        ),
        Tile(
            "Orientation",
            _deg(float(np.nanmedian(after))),
            f"rms, median joint; {_deg(float(np.nanmedian(before)))} before frames are aligned",
        ),
        Tile(
            "Joint centres",
            _mm(float(np.nanmedian(left))),
            f"rms, median joint; {_mm(float(np.nanmedian(centres)))} with constant shifts",
        ),
    ]


def _world(found: Comparison) -> tuple[str, str]:
    """Return how the worlds lie, and what that is."""
    world = found.world
    if found.kinship.world:
        return "one", "that of their recording; nothing is turned"
    if world is None:
        return "not fitted", ""
    moved = f"{np.linalg.norm(world.shift):.2f} m moved; verticals {_deg(world.tilt)}"
    return _deg(world.turn), f"turned, {moved}"


def _figure(found: Comparison, p: ParameterComparison) -> dict[str, Any]:
    first, aligned = np.rad2deg(p.first), np.rad2deg(p.aligned)
    lines = [Curve("one", first), Curve("two", aligned)]
    if p.second is not None and p.before is not None and p.before.rmsd - p.after.rmsd > 1e-3:
        lines.insert(0, Curve("raw", np.rad2deg(p.second)))
    a = p.after
    low, high = np.rad2deg(a.limits)
    return {
        "joint": p.joint,
        "kind": p.kind,
        "side": side_of(p.joint),
        "title": f"{in_words(p.joint)}: {in_words(p.name)}",
        "name": in_words(p.name),
        "curves": curves(found.times, lines),
        "dots": dots(
            (first + aligned) / 2,
            aligned - first,
            (("bias", float(np.rad2deg(a.bias))), ("limit", low), ("limit", high)),
        ),
        "raw": len(lines) > 2,
        "before": "–" if p.before is None else _deg(p.before.rmsd),
        "bias_before": "–" if p.before is None else _signed(p.before.bias),
        "rmsd": _deg(a.rmsd),
        "bias": _signed(a.bias),
        "bias_error": _deg(a.bias_error),
        "limits": f"{_signed(a.limits[0])} … {_signed(a.limits[1])}",
        "limits_error": _deg(a.limits_error),
        "n": f"{a.n:,}",
        "n_effective": number_in_words(a.n_effective, digits=2),
        "correlation": _plain(a.correlation),
        "cmc": _plain(a.cmc),
        "slope": _plain(a.slope),
    }


def _joint_rows(found: Comparison) -> list[tuple[str, ...]]:
    return [
        (
            in_words(joint.name),
            _deg(joint.orientation_before),
            _deg(joint.orientation_after),
            _mm(joint.centre),
            _mm(joint.centre_constant),
            _mm(joint.centre_after),
        )
        for joint in found.joints
    ]


def _deg(radians: float) -> str:
    return "–" if not np.isfinite(radians) else f"{np.rad2deg(radians):.1f}°"


def _signed(radians: float) -> str:
    if not np.isfinite(radians):
        return "–"
    return f"{np.round(np.rad2deg(radians), 1) + 0.0:+.1f}°".replace("-", "−")


def _plain(value: float) -> str:
    return "–" if not np.isfinite(value) else f"{value:.3f}".replace("-", "−")


def _mm(metres: float) -> str:
    return number_in_words(metres * 1e3, "mm")
