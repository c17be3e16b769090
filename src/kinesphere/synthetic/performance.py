"""A whole performance: an actor moves, cameras see its markers, and the truth is kept."""

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np

from kinesphere import __version__
from kinesphere.data import (
    Array,
    Mask,
    Motion,
    Parameters,
    Recording,
    Skeleton,
    Step,
    TopologicalModel,
    motion_from_parameters,
)
from kinesphere.errors import BadSetting
from kinesphere.geometry.rotations import rotation_angle
from kinesphere.synthetic.actor import Actor, make_actor
from kinesphere.synthetic.axes import Range
from kinesphere.synthetic.bodies import HUMAN
from kinesphere.synthetic.layout import Layout, place_markers
from kinesphere.synthetic.movement import Course, angle_courses
from kinesphere.synthetic.plan import BodyPlan
from kinesphere.synthetic.root import root_positions, root_rotations, way_over_floor

_N_COMPARED = 80  # frames among which the range of motion is looked for


@dataclass(frozen=True, eq=False)
class Performance:
    """What cameras saw, and everything they should lead back to."""

    recording: Recording
    """Complete and without noise; y up, metres."""
    model: TopologicalModel
    """Which marker sits on which limb."""
    parameters: Parameters
    """True angles, twists and root poses; its skeleton holds true sizes, centres, axes, rests."""
    motion: Motion
    """True poses of the normalized limb frames."""
    joint_centres: Array
    """(n_frames, n_joints, 3) m in the world."""
    calibration: tuple[float, float]
    """s, start and end of the calibration, standing at the start included."""
    moving_about: Mask
    """(n_frames, n_joints, 3) True while the limb moves about axis 1, 2, 3 on purpose."""
    actor: Actor

    @property
    def skeleton(self) -> Skeleton:
        """The true skeleton."""
        return self.parameters.skeleton


def make_performance(
    rng: np.random.Generator,
    *,
    layout: Layout = "bodies",
    plan: BodyPlan = HUMAN,
    rate: float = 50.0,
    calibration_s: float = 60.0,
    free_s: float = 20.0,
    n_frames: int | None = None,
    repetitions: int = 3,
    sway_deg: float = 0.2,
    axes_deg: Range = (70.0, 110.0),
    cone_deg: Range = (80.0, 100.0),
) -> Performance:
    """Let a random actor stand, calibrate and move freely.

    It stands in the default position, makes the main movements of each limb one after another with
    rests between, then walks and reaches about, twisting every limb.

    Parameters
    ----------
    rng
        Everything random comes from it.
    layout
        ``bodies``: three to five markers at random on each limb; ``cmu41``: the 41 markers of the
        CMU recordings at their anatomical places.
    plan
        The kind of body.
    rate
        Hz.
    calibration_s, free_s
        s.
    n_frames
        Instead of ``free_s``: how many frames there are in all.
    repetitions
        How often each calibration movement is made.
    sway_deg
        deg, standard deviation of the sway of every angle while calibrating.
    axes_deg, cone_deg
        As `make_actor` takes them.

    Raises
    ------
    BadSetting
        If a duration is negative, or there are fewer frames than the calibration takes.
    """
    n_calibration = round(calibration_s * rate)
    total = round((calibration_s + free_s) * rate) if n_frames is None else n_frames
    if not rate > 0 or calibration_s < 0 or free_s < 0:
        raise BadSetting(
            f"rate {rate} Hz must be positive, calibration {calibration_s} s and free motion "
            f"{free_s} s must not be negative"
        )
    if total < max(n_calibration, 1):
        raise BadSetting(
            f"n_frames is {total}; the calibration alone takes {n_calibration} frames, "
            "and at least one frame is needed"
        )
    actor = make_actor(rng, plan=plan, axes_deg=axes_deg, cone_deg=cone_deg)
    skeleton, model = place_markers(rng, actor, layout)
    times = np.arange(total) / rate
    course = angle_courses(
        rng,
        actor,
        times,
        calibration_s=calibration_s,
        repetitions=repetitions,
        sway_deg=sway_deg,
    )
    step = Step(
        "synthetic",
        settings={
            "layout": layout,
            "plan": plan.name,
            "rate_hz": rate,
            "calibration_s": calibration_s,
            "free_s": total / rate - calibration_s,
            "repetitions": repetitions,
            "sway_deg": sway_deg,
            "axes_deg": list(axes_deg),
            "cone_deg": list(cone_deg),
        },
        findings={"size_m": actor.size, "n_frames": total},
        version=__version__,
    )
    parameters, motion = _on_the_floor(rng, actor, skeleton, course, times, rate, step)
    markers = motion.marker_positions()
    return Performance(
        recording=Recording(
            markers=np.stack(list(markers.values()), axis=1),
            labels=tuple(markers),
            rate=rate,
            up="+y",
            history=(step,),
        ),
        model=model,
        parameters=parameters,
        motion=motion,
        joint_centres=motion.joint_centres(),
        calibration=(0.0, calibration_s),
        moving_about=course.moving,
        actor=actor,
    )


def together(performances: Mapping[str, Performance]) -> Recording:
    """Return one recording of several people in one room, who know nothing of each other.

    Parameters
    ----------
    performances
        Name → performance; all of the same length and rate. Labels become ``name:label``.

    Raises
    ------
    BadSetting
        If their lengths or rates differ.
    """
    recordings = {name: performance.recording for name, performance in performances.items()}
    kinds = {(recording.n_frames, recording.rate) for recording in recordings.values()}
    if len(kinds) != 1:
        raise BadSetting("performances differ in length or rate; one recording needs them alike")
    (_, rate) = kinds.pop()
    labels = tuple(f"{name}:{label}" for name, r in recordings.items() for label in r.labels)
    return Recording(
        markers=np.concatenate([r.markers for r in recordings.values()], axis=1),
        labels=labels,
        rate=rate,
        up="+y",
        history=(Step("synthetic", {"people": list(recordings)}, version=__version__),),
    )


def _on_the_floor(
    rng: np.random.Generator,
    actor: Actor,
    skeleton: Skeleton,
    course: Course,
    times: Array,
    rate: float,
    step: Step,
) -> tuple[Parameters, Motion]:
    """Put the angles on the skeleton and the skeleton on the floor."""
    n_frames, n_joints = len(times), len(skeleton.joints)
    heading, way = way_over_floor(rng, course, times)
    parameters = Parameters(
        skeleton=skeleton,
        root_positions=np.zeros((n_frames, 3)),
        root_rotations=root_rotations(rng, heading, course, times),
        angles=course.angles[..., :3],
        twists=course.angles[..., 3],
        residuals=np.zeros((n_frames, n_joints)),
        flags=np.zeros((n_frames, n_joints), dtype=np.uint8),
        moving=np.asarray(course.moving.any(axis=2)),
        rate=rate,
        history=(step,),
    )
    hovering = motion_from_parameters(parameters)
    compared = np.unique(np.linspace(0, n_frames - 1, _N_COMPARED).astype(int))
    relative = hovering.relative_rotations()[compared]
    joints = tuple(
        replace(joint, range_of_motion=_range_of_motion(relative[:, j]))
        for j, joint in enumerate(skeleton.joints)
    )
    skeleton = replace(skeleton, joints=joints)
    positions = root_positions(rng, way, actor, hovering, course, times)
    motion = replace(
        hovering,
        skeleton=skeleton,
        origins=hovering.origins + positions[:, None],
        residuals=np.zeros_like(hovering.residuals),
    )
    return replace(parameters, skeleton=skeleton, root_positions=positions), motion


def _range_of_motion(relative: Array) -> float:
    """Return the 95th percentile in rad of the angles between the orientations (n, 3, 3)."""
    between = np.swapaxes(relative[:, None], -1, -2) @ relative
    return float(np.percentile(rotation_angle(between), 95))
