"""Nobody there: told from a person with lost limbs, and from one seen in part."""

import numpy as np
import pytest

from kinesphere.markerless.absence import nobody_seen

LIMBS = 15


def judged(lost=(), unseen=()):
    support, gain = np.full(LIMBS, 0.9), np.full(LIMBS, 2.0)
    gone = np.zeros(LIMBS, dtype=bool)
    gone[list(lost)] = True
    support[list(unseen)] = gain[list(unseen)] = np.nan
    return support, gain, gone


@pytest.mark.parametrize(
    ("lost", "unseen", "nobody"),
    [
        ((), (), False),
        (range(15), (), True),
        (range(1, 15), (), False),  # the root is found: somebody is there
        (range(6), (), False),  # both arms and the root: bad, but not nobody
        ((0, 1, 2), range(3, 12), False),
        ((0, 1, 2, 3), range(5, 15), True),
        ((), range(2, 15), True),  # out of every camera's view
        ((), range(15), True),
        ((), range(8, 15), False),  # legs below the image
    ],
)
def test_who_is_there(lost, unseen, nobody):
    assert nobody_seen(*judged(lost, unseen)) is nobody
