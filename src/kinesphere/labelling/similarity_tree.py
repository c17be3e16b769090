"""Baseline: the similarity k-d tree on a whole frame, every frame by itself.

B. Li, Q. Meng, H. Holstein (2005), Pattern Recognition 38(12), 2391-2399, as Huang & Xia describe
it: fast, and right only where the pose is the model's.
"""

import numpy as np
from numpy.typing import NDArray

from kinesphere.data import Array, TopologicalModel
from kinesphere.geometry.signature import evenly_spread
from kinesphere.labelling.local_tree import aligned, match_leaves, shape_from_distances
from kinesphere.labelling.matching import Match, nothing
from kinesphere.labelling.template import template_of

FRAMES = 200
"""Most frames that vote."""


def label_frame(frame: Array, pose: Array, up: Array) -> NDArray[np.intp]:
    """Return for each point of a model's pose the point of the frame that matches it, (m,).

    Parameters
    ----------
    frame, pose : (m, 3)
        As many points of one as of the other.
    up : (3,)
        The vertical, about which the frame is turned; both stand along it.
    """
    centred = pose - pose.mean(axis=0)
    return match_leaves(centred, aligned(frame, pose, up))


def match_similarity_tree(points: Array, model: TopologicalModel) -> Match:
    """Label points by the vote of single frames; the vertical is the longest extent.

    A model holds distances, no pose: theirs is what classical scaling makes of the means. It
    labels only where as many points are seen as the model has labels.
    """
    template = template_of(model)
    n_points, n = points.shape[1], template.n
    full = np.flatnonzero(np.isfinite(points).all(axis=(1, 2)))
    if n_points != n or not len(full):
        return nothing(
            n_points,
            f"the similarity tree needs a frame with exactly the {n} markers of {model.name}; "
            f"there are {n_points} points, all of them in {len(full)} frames",
        )
    handed = np.column_stack([template.quadruples, template.handedness])
    pose = shape_from_distances(template.mean, handed)  # its first axis is its longest
    votes = np.zeros((n_points, n))
    for t in full[evenly_spread(len(full), FRAMES)]:
        frame = points[t] - points[t].mean(axis=0)
        _, _, axes = np.linalg.svd(frame, full_matrices=False)
        axes[2] = np.cross(axes[0], axes[1])
        tries = [frame @ (axes * np.array([[s], [1.0], [s]])).T for s in (1.0, -1.0)]
        found = [label_frame(one, pose, np.array([1.0, 0.0, 0.0])) for one in tries]
        off = [_misfit(one[order], template.mean) for one, order in zip(tries, found, strict=True)]
        votes[found[int(np.argmin(off))], np.arange(n)] += 1
    return from_votes(votes, model, template.labels)


def from_votes(votes: Array, model: TopologicalModel, labels: tuple[str, ...]) -> Match:
    """Return the labels that most frames gave each point, each label once."""
    into = {name: i for i, name in enumerate(model.labels)}
    given = np.full(len(votes), -1, dtype=np.int64)
    share = votes / np.maximum(votes.sum(axis=1, keepdims=True), 1)
    sure = np.zeros(len(votes))
    left = share.copy()
    while left.size and left.max() > 0:
        k, i = np.unravel_index(int(left.argmax()), left.shape)
        given[k], sure[k] = into[labels[i]], share[k, i]
        left[k, :], left[:, i] = 0, 0
    return Match(given, sure, np.nan)


def _misfit(ordered: Array, mean: Array) -> float:
    distance = np.linalg.norm(ordered[:, None] - ordered, axis=2)
    scale = np.nanmedian(distance[mean > 0] / mean[mean > 0])
    return float(np.nanmean(np.abs(distance / scale - mean)))
