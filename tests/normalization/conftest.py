"""A doll: a body of sticks whose normalized frames are known, told in limb frames of any kind."""

from dataclasses import dataclass, replace

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from kinesphere.data import Joint, Limb, Motion, PoseFlag, Skeleton

UP, DOWN, AHEAD = (0.0, 1.0, 0.0), (0.0, -1.0, 0.0), (1.0, 0.0, 0.0)

# limb: parent, its own beginning (m, body frame, from the middle of the hips; None: where the
# parent ends), length, canonical direction
PLAN = {
    "pelvis": (None, (0.0, 0.0, 0.0), 0.12, UP),
    "trunk": ("pelvis", None, 0.40, UP),
    "head": ("trunk", None, 0.25, UP),
    "left_upper_arm": ("trunk", (0.0, 0.46, -0.18), 0.30, DOWN),
    "left_forearm": ("left_upper_arm", None, 0.26, DOWN),
    "left_hand": ("left_forearm", None, 0.15, DOWN),
    "left_thigh": ("pelvis", (0.0, 0.0, -0.09), 0.42, DOWN),
    "left_shank": ("left_thigh", None, 0.41, DOWN),
    "left_foot": ("left_shank", None, 0.20, AHEAD),
}
PLAN |= {
    name.replace("left", "right"): (
        parent.replace("left", "right"),
        begin if begin is None else (begin[0], begin[1], -begin[2]),
        length,
        canonical,
    )
    for name, (parent, begin, length, canonical) in PLAN.items()
    if name.startswith("left")
}
LEGS = ("pelvis", *(n for n in PLAN if n.endswith(("thigh", "shank", "foot"))))
"""The lower half of the doll."""

PLACES = ("toe", "inner", "outer", "arch", "heel")

STANCE = {
    "left_upper_arm": (0.02, -1.0, -0.25),
    "right_upper_arm": (0.04, -1.0, 0.20),
    "left_forearm": (0.20, -1.0, -0.15),
    "right_forearm": (0.25, -1.0, 0.10),
    "left_hand": (0.1, -1.0, 0.0),
    "right_hand": (0.2, -1.0, 0.1),
    "left_thigh": (0.02, -1.0, -0.05),
    "right_thigh": (0.0, -1.0, 0.06),
    "left_shank": (-0.05, -1.0, -0.02),
    "right_shank": (-0.04, -1.0, 0.01),
    "left_foot": (1.0, -0.2, -0.15),
    "right_foot": (1.0, -0.2, 0.10),
}
"""Where limbs of somebody who stands at ease point, in the body frame, not normalized."""


@dataclass(frozen=True, eq=False)
class Doll:
    """A motion and what normalizing it must give."""

    motion: Motion
    truth: np.ndarray
    """(n_frames, n_limbs, 3, 3) normalized ``world_from_limb``."""
    middles: np.ndarray
    """(n_frames, n_limbs, 3) m, middles of the limbs in the world."""

    def index(self, name):
        return self.motion.skeleton.limb_names.index(name)


def make_doll(
    rng,
    names=tuple(PLAN),
    *,
    plan=PLAN,
    n_frames=7,
    stance=STANCE,
    bends=None,
    world=None,
    walk=None,
    rate=50.0,
    scale=1.0,
    scramble=True,
    paired=False,
):
    """Build a doll.

    ``plan``: what limbs there are, like `PLAN`; ``names``: which of them this one has.
    ``stance``: limb → direction in its default pose; ``bends``: limb → (n_frames, 3) rotation
    vectors in the body frame by which it and all it carries leave that pose; ``world``: (n_frames,
    3, 3) or (3, 3) where the body frame points; ``walk``: (n_frames, 3) m.
    ``paired``: labels name places, though no markers of left and right are mirrored.
    """
    bends = bends or {}
    world = np.broadcast_to(np.eye(3) if world is None else world, (n_frames, 3, 3))
    walk = np.zeros((n_frames, 3)) if walk is None else np.asarray(walk)
    begins, ends, ways = {}, {}, {}
    for name in names:
        parent, begin, length, canonical = plan[name]
        way = np.array(stance.get(name, canonical))
        ways[name] = way / np.linalg.norm(way)
        at = np.array(begin) if begin is not None else ends[parent]
        begins[name] = scale * at if begin is not None else at
        ends[name] = begins[name] + scale * length * ways[name]
    bodies, places = {}, {}  # how each limb is turned from its default pose, where its begin is
    limbs, joints = [], []
    n = len(names)
    rotations, truth = np.empty((n_frames, n, 3, 3)), np.empty((n_frames, n, 3, 3))
    origins, middles = np.empty((n_frames, n, 3)), np.empty((n_frames, n, 3))
    turns, middle_of = {}, {}
    for i, name in enumerate(names):
        parent, _, length, canonical = plan[name]
        own = Rotation.from_rotvec(bends.get(name, np.zeros((n_frames, 3)))).as_matrix()
        if parent is None:
            bodies[name], places[name] = own, np.broadcast_to(begins[name], (n_frames, 3))
        else:
            bodies[name] = own @ bodies[parent]
            offset = begins[name] - begins[parent]
            places[name] = places[parent] + bodies[parent] @ offset
        turn = Rotation.random(rng=rng).as_matrix() if scramble else least(canonical, ways[name])
        middle = (begins[name] + ends[name]) / 2
        origin = middle + (scale * rng.normal(scale=0.1, size=3) if scramble else 0.0)
        turns[name], middle_of[name] = turn, origin
        rotations[:, i] = world @ bodies[name] @ turn
        truth[:, i] = world @ bodies[name] @ least(canonical, ways[name])
        for store, point in ((origins, origin), (middles, middle)):
            moved = places[name] + bodies[name] @ (point - begins[name])
            store[:, i] = walk + (world @ moved[..., None])[..., 0]
        markers = markers_around(rng, begins[name], ends[name], scale)
        if name.endswith("foot"):  # a heel, last
            heel = begins[name] - 0.3 * (ends[name] - begins[name])
            markers = np.vstack([markers, heel])
        limbs.append(
            Limb(
                name=name,
                parent=parent,
                markers=tuple(
                    f"{name}_{PLACES[m]}" if paired else f"{name}{m}" for m in range(len(markers))
                ),
                marker_positions=(markers - origin) @ turn,
                length=scale * length,
                long_axis=turn.T @ ways[name],
            )
        )
        if parent is not None:
            spread = rng.normal(size=(3, 3))
            joints.append(
                Joint(
                    name=f"joint_of_{name}",
                    parent=parent,
                    child=name,
                    centre_in_parent=(begins[name] - middle_of[parent]) @ turns[parent],
                    centre_in_child=(begins[name] - origin) @ turn,
                    residual=0.0,
                    range_of_motion=0.0,
                    covariance=spread @ spread.T,
                    observability="determined",
                )
            )
    motion = Motion(
        skeleton=Skeleton(tuple(limbs), tuple(joints)),
        rotations=rotations,
        origins=origins,
        residuals=np.zeros((n_frames, n)),
        flags=np.full((n_frames, n), PoseFlag.MEASURED),
        rate=rate,
        first_frame=101,
    )
    return Doll(motion, truth, middles)


def least(source, target):
    """Return the least rotation between directions, by its axis and angle."""
    axis = np.cross(source, target)
    sine = np.linalg.norm(axis)
    if sine < 1e-15:
        return np.eye(3)
    angle = np.arctan2(sine, np.dot(source, target))
    return Rotation.from_rotvec(axis / sine * angle).as_matrix()


def markers_around(rng, begin, end, scale):
    """Place four markers whose middle lies on the line of the limb."""
    along = (end - begin) / np.linalg.norm(end - begin)
    across = np.cross(along, rng.normal(size=3))
    other = np.cross(along, across)
    place = begin + 0.7 * (end - begin)
    return place + scale * 0.03 * np.array([across, -across, other, -other])


def renamed(motion):
    """Return the motion with limbs that nobody can name."""
    new = {name: f"limb_{i + 1:02d}" for i, name in enumerate(motion.skeleton.limb_names)}
    limbs = tuple(
        replace(limb, name=new[limb.name], parent=new.get(limb.parent))
        for limb in motion.skeleton.limbs
    )
    joints = tuple(
        replace(joint, name=f"joint_{i + 1:02d}", parent=new[joint.parent], child=new[joint.child])
        for i, joint in enumerate(motion.skeleton.joints)
    )
    return replace(motion, skeleton=Skeleton(limbs, joints))


def hidden(motion, limb, frames):
    """Return the motion with one limb unseen in some frames."""
    rotations, origins, flags = (
        motion.rotations.copy(),
        motion.origins.copy(),
        motion.flags.copy(),
    )
    i = motion.skeleton.limb_names.index(limb)
    rotations[frames, i], origins[frames, i] = np.nan, np.nan
    flags[frames, i] = PoseFlag.UNSEEN
    return replace(motion, rotations=rotations, origins=origins, flags=flags)


@pytest.fixture
def doll(rng):
    """Build dolls from the test's own generator."""
    return lambda *args, **kwargs: make_doll(rng, *args, **kwargs)


@pytest.fixture(scope="session")
def tools():
    """Hand on what the tests of this folder share."""

    class Tools:
        legs = LEGS
        plan = PLAN
        stance = STANCE
        least = staticmethod(least)
        renamed = staticmethod(renamed)
        hidden = staticmethod(hidden)
        make_doll = staticmethod(make_doll)

    return Tools
