"""One joint whose axes, angles and rest we placed ourselves."""

from dataclasses import dataclass

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.signal import lfilter
from scipy.spatial.transform import Rotation

from kinesphere.parameterization.settings import ParameterizationSettings
from kinesphere.parameterization.view import JointView, view_joint

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class TrueJoint:
    """A joint seen from its parent, and the truth about it."""

    rotations: Array  # (n, 3, 3)
    long_axis: Array  # (3,)
    axes: Array  # (2, 3) distal first
    rest: Array  # (3, 3)
    angles: Array  # (n, 3) about both axes, then twist
    moving: NDArray[np.bool_]  # (n,)
    rate: float

    def view(self, name: str = "joint_01", **changes: object) -> JointView:
        """Return the joint as the stage sees it."""
        everywhere = np.ones(len(self.rotations), dtype=bool)
        settings = ParameterizationSettings(**changes)  # type: ignore[arg-type]
        return view_joint(
            name, self.rotations, self.long_axis, everywhere, self.rate, everywhere, settings
        )

    def axis_errors(self, axes: Array) -> Array:
        """Return the angle in deg between each true axis line and the found one next to it."""
        if len(axes) != 2:
            return np.array([90.0, 90.0])
        cosines = np.abs(self.axes @ axes.T)
        pairs = max(([0, 1], [1, 0]), key=lambda p: cosines[0, p[0]] + cosines[1, p[1]])
        sines = np.linalg.norm(np.cross(self.axes, axes[pairs]), axis=1)
        return np.rad2deg(np.arctan2(sines, cosines[[0, 1], pairs]))


def wander(rng, n, rate, deviation_deg, memory=0.4, width=3):
    """Return an Ornstein-Uhlenbeck process, (n, width) rad: noise that soft tissue makes."""
    keep = np.exp(-1 / (rate * memory))
    kicks = rng.normal(size=(n, width)) * np.sqrt(1 - keep**2)
    kicks[0] = rng.normal(size=width)
    return np.deg2rad(deviation_deg) * lfilter([1.0], [1.0, -keep], kicks, axis=0)


def calibrate(
    rng,
    *,
    rate=50.0,
    seconds=36.0,
    between=70.0,
    cone=90.0,
    amplitudes=(45.0, 40.0),
    repetitions=3,
    sway=0.3,
    twist=0.0,
    independent=0.0,
    correlated=0.0,
):
    """Stand, then move about one axis, then about the other; all angles in deg.

    The limb at rest makes the angle ``cone`` with both axes, which are ``between`` apart. Noise:
    a standard deviation per rotation axis and frame, independent or correlated over 0.4 s.
    """
    n = round(rate * seconds)
    t = np.arange(n) / rate
    half, slope = np.deg2rad(between) / 2, np.cos(np.deg2rad(cone))
    axes = np.array([[np.sin(half), np.cos(half), 0], [-np.sin(half), np.cos(half), 0]])
    up = slope / np.cos(half)
    direction = np.array([0, up, np.sqrt(1 - up**2)])
    angles = wander(rng, n, rate, sway)
    if twist:
        angles[:, 2] += wander(rng, n, rate, twist, width=1)[:, 0]
    moving = np.zeros(n, dtype=bool)
    for i, start in enumerate(np.linspace(2, seconds - 4, 2 * repetitions)):
        during = (t >= start) & (t < start + 2)
        axis = int(i >= repetitions)
        reach = np.deg2rad(amplitudes[axis]) * rng.uniform(0.85, 1.15)
        angles[during, axis] += reach * np.sin(np.pi * (t[during] - start))
        moving |= during
    frame = Rotation.random(rng=rng)
    long_axis = Rotation.random(rng=rng).apply([1, 0, 0])
    turn = Rotation.random(rng=rng)  # about anything: then swung so that the limb points right
    swing, _ = Rotation.align_vectors([direction], [turn.apply(long_axis)])
    rest = swing * turn
    pose = rest
    for axis, angle in (
        (direction, angles[:, 2]),
        (axes[0], angles[:, 0]),
        (axes[1], angles[:, 1]),
    ):
        pose = Rotation.from_rotvec(angle[:, None] * axis) * pose
    pose = frame * pose
    if independent:
        pose = Rotation.from_rotvec(np.deg2rad(independent) * rng.normal(size=(n, 3))) * pose
    if correlated:
        pose = Rotation.from_rotvec(wander(rng, n, rate, correlated)) * pose
    return TrueJoint(
        pose.as_matrix(),
        long_axis,
        frame.apply(axes),
        (frame * rest).as_matrix(),
        angles,
        moving,
        rate,
    )


@pytest.fixture
def calibration():
    """Return the generator of a calibration with known truth."""
    return calibrate


@pytest.fixture
def skin():
    """Return the generator of correlated noise."""
    return wander
