"""What retargeting kept and what it broke, measured on the result alone."""

from dataclasses import asdict, dataclass

import numpy as np
from scipy.ndimage import maximum_filter1d

from kinesphere.data import Array, Json, Mask, Motion, Skeleton
from kinesphere.data.figure import SIDES, find_figure
from kinesphere.editing import RetargetSettings, retarget_motion
from kinesphere.editing.foot_contacts import find_contacts, find_ground, runs, soles
from kinesphere.editing.retarget_rest import rest_pose
from kinesphere.geometry.rotations import rotation_angle

_ARMS = (("upper_arm", "forearm"), ("forearm", "hand"))
_LEGS = (("thigh", "shank"), ("shank", "foot"))
_BENT = np.deg2rad(10.0)
"""From which a knee counts as bent."""


@dataclass(frozen=True)
class Row:
    """One motion on one rig."""

    motion: str
    rig: str
    scale: float
    arms_deg: float
    """Largest angle between an arm's bone and the source's, over limbs and frames."""
    legs_deg: float
    """Median of the same of the legs, which reach for the ground."""
    legs_most_deg: float
    n_contacts: int
    slide_free_mm: float
    """How far held heels and balls stray from where they stand, mean over contacts, if feet
    are left free."""
    slide_free_most_mm: float
    slide_mm: float
    slide_most_mm: float
    heel_most_mm: float
    """The same of heels that stand while the ball of their foot, which is held, stands too."""
    height_mm: float
    """Mean distance of standing points to the level of the source's, scaled."""
    wrong_knees: float
    """Share of the frames with a bent knee that it bends the wrong way."""
    turn_source_deg: float
    """Largest turn of pelvis, thighs, shanks and feet between two frames, of the source."""
    turn_deg: float
    """The same of the result."""
    jerk_source_deg: float
    """Largest change of such a turn from one frame to the next."""
    jerk_deg: float
    added_deg: float
    """Largest amount by which a limb's turn changes more than the same limb's of the source does
    within two frames."""
    lowered_mm: float
    """How far the pelvis went down at most."""

    def as_json(self) -> dict[str, Json]:
        """Return the row as plain data."""
        return asdict(self)


def measured(name: str, motion: Motion, rig_name: str, rig: Skeleton, alike: bool) -> Row:
    """Retarget and measure."""
    settings = RetargetSettings()
    free = retarget_motion(motion, rig, settings=RetargetSettings(feet="free"), rests_alike=alike)
    done = retarget_motion(motion, rig, settings=settings, rests_alike=alike)
    # joints of measured motion come apart; its limbs alone, one hanging from the other, do not
    hung = retarget_motion(motion, motion.skeleton)
    source = rest_pose(motion.skeleton, find_figure(motion.skeleton))
    target = rest_pose(rig, find_figure(rig))
    places, at = _places(motion), _places(done)
    bones = _places(hung)
    arms = _turned(motion, done) if alike else _angles(source, bones, target, at, _ARMS)
    legs = _angles(source, bones, target, at, _LEGS)

    feet = [source.figure.parts[f"{side}_foot"] for side in SIDES]
    ground = find_ground(places[:, feet], source.leg)
    shown = soles(source, motion.skeleton, motion.rotations, places, ground.ankle, 0.2)
    contacts = find_contacts(shown, motion.rate, source.leg, settings)
    scale = target.leg / source.leg
    ankle = target.ankle if target.ankle > 0.3 * scale * ground.ankle else scale * ground.ankle
    standing = {
        which: soles(target, rig, one.rotations, _places(one), ankle, 0.2)
        for which, one in (("free", free), ("done", done))
    }
    levels = ground.floor + scale * (shown[..., 1] - ground.floor)
    height = np.abs(standing["done"][..., 1] - levels)[contacts]
    held = _held(contacts)
    before, after = (_slides(standing[which], held) for which in ("free", "done"))
    heels = _slides(standing["done"], contacts & ~held)
    (turn_was, jerk_was), (turn, jerk) = (_leaps(one) for one in (motion, done))
    added = jerk - maximum_filter1d(jerk_was, 5, axis=0, mode="nearest")
    return Row(
        name,
        rig_name,
        scale,
        float(np.rad2deg(arms.max())),
        float(np.rad2deg(np.median(legs))),
        float(np.rad2deg(legs.max())),
        len(after),
        float(np.mean(before)) * 1e3,
        float(np.max(before)) * 1e3,
        float(np.mean(after)) * 1e3,
        float(np.max(after)) * 1e3,
        float(np.max(heels, initial=0.0)) * 1e3,
        float(height.mean()) * 1e3,
        _wrong_knees(target, done, at),
        turn_source_deg=float(np.rad2deg(turn_was.max())),
        turn_deg=float(np.rad2deg(turn.max())),
        jerk_source_deg=float(np.rad2deg(jerk_was.max())),
        jerk_deg=float(np.rad2deg(jerk.max())),
        added_deg=float(np.rad2deg(added.max())),
        lowered_mm=float(done.history[-1].findings["pelvis_lowered_mm"]),  # type: ignore[arg-type]
    )


def _places(motion: Motion) -> Array:
    return np.concatenate([motion.origins[:, :1], motion.joint_centres()], axis=1)


def _angles(source, places, target, at, pairs):  # type: ignore[no-untyped-def]
    """Return the angles in rad between bones of both, (n_frames, n_bones)."""
    found = []
    for side in SIDES:
        for first, second in pairs:
            names = f"{side}_{first}", f"{side}_{second}"
            if any(n not in rest.figure.parts for n in names for rest in (source, target)):
                continue
            ways = [
                p[:, rest.figure.parts[names[1]]] - p[:, rest.figure.parts[names[0]]]
                for rest, p in ((source, places), (target, at))
            ]
            a, b = (way / np.linalg.norm(way, axis=1, keepdims=True) for way in ways)
            found.append(np.arctan2(np.linalg.norm(np.cross(a, b), axis=1), (a * b).sum(axis=1)))
    return np.stack(found, axis=1)


def _turned(motion: Motion, done: Motion) -> Array:
    """Return by how much the frames of the arms differ, rad."""
    at = [i for i, n in enumerate(motion.skeleton.limb_names) if n.endswith(("arm", "hand"))]
    both = np.swapaxes(motion.rotations[:, at], -1, -2) @ done.rotations[:, at]
    return rotation_angle(both)


def _slides(points: Array, contacts: Mask) -> list[float]:
    """Return how far each contact strays along the floor from its middle, m."""
    found = []
    for f in range(points.shape[1]):
        for k in range(points.shape[2]):
            for a, b in runs(contacts[:, f, k]):
                there = points[a:b, f, k][:, [0, 2]]
                found.append(float(np.linalg.norm(there - there.mean(axis=0), axis=1).max()))
    return found


def _held(contacts: Mask) -> Mask:
    """Return which of the standing points is held: the ball where both stand."""
    held = np.array(contacts)
    held[..., 0] &= ~contacts[..., 1]
    return held


def _wrong_knees(rest, motion, at) -> float:  # type: ignore[no-untyped-def]
    wrong = bent = 0
    for side in SIDES:
        thigh, shank, foot = (rest.figure.parts[f"{side}_{p}"] for p in ("thigh", "shank", "foot"))
        u, v = at[:, shank] - at[:, thigh], at[:, foot] - at[:, shank]
        hinge = (motion.rotations[:, thigh] @ rest.rest_from_body)[..., 2]
        turn = np.arctan2((np.cross(u, v) * hinge).sum(axis=1), (u * v).sum(axis=1))
        bent += int((np.abs(turn) > _BENT).sum())
        wrong += int((turn > _BENT).sum())
    return wrong / max(bent, 1)


def _leaps(motion: Motion) -> tuple[Array, Array]:
    """Return the turns of pelvis, thighs, shanks and feet between frames, and their changes, rad.

    Of a motion without gaps: (n_frames − 1, 7) and (n_frames − 2, 7).
    """
    figure = find_figure(motion.skeleton)
    names = [f"{side}_{part}" for side in SIDES for part in ("thigh", "shank", "foot")]
    r = motion.rotations[:, [figure.pelvis, *(figure.parts[name] for name in names)]]
    # in the world: the frames of two rigs stand differently in their limbs
    step = r[1:] @ np.swapaxes(r[:-1], -1, -2)
    change = step[1:] @ np.swapaxes(step[:-1], -1, -2)
    return rotation_angle(step), rotation_angle(change)
