"""The generator takes nothing for granted that only people have."""

import numpy as np
import pytest
from numpy.testing import assert_allclose

from kinesphere.data import motion_from_parameters
from kinesphere.errors import BadSetting
from kinesphere.synthetic import HAND, QUADRUPED, make_performance

EXACT = 1e-12  # m; a dozen multiplications of numbers near 1


@pytest.mark.parametrize("plan", [QUADRUPED, HAND], ids=lambda plan: plan.name)
def test_a_creature_performs(rng, plan):
    performance = make_performance(
        rng, plan=plan, rate=20, calibration_s=40, free_s=5, repetitions=1
    )
    motion, skeleton = motion_from_parameters(performance.parameters), performance.skeleton
    assert_allclose(performance.motion.origins, motion.origins, atol=EXACT)
    low, high = performance.actor.limits[..., 0], performance.actor.limits[..., 1]
    angles = np.c_[performance.parameters.angles, performance.parameters.twists[..., None]]
    known = np.isfinite(low)
    assert ((angles >= low) & (angles <= high))[:, known].all()
    moved = performance.moving_about[performance.recording.times < 40].any(axis=0)
    assert (moved == np.isfinite(low[:, :3])).all()
    for limb in skeleton.limbs:
        offsets = limb.marker_positions - limb.marker_positions.mean(axis=0)
        assert np.sqrt((offsets**2).sum(axis=1).mean()) <= 0.55 * limb.length + EXACT


def test_a_quadruped_stands_on_four_feet(rng):
    performance = make_performance(rng, plan=QUADRUPED, calibration_s=20, free_s=0, sway_deg=0)
    names = performance.skeleton.limb_names
    heights = dict(zip(names, performance.motion.origins[0, :, 1], strict=True))
    feet = [heights[name] for name in QUADRUPED.stands_on]
    assert max(feet) < 0.25
    assert heights["trunk"] > 0.4
    assert heights["head"] > heights["trunk"]


def test_a_hand_is_flat_with_its_thumb_to_the_left(rng):
    performance = make_performance(rng, plan=HAND, calibration_s=20, free_s=0, sway_deg=0)
    names = performance.skeleton.limb_names
    seen = performance.motion.origins[0] - performance.motion.origins[0, 0]
    at = dict(zip(names, seen @ performance.motion.rotations[0, 0], strict=True))
    tips = [at[f"{finger}_distal"] for finger in ("thumb", "index", "middle", "ring", "little")]
    assert (np.diff([tip[2] for tip in tips]) > 0).all()
    assert at["middle_distal"][0] > at["thumb_distal"][0]
    assert np.abs([tip[1] for tip in tips]).max() < 0.03


def test_the_cmu_layout_is_for_people(rng):
    with pytest.raises(BadSetting, match="a hand has no head, left_foot"):
        make_performance(rng, plan=HAND, layout="cmu41")
