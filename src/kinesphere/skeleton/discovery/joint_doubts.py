"""Which joints a person is told may be wrong."""

from collections.abc import Sequence

import numpy as np

from kinesphere.skeleton.discovery.forest import Edge

TOLD = {0.6: 0.1, 0.0: 0.3}
TOLD_UNNAMED = 0.45
"""Confidence of an edge below which it is said that the joint may be wrong: by the least confidence
of the limbs' names, and where none are given. Of joints in parts of recordings one of 97 is wrong
below .3 where a person is seen; elsewhere a fifth below .3, one in eleven from there to .45."""


def is_told(edge: Edge, named: float) -> bool:
    """Return whether a person should be told that a joint may be wrong.

    Parameters
    ----------
    edge
    named
        Confidence of the limbs' names, NaN where there are none: a person's are joined as a
        person's limbs are.
    """
    return edge.below(next((t for least, t in TOLD.items() if named > least), TOLD_UNNAMED))


def doubts_of_joints(edges: Sequence[tuple[str, Edge]], named: float) -> list[str]:
    """Return what is said of doubtful joints: of those with a rival, and of those without.

    Parameters
    ----------
    edges
        Joint → its two bodies.
    named
        Confidence of the names, NaN where there are none.
    """
    shaky = [(name, edge) for name, edge in edges if is_told(edge, named)]
    rivalled = [f"{name} ({e.confidence:.2f})" for name, e in shaky if np.isfinite(e.next_best)]
    alone = [name for name, edge in shaky if not np.isfinite(edge.next_best)]
    told = []
    if rivalled:
        told.append(
            "another tree of bodies is nearly as likely, and joints may be wrong, at "
            f"{', '.join(rivalled)}"
        )
    if alone:
        told.append(
            f"these bodies hardly fit a joint between them, yet no others are left for one: "
            f"{', '.join(alone)} may be wrong"
        )
    return told
