"""One marker under two numbers: trajectories that are there twice, and pieces that overlap."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray
from scipy.cluster.hierarchy import fcluster, linkage
from scipy.spatial.distance import squareform

from kinesphere.data import Array, TopologicalModel
from kinesphere.geometry.even_frames import even_frames
from kinesphere.skeleton.averages import median_seen

BESIDE = 0.003
"""m, at a person's size: two that are usually no farther apart are one marker. Those worn on people
are 6 mm thick and more; of the recordings at hand no two are nearer than 7 mm."""
FRAMES = 100
"""Frames that are looked at, spread over the recording."""
LISTED = 8
"""Pieces that are named in the warning; the findings hold all."""
TOGETHER = 0.9
"""Least share of the frames of the one seen less that show both. One marker in two pieces that
overlap for some frames is no copy: either piece shows what the other does not."""


def find_copies(markers: Array, order: NDArray[np.intp]) -> tuple[dict[int, int], dict[int, int]]:
    """Return which trajectories are copies, and which are pieces, and of which other one.

    A copy is seen hardly anywhere but where the other one is. A piece meets the other one where
    both are seen, and shows the marker elsewhere too. Of each group the one that is seen most often
    is kept, of several the first in the file.

    Parameters
    ----------
    markers : (n_frames, n, 3) m
        At a person's size; NaN where not seen.
    order : (n,)
        Their places in the file.

    Returns
    -------
    Column of a copy → column that is kept, which may be a piece; column of a piece → column that it
    continues.
    """
    few = markers[even_frames(len(markers), FRAMES)]
    n = few.shape[1]
    apart = np.full((n, n), np.inf)
    for i in range(n):
        usual = median_seen(np.linalg.norm(few - few[:, i : i + 1], axis=2))
        apart[i] = np.nan_to_num(usual, nan=np.inf)
    if n < 2 or (apart + np.diag(np.full(n, np.inf)) > BESIDE).all():
        return {}, {}
    far = np.where(np.isfinite(apart), apart, 1e3)
    np.fill_diagonal(far, 0.0)
    group = fcluster(linkage(squareform(far, checks=False), "complete"), BESIDE, "distance")
    seen = np.asarray(np.isfinite(markers).all(axis=2), dtype=np.float64)
    together = seen.T @ seen  # numbers of frames: exact
    often = np.diag(together)
    copies: dict[int, int] = {}
    pieces: dict[int, int] = {}
    for g in np.unique(group):
        members = (int(m) for m in np.flatnonzero(group == g))
        first, *others = sorted(members, key=lambda m: (-often[m], order[m]))
        kept = [first]
        for m in others:
            of = next((k for k in kept if together[m, k] >= TOGETHER * often[m]), None)
            if of is not None:
                copies[m] = of
            else:
                pieces[m] = first
                kept.append(m)
    return dict(sorted(copies.items())), dict(sorted(pieces.items()))


def with_pieces_joined(markers: Array, pieces: dict[int, int]) -> Array:
    """Return the trajectories; those that pieces continue show what the pieces do.

    Parameters
    ----------
    markers : (n_frames, n, 3) m
        NaN where not seen.
    pieces
        As `find_copies` returns them; they stay as they are.
    """
    joined = markers.copy()
    for piece, whole in pieces.items():
        joined[:, whole] = np.where(np.isnan(joined[:, whole]), markers[:, piece], joined[:, whole])
    return joined


def with_more(
    model: TopologicalModel, limb_of: dict[str, str], in_file: Sequence[str]
) -> TopologicalModel:
    """Return the model with more markers on its limbs, label → limb; others stay away."""
    segments = []
    for segment in model.segments:
        more = [label for label, limb in limb_of.items() if limb == segment.name]
        markers = tuple(sorted((*segment.markers, *more), key=in_file.index))
        segments.append(replace(segment, markers=markers))
    required = tuple(label for segment in segments for label in segment.markers)
    return replace(model, segments=tuple(segments), required=required)


def with_pieces(
    model: TopologicalModel, whole_of: dict[str, str], in_file: Sequence[str]
) -> TopologicalModel:
    """Return the model with every piece on the limb of the marker that it continues.

    Parameters
    ----------
    model
        Of the kept trajectories.
    whole_of
        Label of a piece → label of what it continues.
    in_file
        All labels in their order.
    """
    limb_of = {label: segment.name for segment in model.segments for label in segment.markers}
    more = {piece: limb_of[whole] for piece, whole in whole_of.items() if whole in limb_of}
    return with_more(model, more, in_file)


def told_of_copies(alike: dict[str, str]) -> tuple[str, ...]:
    """Return what a person should be warned of."""
    if not alike:
        return ()
    pairs = ", ".join(f"{copy} (as {kept})" for copy, kept in alike.items())
    return (f"trajectories that are there twice are left out but for one: {pairs}",)


def told_of_pieces(whole_of: dict[str, str]) -> tuple[str, ...]:
    """Return what a person should be warned of."""
    if not whole_of:
        return ()
    pairs = [f"{piece} ({whole})" for piece, whole in whole_of.items()]
    listed = ", ".join(pairs if len(pairs) <= LISTED else [*pairs[:LISTED], "…"])
    return (f"{len(pairs)} trajectories are taken for pieces of others: {listed}",)
