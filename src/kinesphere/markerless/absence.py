"""Whether anybody is there at all."""

import numpy as np

from kinesphere.data import Array, Mask

_SEEN = 0.25
"""Share of the limbs that must be in some camera's view."""
_LOST = 0.6
"""Nobody is there if as many of the limbs in view are lost, the root among them: all of them when
a person has left rendered scenes, none while there, up to a third in clutter."""


def nobody_seen(support: Array, gain: Array, lost: Mask) -> bool:
    """Return whether a pose has no person behind it: out of view, or nothing there speaks for it.

    Parameters
    ----------
    support, gain, lost : (n_limbs,)
        As in `Found`; the root comes first.
    """
    known = np.isfinite(support) | np.isfinite(gain)
    if known.mean() < _SEEN:
        return True
    return bool(lost[0] and lost[known].mean() >= _LOST)
