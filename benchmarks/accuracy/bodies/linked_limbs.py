"""Limbs of two markers between others: limb by limb, and fitted together with those beside them."""

from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from benchmarks.accuracy.bodies.apart import apart, told
from benchmarks.accuracy.bodies.cases import folder
from benchmarks.accuracy.bodies.linked_chains import KINDS, Kind, chain, errors, model
from kinesphere import read
from kinesphere.data import Skeleton
from kinesphere.skeleton import discover, fit_skeleton
from kinesphere.skeleton.settings import SkeletonSettings

CHAINS = 4
"""Of each kind."""
RECORDINGS = (
    "rigid-bodies/arm-4-2-3",
    "plugin-gait/pycgm_movement",
    "plates/KneeltoProne01",
    "cmu41/02_05",
    "cmu41/06_01",
    "cmu41/135_02",
    "cmu41/85_02",
    "functional/Test_func_trunk",
)
"""Those with a limb of two markers between two others, or nearly so."""
WAYS = (SkeletonSettings(link_limbs=False), SkeletonSettings())


def linked_figures() -> dict[str, Any]:
    """Return errors on chains whose joints are known, and how real halves agree, both ways, mm."""
    return {
        "chains": [_chains(kind) for kind in KINDS],
        "real": [row for name in RECORDINGS for row in _real(name)],
    }


def _chains(kind: Kind) -> dict[str, Any]:
    off: list[list[list[float]]] = [[], []]
    for seed in range(CHAINS):
        recording, joints = chain(kind, seed)
        for way, settings in zip(off, WAYS, strict=True):
            way.append(errors(fit_skeleton(recording, model(kind.last), settings), joints))
    alone, together = (np.sqrt(np.mean(np.square(way), axis=0)) for way in off)
    return {
        "kind": kind.name,
        "chains": CHAINS,
        "alone_mm": [float(one) for one in alone],
        "together_mm": [float(one) for one in together],
    }


def _real(name: str) -> list[dict[str, Any]]:
    """Return the joints of a recording that linking changes; bodies are those of all of it."""
    recording = read(folder() / f"{name}.c3d")
    found = discover(recording).model
    middle = recording.n_frames // 2
    rows: list[list[Skeleton]] = []
    for settings in WAYS:
        rows.append([])
        for part in (slice(middle), slice(middle, None)):
            half = replace(
                recording,
                markers=np.array(recording.markers[part]),
                outputs=(),
                residuals=None,
                analog=None,
                details={},
            )
            rows[-1].append(fit_skeleton(half, found, settings).skeleton)
    alone, together = (apart(*row) for row in rows)
    told_alone, told_together = (told(*row) for row in rows)
    return [
        {
            "recording": name,
            "joint": joint,
            "alone_mm": alone[joint],
            "together_mm": together[joint],
            "told_alone_mm": told_alone[joint],
            "told_together_mm": told_together[joint],
        }
        for joint in alone
        if abs(alone[joint] - together[joint]) > 1e-3
    ]


def linked_section(found: dict[str, Any]) -> str:
    """Return the section of the page."""
    lines = [
        "## Limbs of two markers\n",
        "A limb of two markers between two others is fitted together with them "
        "(`skeleton.link_limbs`). Chains of 4, 2 and 4 or 3 markers whose joints are known, 1 mm "
        f"of noise, 29 and 34° about each axis; rms errors of {found['chains'][0]['chains']} "
        "chains each, in the limb of more markers.\n",
        "| chain | first joint, limb by limb | together | second joint, limb by limb | together |",
        "|---|---:|---:|---:|---:|",
    ]
    for row in found["chains"]:
        (first, second), (one, other) = row["alone_mm"], row["together_mm"]
        lines.append(
            f"| {row['kind']} | {first:.1f} mm | {one:.1f} mm | {second:.1f} mm | {other:.1f} mm |"
        )
    real = found["real"]
    lines += [
        "\nReal recordings, bodies from motion alone, halves of the time: how far they have joints "
        "apart that linking changes, and what is told.\n",
        "| recording | joint | limb by limb | together | told, limb by limb | together |",
        "|---|---|---:|---:|---:|---:|",
    ]
    lines += [
        f"| {row['recording']} | {row['joint'].replace('_', ' ')} | {row['alone_mm']:.1f} mm "
        f"| {row['together_mm']:.1f} mm | {row['told_alone_mm']:.1f} mm "
        f"| {row['told_together_mm']:.1f} mm |"
        for row in real
    ]
    if real:
        lines.append(f"\n{_summed(real)}")
    return "\n".join(lines) + "\n"


def _summed(real: Sequence[dict[str, Any]]) -> str:
    alone, together, told_alone, told_together = (
        np.array([row[key] for row in real])
        for key in ("alone_mm", "together_mm", "told_alone_mm", "told_together_mm")
    )
    return (
        f"{len(real)} joints: {np.mean(alone):.1f} mm on average limb by limb, "
        f"{np.mean(together):.1f} mm together, {int(np.sum(together < alone))} of them nearer; "
        f"what is told is exceeded {_times(alone, told_alone):.1f} and "
        f"{_times(together, told_together):.1f} times (rms)."
    )


def _times(found: np.ndarray, told_of_it: np.ndarray) -> float:
    return float(np.sqrt(np.mean((found / told_of_it) ** 2)))
