"""Skin that slides over bone: the error no filter takes away."""

from dataclasses import replace

import numpy as np
from scipy.signal import lfilter

from kinesphere.data import Array, Json, Limb, Recording
from kinesphere.errors import BadRecording
from kinesphere.synthetic.performance import Performance
from kinesphere.synthetic.spoil import check_range, remembered


def spoil_with_soft_tissue(
    recording: Recording,
    rng: np.random.Generator,
    performance: Performance,
    *,
    per_radian: float = 0.010,
    reach: float = 0.15,
    wobble: float = 0.002,
    time_constant: float = 0.4,
    shared: float = 0.5,
) -> Recording:
    """Let skin slide over bone with the pose, and wobble.

    Seen from its limb a marker moves by ``sum(angle * direction * exp(-distance / reach))`` over
    the angles and twists of the limb's joints, and by an Ornstein–Uhlenbeck process. The directions
    are drawn once a marker, angle and recording, so the slide is the same whenever the pose is: no
    filter and no average takes it away. It is largest near a joint, as in life (Leardini et al.
    2005, doi:10.1016/j.gaitpost.2004.05.002).

    Parameters
    ----------
    performance
        Tells the pose and which limb carries which marker.
    per_radian
        m per rad, rms length of a marker's slide with one angle, at the joint.
    reach
        m, distance from the joint at which the slide is 1/e of that.
    wobble
        m, standard deviation of each coordinate of the wobble.
    time_constant
        s, after which the wobble has forgotten 1 − 1/e of itself.
    shared
        0 to 1, share of the variance of direction and wobble that all markers of a limb have in
        common, so that the whole marker body moves.

    Raises
    ------
    BadRecording
        If the recording is not one of this performance.
    """
    check_range("per_radian", per_radian, low=0)
    check_range("reach", reach, low=1e-9)
    check_range("wobble", wobble, low=0)
    check_range("time_constant", time_constant, low=1e-9)
    check_range("shared", shared, low=0, high=1)
    if recording.n_frames != performance.recording.n_frames:
        raise BadRecording(
            f"the recording has {recording.n_frames} frames, its performance "
            f"{performance.recording.n_frames}; skin slides with the pose in each of them"
        )
    markers = recording.markers.copy()
    for i, limb in enumerate(performance.skeleton.limbs):
        columns = recording.columns(limb.markers)
        slide = per_radian * _slide(rng, performance, limb, shared, reach)
        keep = np.exp(-1 / (recording.rate * time_constant))
        pushes = wobble * _partly_common(rng, len(columns), (len(markers), 3), shared)
        pushes[:, 1:] *= np.sqrt(1 - keep**2)  # the first is where it happens to be
        wobbling = np.moveaxis(lfilter([1.0], [1.0, -keep], pushes, axis=1), 0, 1)
        world_from_limb = performance.motion.rotations[:, i, None]
        markers[:, columns] += (world_from_limb @ (slide + wobbling)[..., None])[..., 0]
    settings: dict[str, Json] = {
        "per_radian_mm": per_radian * 1e3,
        "reach_mm": reach * 1e3,
        "wobble_mm": wobble * 1e3,
        "time_constant_s": time_constant,
        "shared": shared,
    }
    return replace(
        recording, markers=markers, history=remembered(recording, "soft tissue", settings)
    )


def _slide(
    rng: np.random.Generator, performance: Performance, limb: Limb, shared: float, reach: float
) -> Array:
    """Return a limb's slide in its frame at 1 m per rad, (n_frames, n_markers, 3)."""
    skeleton, parameters = performance.skeleton, performance.parameters
    slide = np.zeros((parameters.n_frames, len(limb.markers), 3))
    for j, joint in enumerate(skeleton.joints):
        if limb.name not in (joint.parent, joint.child):
            continue
        here = joint.centre_in_parent if limb.name == joint.parent else joint.centre_in_child
        nearness = np.exp(-np.linalg.norm(limb.marker_positions - here, axis=1) / reach)
        angles = np.c_[parameters.angles[:, j, : joint.n_axes], parameters.twists[:, j]]
        directions = _partly_common(rng, len(limb.markers), (angles.shape[1], 3), shared)
        slide += np.einsum("fa,mai,m->fmi", angles, directions / np.sqrt(3), nearness)
    return slide


def _partly_common(
    rng: np.random.Generator, n_markers: int, shape: tuple[int, ...], shared: float
) -> Array:
    """Draw standard normal (n_markers, *shape), ``shared`` of their variance common to all."""
    common, own = rng.normal(size=(1, *shape)), rng.normal(size=(n_markers, *shape))
    return np.asarray(np.sqrt(shared) * common + np.sqrt(1 - shared) * own)
