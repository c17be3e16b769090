"""Frames spread evenly: the same from either end, as many as asked for, ends included."""

import numpy as np
from hypothesis import example, given
from hypothesis import strategies as st
from numpy.testing import assert_array_equal

from kinesphere.geometry.even_frames import even_frames, every_nth, parted

FEW = st.integers(0, 400)


@given(n_frames=FEW, count=st.integers(1, 500))
@example(n_frames=10, count=1)
@example(n_frames=323, count=27)
def test_the_same_frames_from_either_end(n_frames, count):
    found = even_frames(n_frames, count)
    assert_array_equal(n_frames - 1 - found[::-1], found)
    wanted = min(n_frames, count)
    assert len(found) - wanted in ((0, 1) if n_frames % 2 == 0 else (0,))
    if len(found) > 1:
        assert (found[0], found[-1]) == (0, n_frames - 1)
        # a distance rounded up here and down there, once more at the middle
        assert np.diff(found).min() > 0
        assert np.ptp(np.diff(found)) <= 2


@given(n_frames=FEW, stride=st.integers(0, 50))
def test_every_nth_is_about_so_far_apart(n_frames, stride):
    found = every_nth(n_frames, stride)
    assert_array_equal(n_frames - 1 - found[::-1], found)
    if n_frames > 3 * stride > 0:
        assert np.diff(found).mean() == np.float64(n_frames - 1) / (len(found) - 1)
        assert abs(np.diff(found).mean() - stride) <= stride / 3 + 1


@given(n=FEW)
def test_halves_are_alike_and_leave_out_the_middle_one_of_an_odd_number(n):
    before, after = parted(n)
    assert before == n - after
    assert after - before == n % 2
