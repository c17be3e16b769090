"""Markers near joints that nearness put on the wrong side."""

from collections.abc import Sequence

import numpy as np

from kinesphere.data import Array
from kinesphere.skeleton.discovery.joint_costs import Members
from kinesphere.skeleton.discovery.rigidity import Rigidity
from kinesphere.skeleton.discovery.steadiness import OWN_POSE, steadiness, usual_wander

SIGNIFICANT = 3.0
"""Standard errors by which two deviations must differ to count as different."""


def to_the_steadiest(rigidity: Rigidity, bodies: Sequence[Members]) -> list[Members]:
    """Let markers near a joint go where they are steadiest, among bodies rigid to the noise.

    Where nothing but noise moves a body's markers against each other, noise tells which of two
    bodies a marker rides on, though nearness did not: it is as steady there as the body's own
    markers are, and not at home. Where skin moves them that says nothing: nothing is moved unless
    distances within bodies are, by and large, as steady as the recording's steadiest ones, and a
    body counts only if it is. Noise on top of skin makes single bodies look rigid to it.
    """
    wander, kept = rigidity.wander, [members.copy() for members in bodies]
    same = 1 + SIGNIFICANT / np.sqrt(2 * len(rigidity.points))
    if usual_wander(wander, kept) >= same * rigidity.noise:
        return kept
    for _ in range(len(kept)):
        steady = steadiness(wander, kept)
        inner = np.array([_rms(steady[members, b]) for b, members in enumerate(kept)])
        moves = [
            (steady[m, target] / steady[m, home], int(m), home, target)
            for home, members in enumerate(kept)
            if len(members) > OWN_POSE
            for m in members
            for target in range(len(kept))
            if target != home
            and len(kept[target]) >= OWN_POSE
            and inner[target] < same * rigidity.noise
            and steady[m, target] < same * inner[target]
            and steady[m, target] * same < steady[m, home]
        ]
        if not moves:
            break
        _, m, home, target = min(moves)
        kept[home] = kept[home][kept[home] != m]
        kept[target] = np.sort(np.append(kept[target], m))
    return kept


def _rms(values: Array) -> float:
    known = values[np.isfinite(values)]
    return float(np.sqrt(np.mean(known**2))) if len(known) else np.inf
