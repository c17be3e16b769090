"""Which limbs are held lost: by rim and by what they cover, a hand with its forearm."""

import numpy as np
import pytest

from kinesphere.markerless.recovery import carried, held_lost
from kinesphere.markerless.settings import TrackSettings

SETTINGS = TrackSettings()
GOOD, POOR = (0.9, 2.0), (0.65, 0.6)


def lost(chain, seen):
    """Return the limbs held lost: each seen by 40 lines and 200 pixels, a hand by a quarter."""
    n = len(chain.limb_names)
    lines, pixels = np.full(n, 40.0), np.full(n, 200.0)
    support, gain = np.full(n, GOOD[0]), np.full(n, GOOD[1])
    for i, name in enumerate(chain.limb_names):
        if name.endswith("hand"):
            lines[i], pixels[i] = 10.0, 50.0
        if name in seen:
            support[i], gain[i] = seen[name]
    sums = [carried(chain, x) for x in (support * lines, lines, gain * pixels, pixels)]
    gone = held_lost(sums[0] / sums[1], sums[2] / sums[3], SETTINGS)
    return {name for name, one in zip(chain.limb_names, gone, strict=True) if one}


@pytest.mark.parametrize(
    ("seen", "gone"),
    [
        ({}, set()),
        ({"left_hand": POOR}, set()),  # a fist, a blur: where the forearm ends it is
        ({"left_hand": GOOD, "left_forearm": POOR}, {"left_hand", "left_forearm"}),
        ({"left_hand": POOR, "left_forearm": POOR}, {"left_hand", "left_forearm"}),
        ({"right_forearm": (0.65, 2.0)}, set()),  # a poor rim alone
        ({"right_forearm": (0.9, 0.6)}, set()),  # clutter of its colours
        ({"left_foot": POOR}, {"left_foot"}),
    ],
)
def test_what_is_held_lost(whole, seen, gone):
    assert lost(whole.chain, seen) == gone


def test_what_was_summed_stays(whole):
    sums = np.arange(float(len(whole.chain.limb_names)))
    before = sums.copy()
    out = carried(whole.chain, sums)
    np.testing.assert_array_equal(sums, before)
    names = whole.chain.limb_names
    hand, forearm = names.index("right_hand"), names.index("right_forearm")
    assert out[hand] == sums[hand] + sums[forearm]
    rest = [i for i, name in enumerate(names) if not name.endswith("hand")]
    np.testing.assert_array_equal(out[rest], sums[rest])
