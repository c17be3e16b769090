"""Where every limb of a rig points, given where the limbs of another skeleton do."""

from collections.abc import Sequence

import numpy as np

from kinesphere.data import Array, Skeleton
from kinesphere.data.figure import SIDES
from kinesphere.data.tree import way_to_root
from kinesphere.editing.retarget_rest import RestPose
from kinesphere.geometry.rotations import rotation_exp, rotation_log


def limb_turns(
    rotations: Array,
    source: RestPose,
    source_names: Sequence[str],
    target: RestPose,
    skeleton: Skeleton,
    corrections: dict[str, Array],
) -> Array:
    """Return ``world_from_limb`` of every limb of the target, (n_frames, n_limbs, 3, 3).

    Arms, legs and the head turn as the source's. Spine, neck and collar bones share among them
    what the source's do between their ends, however many there are. A limb that neither skeleton
    has a part for keeps its place on its parent, unless the source has one of its name.

    Parameters
    ----------
    rotations : (n_frames, n_source_limbs, 3, 3)
        ``world_from_limb`` without gaps.
    corrections
        Part → the turn between the rest poses, body axes.
    """
    n = len(rotations)
    from_rest = rotations @ source.rest_from_body  # world from the source's limbs in body axes
    into_rest = target.rest_from_body.T
    told: dict[int, tuple[Array, Array]] = {}  # limb of the target → turn of the source, correction
    still = np.eye(3)
    ours, theirs = source.figure, target.figure
    if theirs.spine or not ours.spine:
        told[theirs.pelvis] = (from_rest[:, ours.pelvis], still)
    else:  # one limb for pelvis and trunk goes half way between the two
        told[theirs.pelvis] = (_shared(from_rest, (ours.pelvis, ours.chest), [0.5])[0], still)
    _share(told, from_rest, (ours.pelvis, *ours.spine), theirs.spine)
    for name, limb in theirs.parts.items():
        if name in ours.parts:
            told[limb] = (from_rest[:, ours.parts[name]], corrections.get(name, still))
    if "head" in theirs.parts and theirs.neck:
        top = ours.parts.get("head", ours.chest)
        chain = (ours.chest, *ours.neck, top)
        shares = [k / (len(theirs.neck) + 1) for k in range(1, len(theirs.neck) + 1)]
        for limb, turn in zip(theirs.neck, _shared(from_rest, chain, shares), strict=True):
            told[limb] = (turn, still)
    for side in SIDES:
        _share(
            told,
            from_rest,
            (ours.chest, *ours.clavicles.get(side, ())),
            theirs.clavicles.get(side, ()),
        )
    turns = np.empty((n, len(skeleton.limbs), 3, 3))
    applied = [still] * len(skeleton.limbs)
    above = set(way_to_root(skeleton.parents, theirs.pelvis)[1:])
    by_name = {name: i for i, name in enumerate(source_names)}
    used = {*ours.parts.values(), ours.pelvis, *ours.spine, *ours.neck}
    for i, name in enumerate(skeleton.limb_names):
        parent = int(skeleton.parents[i])
        if i in told:
            turn, applied[i] = told[i]
            turns[:, i] = turn @ (applied[i] @ into_rest)
        elif (j := by_name.get(name)) is not None and j not in used:
            applied[i] = applied[parent] if parent >= 0 else still
            turns[:, i] = from_rest[:, j] @ (applied[i] @ into_rest)
        elif i in above or parent < 0:
            turns[:, i] = into_rest
        else:
            applied[i] = applied[parent]
            turns[:, i] = turns[:, parent]
    return turns


def _share(
    told: dict[int, tuple[Array, Array]],
    from_rest: Array,
    chain: tuple[int, ...],
    limbs: tuple[int, ...],
) -> None:
    shares = [k / len(limbs) for k in range(1, len(limbs) + 1)]
    for limb, turn in zip(limbs, _shared(from_rest, chain, shares), strict=True):
        told[limb] = (turn, np.eye(3))


def _shared(from_rest: Array, chain: tuple[int, ...], shares: Sequence[float]) -> list[Array]:
    """Return the turns at shares of the way along a chain of limbs, each (n_frames, 3, 3)."""
    found = []
    for share in shares:
        at = share * (len(chain) - 1)
        k = min(int(np.floor(at + 1e-9)), len(chain) - 1)
        first = from_rest[:, chain[k]]
        part = at - k
        if part < 1e-6:
            found.append(first)
            continue
        between = np.swapaxes(first, -1, -2) @ from_rest[:, chain[k + 1]]
        found.append(first @ rotation_exp(part * rotation_log(between)))
    return found
