"""What halves of the unlabelled arm can tell: the same motion and noise about known centres.

The arm's own solution is made rigid: every limb where its pose puts it, hung at its joint exactly.
What its markers stray is put back on: *turned*, every marker's by a rotation or mirror of its own
that stays the same, so that it goes with the pose as skin does but leads elsewhere; or *shifted*,
taken from another time of the same half besides, so that it goes with nothing. Neither is more than
the arm's own, and what poses took up is missing.

Halves are fitted from nothing, and by maximum likelihood that begins with the true shapes, centres
and poses: where that leads away from the truth it is the data that do not tell.
"""

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from kinesphere.data import Motion, Recording, Skeleton
from kinesphere.geometry.linkage import Linkage
from kinesphere.geometry.linkage_fit import fit_linkage
from kinesphere.skeleton.sampling import spread_frames

DRAWS = 8
SPREAD, LOOKS = 0.05, 10.0
"""m, and how many looks: the truth itself is expected so loosely beside the motion."""
WANTED = 3.0
"""mm between halves, which the arm's bar asks for."""

Fit = Callable[[Recording], Motion]
Apart = Callable[[Skeleton, Skeleton], dict[str, float]]


def twin_figures(recording: Recording, solved: Motion, fit: Fit, apart: Apart) -> list[dict]:
    """Return, for both kinds of noise, what halves of twins tell of the worst joint, mm."""
    true = solved.skeleton
    columns = [recording.labels.index(m) for limb in true.limbs for m in limb.markers]
    limbs = np.repeat(np.arange(len(true.limbs)), [len(limb.markers) for limb in true.limbs])
    rigid = _rigid(solved)
    turns = solved.rotations[:, limbs]
    strays = np.einsum("nmji,nmj->nmi", turns, recording.markers[:, columns] - rigid)
    middle = recording.n_frames // 2
    rows = []
    for kind in ("turned", "shifted"):
        between, off, near, strayed = [], [], [], []
        for seed in range(DRAWS):
            rng = np.random.default_rng(seed)
            put = np.stack([_put(strays[:, m], kind, middle, rng) for m in range(len(limbs))], 1)
            markers = np.array(recording.markers)
            markers[:, columns] = rigid + np.einsum("nmij,nmj->nmi", turns, put)
            parts = (slice(middle), slice(middle, None))
            halves = [fit(replace(recording, markers=markers[part])).skeleton for part in parts]
            begun = [_begun(solved, markers[part][:, columns], part) for part in parts]
            between.append(max(apart(*halves).values()))
            off += [max(apart(true, half).values()) for half in halves]
            near.append(max(apart(*begun).values()))
            strayed += [max(apart(true, half).values()) for half in begun]
        rows.append(
            {
                "noise": kind,
                "draws": DRAWS,
                "halves_mm": float(np.median(between)),
                "error_mm": float(np.median(off)),
                "begun_halves_mm": float(np.median(near)),
                "begun_error_mm": float(np.median(strayed)),
                "begun_within": int(np.sum(np.array(near) <= WANTED)),
            }
        )
    return rows


def _begun(solved: Motion, markers: np.ndarray, part: slice) -> Skeleton:
    """Return the true skeleton with the joints that a fit begun with the truth ends with."""
    true = solved.skeleton
    names = [limb.name for limb in true.limbs]
    joints = {joint.child: joint for joint in true.joints}
    ends = [joints[n].centre_in_child if n in joints else np.zeros(3) for n in names]
    parents = [names.index(joints[n].parent) if n in joints else -1 for n in names]
    hung = [joints[n].centre_in_parent - ends[parents[names.index(n)]] for n in names[1:]]
    frames = spread_frames(markers, 600)
    truth = Linkage(
        tuple(parents),
        tuple(limb.marker_positions - end for limb, end in zip(true.limbs, ends, strict=True)),
        np.vstack([np.zeros(3), *hung]),
        solved.rotations[part][frames],
        solved.origins[part][frames, 0],
    )
    firm = np.full(len(names), 1 / SPREAD**2)
    ended = fit_linkage(truth, markers[frames], truth.centres, firm, LOOKS).linkage
    shapes = [shape + end for shape, end in zip(ended.shapes, ends, strict=True)]
    centres = {n: ended.centres[i] + ends[parents[i]] for i, n in enumerate(names) if i}
    return Skeleton(
        tuple(
            replace(limb, marker_positions=shape)
            for limb, shape in zip(true.limbs, shapes, strict=True)
        ),
        tuple(replace(joint, centre_in_parent=centres[joint.child]) for joint in true.joints),
    )


def _rigid(solved: Motion) -> np.ndarray:
    """Return the markers where rigid limbs have them that hang at their joints, limb by limb."""
    true, at = solved.skeleton, {}
    names = [limb.name for limb in true.limbs]
    placed = []
    for i, limb in enumerate(true.limbs):
        turn, at[limb.name] = solved.rotations[:, i], solved.origins[:, i]
        joint = next((j for j in true.joints if j.child == limb.name), None)
        if joint is not None:
            above = solved.rotations[:, names.index(joint.parent)]
            centre = at[joint.parent] + above @ joint.centre_in_parent
            at[limb.name] = centre - turn @ joint.centre_in_child
        placed.append(at[limb.name][:, None] + limb.marker_positions @ np.swapaxes(turn, 1, 2))
    return np.concatenate(placed, axis=1)


def _put(stray: np.ndarray, kind: str, middle: int, rng: np.random.Generator) -> np.ndarray:
    """Return one marker's strays as a twin has them, (n, 3) m."""
    halves = [stray[:middle], stray[middle:]]
    if kind == "shifted":
        halves = [np.roll(h, rng.integers(len(h) // 8, len(h) * 7 // 8), axis=0) for h in halves]
    return np.concatenate(halves) @ np.linalg.qr(rng.normal(size=(3, 3)))[0]
