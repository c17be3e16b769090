"""Whatever a file holds: no crash, findings as JSON, positions permuted and nothing else."""

import json

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from kinesphere.data import Recording
from kinesphere.quality import check_recording, orient

LABELS = (
    "LTOE",
    "RTOE",
    "LHEE",
    "LFHD",
    "C7",
    "A:LTOE",
    "A:C7",
    "*0",
    "A:*3",
    "",
    "L",
    "LASI",
    "RASI",
)


@st.composite
def recordings(draw):
    """Few frames, few markers, many gaps, zeros, ties and extremes; no NaN-free promise."""
    n_frames, n_markers = draw(st.integers(0, 5)), draw(st.integers(0, 7))
    rng = np.random.default_rng(draw(st.integers(0, 2**32 - 1)))
    values = rng.choice([0.0, 1.0, -1.0, 0.5, 1e6, 1e-9], size=(n_frames, n_markers, 3))
    values[rng.random(values.shape) < draw(st.sampled_from([0.0, 0.3, 0.9]))] = np.nan
    labels = tuple(str(label) for label in rng.permutation(LABELS)[:n_markers])
    up = draw(st.sampled_from([None, "+z", "-y"]))
    return Recording(values, labels, rate=draw(st.sampled_from([1.0, 12.0, 300.0])), up=up)


@given(recordings())
@settings(deadline=None, max_examples=80)
def test_nothing_breaks(recording):
    json.dumps([finding.as_json() for finding in check_recording(recording)], allow_nan=False)
    world = orient(recording)
    json.dumps(world.history[-1].findings, allow_nan=False)
    matrix = world.world_from_file
    np.testing.assert_array_equal(np.abs(matrix).sum(axis=0), 1)
    np.testing.assert_array_equal(np.abs(matrix).sum(axis=1), 1)
    there, back = np.sort(np.abs(recording.markers), axis=2), np.sort(np.abs(world.markers), axis=2)
    np.testing.assert_array_equal(there, back)
