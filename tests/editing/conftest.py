"""A figure that walks as told: when each foot stands is known."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from kinesphere.data import Motion
from kinesphere.data.figure import rest_places
from kinesphere.editing import RetargetSettings, retarget_motion
from kinesphere.geometry.two_bone import reach_for
from kinesphere.synthetic import make_performance

RATE = 60.0
STEP = 0.8  # m a stride of one second
ANKLE = 0.085  # m above the floor
SIDES = ("left", "right")


def stride(t, late):
    """Return share of the swing (0 in stance), place along the way and lift of one foot."""
    phase = (t + late) % 1.0
    swing = np.where(phase > 0.62, (phase - 0.62) / 0.38, 0.0)
    ahead = STEP * (np.floor(t + late) - late + swing - np.sin(2 * np.pi * swing) / (2 * np.pi))
    return phase, ahead, 0.1 * np.sin(np.pi * swing) ** 2


@pytest.fixture(scope="session")
def walk():
    """Return a walking motion of an actor's skeleton, heels rising before the feet leave."""
    performance = make_performance(
        np.random.default_rng(5), rate=20.0, calibration_s=1.0, free_s=0.5
    )
    skeleton = performance.skeleton
    names, n = list(skeleton.limb_names), 300
    t = np.arange(n) / RATE
    rotations = np.tile(np.eye(3), (n, len(names), 1, 1))
    swing = 0.4 * np.sin(2 * np.pi * t)
    for side, sign in zip(SIDES, (1, -1), strict=True):
        arm = Rotation.from_euler("z", sign * swing[:, None])
        for limb, bend in (("upper_arm", 0.0), ("forearm", 0.7), ("hand", 0.7)):
            if f"{side}_{limb}" in names:
                bent = arm * Rotation.from_euler("z", bend)
                rotations[:, names.index(f"{side}_{limb}")] = bent.as_matrix()
    rest = rest_places(skeleton)
    at = {name: rest[i] for i, name in enumerate(names)}
    leg = np.linalg.norm(at["left_foot"] - at["left_shank"]) + np.linalg.norm(
        at["left_shank"] - at["left_thigh"]
    )
    place = np.stack([STEP * (t - 0.31), np.full(n, ANKLE + 0.92 * leg), np.zeros(n)], axis=1)
    root = place - (at["left_thigh"] + at["right_thigh"]) / 2
    for side, late in zip(SIDES, (0.0, 0.5), strict=True):
        phase, ahead, lift = stride(t, late)
        # the ball stays where it is while the heel rises; the ankle goes round it
        rising = np.clip((phase - 0.42) / 0.2, 0, 1) * (phase <= 0.62)
        pitch = -0.6 * rising**2 * (3 - 2 * rising)
        falling = np.where(phase > 0.62, np.cos(np.pi * (phase - 0.62) / 0.38) / 2 + 0.5, 0.0)
        pitch = pitch - 0.6 * falling
        foot = Rotation.from_euler("z", pitch[:, None])
        ball = 0.75 * skeleton.limb(f"{side}_foot").length
        sole = np.array([ball, -ANKLE, 0.0])
        stands = np.stack([ahead + ball, lift, np.full(n, at[f"{side}_thigh"][2])], axis=1)
        goal = stands - foot.apply(sole)
        hip, knee, ankle = (root + at[f"{side}_{p}"] for p in ("thigh", "shank", "foot"))
        reach = reach_for(hip, knee, ankle, np.tile([0.0, 0.0, 1.0], (n, 1)), goal)
        assert reach.missed.max() < 1e-9
        rotations[:, names.index(f"{side}_thigh")] = reach.upper
        rotations[:, names.index(f"{side}_shank")] = reach.lower
        rotations[:, names.index(f"{side}_foot")] = foot.as_matrix()
    nothing = np.full((n, len(names)), np.nan)
    bare = replace(performance.motion, rate=RATE, history=())
    motion = Motion(
        skeleton, rotations, np.tile(root[:, None], (1, len(names), 1)), nothing,
        np.ones(nothing.shape), bare.rate,
    )  # fmt: skip
    origins = np.array(motion.origins)
    for i, joint in enumerate(skeleton.joints, start=1):
        p = skeleton.parents[i]
        centre = origins[:, p] + rotations[:, p] @ joint.centre_in_parent
        origins[:, i] = centre - rotations[:, i] @ joint.centre_in_child
    motion = replace(motion, origins=origins)
    # the hips' middle leads: onto itself nothing changes
    free = retarget_motion(motion, skeleton, settings=RetargetSettings(feet="free"))
    assert np.abs(free.origins - motion.origins).max() < 1e-9
    return replace(motion, skeleton=free.skeleton)


@pytest.fixture(scope="session")
def standing():
    """Return when each foot of the walk stands on its ball, (300, 2)."""
    t = np.arange(300) / RATE
    return np.stack([stride(t, late)[0] <= 0.62 for late in (0.0, 0.5)], axis=1)
