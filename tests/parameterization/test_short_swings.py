"""An axis from one short swing: the error that is told beside the one that is made."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation
from tests.parameterization.conftest import wander

from kinesphere.parameterization.anatomy import room, substitute_axes
from kinesphere.parameterization.settings import ParameterizationSettings
from kinesphere.parameterization.third_axis import fit_axes
from kinesphere.parameterization.view import view_joint

RATE, LAG = 100.0, 6  # Hz; frames that skin comes late
DOWN = np.array([0.0, -1.0, 0.0])
TRIALS = 16


def course(kind):
    """Return how far a limb has bent, 0 to 1: there and back at once, or after a pause."""
    u = np.linspace(0, 1, 70)
    bend = u**3 * (10 - 15 * u + 6 * u**2)
    still = np.zeros(100)
    pause = {"back": np.ones(5), "held": np.ones(100)}[kind]
    return np.concatenate([still, bend, pause, bend[::-1], still])


def told_and_true(rng, swing_deg, kind, share):
    """Return the error told and the one made, deg, of an elbow on skin; None where it is doubted.

    Its poses wander by 1° and by a share of the angle, late, about an axis of the skin's own.
    """
    angle = np.deg2rad(swing_deg) * course(kind)
    axis = Rotation.from_rotvec(np.deg2rad(rng.normal(scale=6.0, size=3))).apply(
        substitute_axes("left_elbow", 1, DOWN)[0]
    )
    skin = rng.normal(size=3)
    skin *= share / np.linalg.norm(skin)
    late = np.concatenate([np.zeros(LAG), angle[:-LAG]])
    errors = Rotation.from_rotvec(wander(rng, len(angle), RATE, 1.0))
    turned = (
        errors * Rotation.from_rotvec(np.outer(late, skin)),
        Rotation.from_rotvec(np.outer(angle + np.deg2rad(rng.uniform(10, 40)), axis)),
    )
    seen = np.ones(len(angle), dtype=bool)
    settings = ParameterizationSettings()
    view = view_joint(
        "left_elbow", (turned[0] * turned[1]).as_matrix(), DOWN, seen, RATE, seen, settings
    )
    fit = fit_axes(view, settings)
    if fit.source != "movement":
        return None
    true = np.arccos(min(1.0, abs(float(fit.axes[-1] @ axis))))
    return np.rad2deg(fit.uncertainty[-1]), np.rad2deg(true)


@pytest.mark.parametrize("kind", ["back", "held"])
@pytest.mark.parametrize("swing_deg", [14.0, 20.0, 30.0, 40.0])
@pytest.mark.parametrize("share", [0.0, 0.1])
def test_the_error_that_is_told_is_not_smaller_than_the_one_made(rng, swing_deg, kind, share):
    both = [told_and_true(rng, swing_deg, kind, share) for _ in range(TRIALS)]
    told, true = np.array([b for b in both if b is not None] or np.empty((0, 2))).T
    assert swing_deg < 20.0 or len(told) > TRIALS / 2  # honest, not refused altogether
    assert np.sqrt(((true / told) ** 2).sum() / max(1, len(told))) < 1.15
    assert (true < 2 * told).all()
    assert (told <= room("left_elbow") * ParameterizationSettings().axes.largest_uncertainty).all()


@pytest.mark.parametrize("kind", ["back", "held"])
def test_a_swing_too_short_to_tell_an_axis_is_doubted(rng, kind):
    assert [told_and_true(rng, 9.0, kind, 0.1) for _ in range(TRIALS)] == [None] * TRIALS
