"""Limbs stay linked unless halves of the time speak against it."""

import numpy as np
import pytest
from numpy.testing import assert_allclose
from tests.skeleton.test_linked import FRAMES, arm, solved

from kinesphere.geometry.centres import with_expectation
from kinesphere.skeleton import link_worth
from kinesphere.skeleton.link_worth import no_surer_than

FIT = with_expectation(np.zeros(3), np.diag([1e6, 1e6, 1e2]), 0.05, 0.001, 20)


def halves_say(monkeypatch, change):
    """Have every half's groups changed before they are looked at; return how many there were."""
    fit, halves = link_worth.fit_group, []

    def changed(*arguments):
        halves.append(len(arguments[3]["*0"]))
        return change(fit(*arguments), len(halves))

    monkeypatch.setattr(link_worth, "fit_group", changed)
    return halves


def off_by(metres):
    def change(group, half):
        joints = {
            limb: joint._replace(world=joint.world + metres * half)
            for limb, joint in group.joints.items()
        }
        return group._replace(joints=joints)

    return change


@pytest.mark.parametrize(
    ("change", "linked"),
    [
        (off_by(0.0), True),
        (off_by(0.05), False),
        (lambda group, _: group._replace(strays=True), False),
        (lambda group, half: group._replace(strays=half == 2), False),
        (lambda group, _: group._replace(firm=False), True),
        (lambda *_: None, True),
    ],
    ids=["agree", "apart", "stray", "one strays", "hardly tell", "silent"],
)
def test_halves_that_speak_against_it_keep_limbs_apart(rng, monkeypatch, change, linked):
    markers, _ = arm(rng, 0.02)
    alone = solved(markers, link_limbs=False).skeleton.joints
    halves = halves_say(monkeypatch, change)
    joints = solved(markers).skeleton.joints
    same = [
        np.array_equal(one.centre_in_parent, other.centre_in_parent)
        for one, other in zip(alone, joints, strict=True)
    ]
    assert same == [not linked] * 2
    assert len(halves) == 2
    assert sum(halves) <= FRAMES


def test_a_centre_is_as_unsure_as_halves_are_apart():
    unsure = no_surer_than(FIT, 0.2)
    for covariance in (unsure.covariance, unsure.data_covariance):
        assert np.trace(2 * covariance) >= 0.2**2 * (1 - 1e-12)
    more = unsure.covariance - FIT.covariance
    assert_allclose(more, more[0, 0] * np.eye(3), atol=1e-15)


def test_halves_that_agree_make_nothing_surer():
    sure = no_surer_than(FIT, 0.0001)
    assert_allclose(sure.covariance, FIT.covariance, rtol=0, atol=0)
    assert_allclose(sure.data_covariance, FIT.data_covariance, rtol=0, atol=0)
