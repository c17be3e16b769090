"""AMC, Acclaim's motion: per frame the freedoms of each bone of the ASF file beside it."""

from pathlib import Path

import numpy as np

from kinesphere.data import Array, Motion, Step
from kinesphere.errors import UnreadableFile
from kinesphere.io.asf_text import ROOT, Asf, parse_asf, rotation_in_order
from kinesphere.io.bvh import BVH_FROM_BODY
from kinesphere.io.rig_motion import motion_of_bones
from kinesphere.io.text import read_text

RATE = 120.0
"""Hz; the format has no place for it, and this is what CMU recorded with."""


def read_amc(
    path: str | Path, skeleton: str | Path | None = None, rate: float | None = None
) -> Motion:
    """Read a motion and the skeleton it belongs to.

    Parameters
    ----------
    skeleton
        The ASF file; None for the one beside it: of the same name (``01_01.asf``), of its
        subject's (``01.asf``), or the only one there.
    rate
        Hz; None for 120, aloud.

    Raises
    ------
    UnreadableFile
        If there is no skeleton, or naming the line, what was found and what would be right.
    """
    path = Path(path)
    asf_path = _beside(path) if skeleton is None else Path(skeleton)
    asf = parse_asf(asf_path)
    radians, values, warnings = _frames(path, asf)
    rotations, places, ignored = _poses(asf, values, radians)
    warnings += ignored
    if rate is None:
        rate = RATE
        warnings.append(f"AMC names no frame rate; {RATE:g} Hz is taken")
    return motion_of_bones(
        asf.as_bones(),
        rotations,
        places,
        asf.metres,
        rate,
        BVH_FROM_BODY,
        Step(
            "read",
            {"format": "amc", "file": path.name, "skeleton": asf_path.name},
            {"n_frames": len(rotations), "n_joints": len(asf.bones), "rate_hz": rate},
            (*asf.warnings, *warnings),
        ),
    )


def _beside(path: Path) -> Path:
    stem = path.stem
    for name in (stem, stem.rpartition("_")[0]):
        for suffix in (".asf", ".ASF"):
            if name and (found := path.with_name(name + suffix)).is_file():
                return found
    there = sorted(p for p in path.parent.glob("*") if p.suffix.lower() == ".asf")
    if len(there) == 1:
        return there[0]
    raise UnreadableFile(
        f"{path}: {len(there)} skeletons beside it; an ASF file called {stem}.asf was expected"
    )


def _frames(path: Path, asf: Asf) -> tuple[bool, list[Array], list[str]]:
    """Return whether angles are radians, bone → (n_frames, n_freedoms), and warnings."""
    radians = asf.radians
    at = {bone.name: i for i, bone in enumerate(asf.bones)}
    frames: list[list[list[float] | None]] = []
    unknown: set[str] = set()
    for number, line in enumerate(read_text(path).split("\n"), start=1):
        words = line.split("#", 1)[0].split()
        if not words:
            continue
        first, *numbers = words
        where = f"{path}: line {number}"
        if first.startswith(":"):
            if first.lower() in (":degrees", ":radians"):
                radians = first.lower() == ":radians"
        elif not numbers and first.isdecimal():
            frames.append([None] * len(asf.bones))
        elif not frames:
            raise UnreadableFile(f"{where} holds {line.strip()!r:.40} before any frame number")
        elif (i := at.get(first)) is None:
            unknown.add(first)
        else:
            wanted = len(asf.bones[i].freedoms)
            if len(numbers) != wanted:
                raise UnreadableFile(
                    f"{where}: {first} has {len(numbers)} numbers, its freedoms are {wanted}"
                )
            try:
                row = list(map(float, numbers))
            except ValueError:
                raise UnreadableFile(f"{where} holds {line.strip()!r:.40}, no numbers") from None
            if np.isinf(row).any():
                raise UnreadableFile(f"{where} holds an infinite number")
            frames[-1][i] = row
    if not frames:
        raise UnreadableFile(f"{path}: there is no frame")
    if unknown and unknown >= set(at):
        raise UnreadableFile(f"{path}: none of its bones is one of the skeleton's")
    warnings = []
    if unknown:
        warnings.append(f"the skeleton has no bone {', '.join(sorted(unknown)[:5])}: left out")
    values = []
    for i, bone in enumerate(asf.bones):
        gap = [np.nan] * len(bone.freedoms)
        rows = [frame[i] for frame in frames]
        lacking = sum(row is None for row in rows)
        if lacking and bone.freedoms:
            warnings.append(f"{bone.name} is missing in {lacking} frames")
        table = np.array([gap if row is None else row for row in rows], dtype=np.float64)
        values.append(table.reshape(len(frames), len(bone.freedoms)))
    return radians, values, warnings


def _poses(asf: Asf, values: list[Array], radians: bool) -> tuple[Array, Array, list[str]]:
    """Return rotations (n, n_bones, 3, 3) and where bones hang, (n, n_bones, 3), file's axes."""
    n = len(values[0])
    rotations = np.empty((n, len(asf.bones), 3, 3))
    places = np.empty((n, len(asf.bones), 3))
    ignored: set[str] = set()
    for i, (bone, parent) in enumerate(zip(asf.bones, asf.parents, strict=True)):
        column = {freedom: values[i][:, k] for k, freedom in enumerate(bone.freedoms)}
        turning = [freedom for freedom in bone.freedoms if freedom.startswith("r")]
        angles = np.stack([column[f] for f in turning], axis=1) if turning else np.empty((n, 0))
        angles = angles if radians else np.radians(angles)
        axes = np.eye(3) if bone.axes is None else bone.axes
        turned = rotation_in_order(angles, "".join(f[1] for f in turning))
        turned = axes @ turned @ axes.T
        if bone.name == ROOT:
            rotations[:, i] = turned
            for k, freedom in enumerate(("tx", "ty", "tz")):
                places[:, i, k] = column.get(freedom, np.zeros(n)) + asf.position[k]
            continue
        ignored |= {f"{bone.name} {f}" for f in bone.freedoms if not f.startswith("r")}
        above = asf.bones[parent]
        rotations[:, i] = rotations[:, parent] @ turned
        places[:, i] = places[:, parent] + rotations[:, parent] @ (above.direction * above.length)
    said = f"freedoms that do not turn are left out: {', '.join(sorted(ignored)[:5])}"
    return rotations, places, [said] if ignored else []
