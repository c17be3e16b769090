"""Trees hang from a body whose markers tell where it points."""

from dataclasses import replace

import numpy as np
import pytest

from kinesphere.data import Recording
from kinesphere.errors import DegenerateMotion
from kinesphere.skeleton import discover, fit_skeleton


def with_trunk_at(actor, recorded, owner, places, rng):
    """Return the recording with the trunk's markers at other places of it, m."""
    trunk = actor.skeleton.limb_names.index("trunk")
    turns, origins = actor.motion.rotations[:, trunk], actor.motion.origins[:, trunk]
    markers = recorded.markers.copy()
    columns = [c for c, limb in enumerate(owner) if limb == "trunk"]
    for column, place in zip(columns, places, strict=False):
        markers[:, column] = origins + turns @ np.array(place)
    noise = rng.normal(scale=0.001, size=markers.shape)
    return replace(recorded, markers=markers + noise)


def on_a_line(beside=0.0):
    return [[0.0, 0.08 * k, beside * (-1) ** k] for k in range(1, 6)]


def test_a_trunk_whose_markers_are_on_a_line_is_named_and_hangs_from_another_limb(
    actor, recorded, owner, limbs_of, rng
):
    recording = with_trunk_at(actor, recorded, owner, on_a_line(), rng)
    found = discover(recording)
    assert all(own == {name} for name, own in limbs_of(found, owner).items())
    assert found.model.root != "trunk"
    motion = fit_skeleton(recording, found.model)
    assert motion.skeleton.limbs[0].name == found.model.root
    assert np.isfinite(motion.rotations[:, 0]).all()


def test_a_trunk_whose_markers_are_in_a_plane_is_the_root(actor, recorded, owner, rng):
    recording = with_trunk_at(actor, recorded, owner, on_a_line(0.04), rng)
    found = discover(recording)
    assert found.model.root == "trunk"
    assert np.isfinite(fit_skeleton(recording, found.model).rotations[:, 0]).all()


def test_what_is_a_line_goes_by_the_size_of_the_tree_not_of_all_who_are_there(recorded):
    """Two figures of a hand's size, two metres apart: the recording is as large as a person."""
    small = 0.1 * recorded.markers
    other = small[::-1] + np.array([2.0, 0.0, 0.0])
    both = replace(
        recorded,
        markers=np.concatenate([small, other], axis=1),
        labels=tuple(f"*{i}" for i in range(2 * recorded.n_markers)),
    )
    found = discover(both)
    assert found.model.root in {segment.name for segment in found.model.segments}
    assert len(found.model.segments) > 8


def test_motion_in_a_plane_is_solved(recorded):
    """What a single camera sees: limbs foreshortened, most of them off a line all the same."""
    flat = replace(recorded, markers=recorded.markers * [1.0, 1.0, 0.0])
    found = discover(flat)
    fit_skeleton(flat, found.model)
    assert len(found.model.segments) > 1


def test_where_every_body_is_a_line_that_is_said(rng, moving_bodies):
    points, of = moving_bodies(rng, (3, 3), noise=1e-4)
    for body in (0, 1):
        first, _, last = np.flatnonzero(of == body)
        points[:, first + 1] = (points[:, first] + points[:, last]) / 2
    labels = tuple(f"*{i}" for i in range(6))
    recording = Recording(markers=points, labels=labels, rate=50.0)
    with pytest.raises(DegenerateMotion, match=r"three markers off a line .*\*0"):
        discover(recording)
