"""A comparison in figures, for machines and for people."""

from math import degrees
from typing import Any

import numpy as np

from kinesphere.cli.console import print_pairs, print_table, print_title, print_warnings, stdout
from kinesphere.comparison import Agreement, Comparison, ParameterComparison
from kinesphere.report import counted


def describe_comparison(found: Comparison) -> dict[str, Any]:
    """Return every figure of a comparison; units are in the names."""
    offset, world = found.offset, found.world
    return {
        "offset_s": offset.seconds,
        "offset_given": offset.given,
        "shared": {
            "clock": found.kinship.clock,
            "world": found.kinship.world,
            "limb_frames": found.kinship.limbs,
        },
        "offset_correlation": offset.correlation,
        "overlap_s": offset.overlap,
        "n_frames": len(found.times),
        "rate_hz": found.rate,
        "world": None
        if world is None
        else {
            "rotation": world.rotation.tolist(),
            "shift_m": world.shift.tolist(),
            "turn_deg": float(np.rad2deg(world.turn)),
            "tilt_deg": float(np.rad2deg(world.tilt)),
            "residual_mm": world.residual * 1e3,
        },
        "limbs": [
            {
                "name": limb.limb,
                "other": limb.other,
                "turn_deg": float(np.rad2deg(limb.turn)),
                "spread_deg": float(np.rad2deg(limb.spread)),
                "rotation": limb.rotation.tolist(),
            }
            for limb in found.limbs
        ],
        "joints": [
            {
                "name": joint.name,
                "orientation_before_deg": float(np.rad2deg(joint.orientation_before)),
                "orientation_after_deg": float(np.rad2deg(joint.orientation_after)),
                "centre_mm": joint.centre * 1e3,
                "centre_constant_mm": joint.centre_constant * 1e3,
                "centre_after_mm": joint.centre_after * 1e3,
            }
            for joint in found.joints
        ],
        "parameters": [
            {
                "joint": p.joint,
                "name": p.name,
                "kind": p.kind,
                "before": None if p.before is None else _figures(p.before),
                "after": _figures(p.after),
            }
            for p in found.parameters
        ],
        "only_in_first": {"limbs": found.limbs_only_first, "joints": found.joints_only_first},
        "only_in_second": {"limbs": found.limbs_only_second, "joints": found.joints_only_second},
        "warnings": found.warnings,
    }


def _figures(a: Agreement) -> dict[str, Any]:
    return {
        "n": a.n,
        "n_effective": a.n_effective,
        "rmsd_deg": degrees(a.rmsd),
        "bias_deg": degrees(a.bias),
        "bias_error_deg": degrees(a.bias_error),
        "sd_deg": degrees(a.sd),
        "limits_deg": [degrees(limit) for limit in a.limits],
        "limits_error_deg": degrees(a.limits_error),
        "correlation": a.correlation,
        "cmc": a.cmc,
        "slope": a.slope,
    }


def show_comparison(found: Comparison, title: str) -> None:
    """Print how the two were aligned, then joints, then angles."""
    console = stdout()
    offset, world = found.offset, found.world
    print_title(console, title, "differences are the second minus the first")
    pairs = [
        ("time offset", f"{offset.seconds:+.4f} s ({offset.source})"),
        (
            "in common",
            f"{counted(len(found.times), 'frame')}, {offset.overlap:.2f} s at {found.rate:g} Hz",
        ),
    ]
    if world is not None:
        turned = f"turned {np.rad2deg(world.turn):.1f}°, moved {np.linalg.norm(world.shift):.3f} m"
        how = "that of their one recording" if found.kinship.world else turned
        apart = f"joint centres are {world.residual * 1e3:.1f} mm apart (rms)"
        pairs.append(("world", f"{how}; {apart}"))
    for who, limbs, joints in (
        ("only in A", found.limbs_only_first, found.joints_only_first),
        ("only in B", found.limbs_only_second, found.joints_only_second),
    ):
        if limbs or joints:
            pairs.append((who, ", ".join((*limbs, *joints))))
    print_pairs(console, pairs)
    print_title(console, "Joints", "rms; aligned: without constant turns of the limb frames")
    print_table(
        console,
        ("joint", "orientation", "aligned", "centres", "of it constant", "remaining"),
        [
            (
                j.name,
                _deg(j.orientation_before),
                _deg(j.orientation_after),
                _mm(j.centre),
                _mm(j.centre_constant),
                _mm(j.centre_after),
            )
            for j in found.joints
        ],
        "lrrrrr",
    )
    if found.kinship.limbs:
        print_title(console, "Limb frames", "one skeleton, one set of frames: no turn is taken out")
    else:
        turns = ", ".join(f"{limb.limb} {_deg(limb.turn)}" for limb in found.limbs)
        print_title(console, "Limb frames", "constant turn, taken out")
        print_pairs(console, [("", turns)])
    print_title(console, "Angles", "RMSD before and after alignment, 95 % limits of agreement")
    print_table(
        console,
        ("joint", "angle", "before", "after", "bias", "limits", "n eff.", "r", "CMC"),
        [
            (
                p.joint,
                p.name.replace("_", " "),
                _deg(p.before.rmsd) if p.before is not None else "–",
                _deg(p.after.rmsd),
                _deg(p.after.bias, sign="+"),
                f"{_deg(p.after.limits[0], sign='+')} … {_deg(p.after.limits[1], sign='+')}",
                _number(p.after.n_effective, ".0f"),
                _number(p.after.correlation, ".3f"),
                _number(p.after.cmc, ".3f"),
            )
            for p in _in_short(found)
        ],
        "llrrrrrrr",
    )
    console.print("Angles about own axes and between limbs: in the page (-o) and in --json")
    if found.warnings:
        print_title(console, "Warnings")
        print_warnings(console, list(found.warnings), frozenset())


def _in_short(found: Comparison) -> list[ParameterComparison]:
    """Return the clinical angles; of joints that have none, the others."""
    named = {p.joint for p in found.parameters if p.kind == "clinical"}
    return [p for p in found.parameters if p.kind == "clinical" or p.joint not in named]


def _deg(radians: float, sign: str = "") -> str:
    return _number(
        round(degrees(radians), 1) + 0.0 if radians == radians else radians, f"{sign}.1f", "°"
    )


def _mm(metres: float) -> str:
    return _number(metres * 1e3, ".1f", " mm")


def _number(value: float, form: str, unit: str = "") -> str:
    return "–" if value != value else f"{value:{form}}{unit}"
