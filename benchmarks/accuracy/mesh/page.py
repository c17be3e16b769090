"""The page of the surface's results."""

from typing import Any

TWIST_KEPT, GLB_SECONDS = 0.90, 3.0
JOINTS_MM, WEIGHTS_PERCENT = 2.0, 2.0


def page(found: dict[str, Any]) -> tuple[str, bool]:
    """Return the page, and whether something it is held to was missed."""
    turned = sum(row["inverted"] for row in found["inverted"].values())
    right = next(row for row in found["twist"] if row["degrees"] == 90)
    kept = {
        blend: right[blend]["volume"] for blend in ("linear", "twist-joints", "dual-quaternion")
    }
    same = [row for name, row in found["brought"].items() if _is_bundled(name)]
    own = {key: max(row[key] for row in same) for key in ("worst_mm", "weights_percent")}
    glb, cost = found["glb"], found["skinning"]
    held = [
        (
            f"triangles inverted in the default pose, {len(found['inverted'])} recordings",
            turned,
            0,
            turned == 0,
        ),
        (
            "volume of a forearm twisted by 90°, dual quaternions (the default)",
            f"{100 * (kept['dual-quaternion'] - 1):+.1f} %",
            "± 10 %",
            kept["dual-quaternion"] >= TWIST_KEPT,
        ),
        (
            "the same in `motion.glb` (linear, with twist joints)",
            f"{100 * (kept['twist-joints'] - 1):+.1f} %",
            "± 10 %",
            kept["twist-joints"] >= TWIST_KEPT,
        ),
        (
            "joints of the bundled body given without limbs, in three poses",
            f"{own['worst_mm']:.1f} mm",
            f"≤ {JOINTS_MM:g} mm",
            own["worst_mm"] <= JOINTS_MM,
        ),
        (
            "its weights, mean share on a wrong limb",
            f"{own['weights_percent']:.1f} %",
            f"≤ {WEIGHTS_PERCENT:g} %",
            own["weights_percent"] <= WEIGHTS_PERCENT,
        ),
        (
            f"`motion.glb` of {glb['frames']:,} frames × {glb['limbs']} limbs",
            f"{glb['seconds']:.2f} s",
            f"≤ {GLB_SECONDS:g} s",
            glb["seconds"] <= GLB_SECONDS,
        ),
    ]
    lines = [
        "# The body on the skeleton",
        "",
        "Written by `python -m benchmarks.accuracy.mesh`; every figure is in",
        "`benchmarks/results/mesh.json`. The bundled body, attached to four recordings of `cmu41`;",
        "inverted triangles are counted on those of `plugin-gait` as well.",
        "",
        "| held to | found | wanted | |",
        "|---|---:|---:|---|",
        *(
            f"| {what} | {value} | {wanted} | {'ok' if good else '**missed**'} |"
            for what, value, wanted, good in held
        ),
        "",
        "## Twist",
        "",
        "The worst forearm of all recordings and sides, turned about its long axis at the elbow:",
        "what is lost of its volume, and what is left of its smallest cross-section. glTF viewers",
        "blend linearly; `motion.glb` has four joints along each upper arm, forearm and thigh that",
        "take 0, 1/4, 1/2 and 3/4 of the twist, and loses section as the middle columns say.",
        "",
        "| twist | linear: volume | section | linear, twist joints: volume | section "
        "| dual quaternions: volume | section |",
        "|---:|---:|---:|---:|---:|---:|---:|",
        *(_twist(row) for row in found["twist"]),
        "",
        "## A mesh that somebody brings",
        "",
        "Given as triangles alone; limbs, joints and weights found by laying the bundled body onto",
        "it. Of the bundled body itself the truth is known; the other bodies come with bones of a",
        "rig whose lumbar joint lies elsewhere than ours and is listed apart. Weights are shares",
        "on a wrong limb; triangles are those turned over when attached to `06_01`.",
        "",
        "| mesh | joints: mean | worst | lumbar | weights | turned over |",
        "|---|---:|---:|---:|---:|---:|",
        *(_brought(name, row) for name, row in found["brought"].items()),
        "",
        "## Markers",
        "",
        "How far the middle of each marker is from the skinned surface (dual quaternions), in 40",
        "frames of each recording. A marker's middle is about 10 mm above the skin, and the",
        "skeleton's own fit to the markers counts here, too. Thickness was fitted to where these",
        "markers lie on average, so this is no independent check of it. Forearms are worst: the",
        "wrist markers of this layout sit on bars that stand off the skin.",
        "",
        "| recording | samples | median | 95 % | inside | worst limb |",
        "|---|---:|---:|---:|---:|---|",
        *(_markers(name, row) for name, row in found["markers"].items()),
        "",
        "## Cost",
        "",
        f"Processor time of one thread, {cost['vertices']} vertices, a frame; "
        f"`motion.glb` with {glb['markers']} markers is {glb['megabytes']:.0f} MB.",
        "",
        "| | ms a frame | times NumPy |",
        "|---|---:|---:|",
        *(
            f"| {name} | {cost[key]:.3f} | {cost['numpy_ms'] / cost[key]:.1f} |"
            for name, key in (
                ("linear blend", "linear_ms"),
                ("dual quaternions", "dual_quaternion_ms"),
                ("linear blend as NumPy writes it", "numpy_ms"),
            )
        ),
        "",
    ]
    return "\n".join(lines), not all(good for *_, good in held)


def _twist(row: dict[str, Any]) -> str:
    cells = [
        f"{100 * (row[blend]['volume'] - 1):+.1f} % | {100 * row[blend]['section']:.0f} %"
        for blend in ("linear", "twist-joints", "dual-quaternion")
    ]
    return f"| {row['degrees']}° | {' | '.join(cells)} |"


def _markers(name: str, row: dict[str, Any]) -> str:
    worst = max(row["by_limb_mm"], key=row["by_limb_mm"].__getitem__)
    return (
        f"| {name} | {row['samples']} | {row['median_mm']:.1f} mm | {row['p95_mm']:.1f} mm "
        f"| {row['inside_percent']:.0f} % | {worst} ({row['by_limb_mm'][worst]:.0f} mm) |"
    )


def _is_bundled(name: str) -> bool:
    return name.startswith("bundled") and "another" not in name


def _brought(name: str, row: dict[str, Any]) -> str:
    return (
        f"| {name} | {row['mean_mm']:.1f} mm | {row['worst_mm']:.1f} mm ({row['worst']}) "
        f"| {row['lumbar_mm']:.0f} mm | {row['weights_percent']:.1f} % | {row['inverted']} |"
    )
