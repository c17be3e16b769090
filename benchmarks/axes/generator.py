"""One joint whose axes, angles and rest are known, and what noise is put on it."""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.signal import lfilter
from scipy.spatial.transform import Rotation

from kinesphere.data import Joint, Limb, Motion, PoseFlag, Skeleton
from kinesphere.geometry.rotations import rotation_about

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]

RATE = 50.0  # Hz
LENGTH = 0.3  # m, of the limb; its mid point is half of it away from the joint
SWAY = 0.3  # deg, of somebody who stands
AMPLITUDES = (45.0, 40.0)  # deg to both sides
JITTER = 0.15  # of an amplitude, from one repetition to the next
BAND = (0.15, 0.7)  # Hz, of free motion
MEMORY = 0.4  # s, of correlated noise
LAG = 0.06  # s, of soft tissue
LEAST_OPENING = np.sin(np.deg2rad(30.0))  # of the resting limb to the plane of its axes


@dataclass(frozen=True)
class Noise:
    """What is put on the joint's rotation, deg standard deviation about each axis."""

    independent: float = 0.0
    correlated: float = 0.0
    tissue: float = 0.0
    """Share of the angle that comes back as a rotation about a random axis, 60 ms late."""
    glitches: float = 0.0
    """Share of the frames that are turned by up to 60° about anything."""


NOISES: Mapping[str, Noise] = {
    "clean": Noise(),
    "iid 1°": Noise(independent=1.0),
    "iid 3°": Noise(independent=3.0),
    "OU 1°": Noise(correlated=1.0),
    "OU 3°": Noise(correlated=3.0),
    "tissue": Noise(correlated=1.0, tissue=0.1),
}


@dataclass(frozen=True)
class Cones:
    """How a limb at rest and its axes lie to each other, deg."""

    between: tuple[float, float]
    """Range of the angle between the two axes."""
    cone: tuple[float, float]
    """Range of the angle between the limb and each axis."""


CONES: Mapping[str, Cones] = {
    "90°": Cones((70.0, 70.0), (90.0, 90.0)),
    "75°": Cones((70.0, 70.0), (75.0, 75.0)),
    "60–120°": Cones((70.0, 110.0), (60.0, 120.0)),
}


@dataclass(frozen=True, eq=False)
class TrueJoint:
    """A joint seen from its parent, and the truth about it."""

    rotations: Array
    """(n_frames, 3, 3) ``parent_from_child``, noise included."""
    long_axis: Array
    """(3,) in the child."""
    axes: Array
    """(2, 3) in the parent, distal first."""
    rest: Array
    """(3, 3)"""
    angles: Array
    """(n_frames, 3) rad about both axes, then twist."""
    about: Mask
    """(n_frames, 2) True while the limb moves about that axis on purpose."""

    @property
    def moving(self) -> Mask:
        """(n_frames,) True while the limb moves on purpose."""
        return np.asarray(self.about.any(axis=1))

    @property
    def clean(self) -> "TrueJoint":
        """The same joint without noise."""
        return replace(self, rotations=poses(self.axes, self.rest, self.long_axis, self.angles))

    @property
    def skeleton(self) -> Skeleton:
        """Two limbs and the joint between, true axes and rest included."""
        nothing: dict[str, Any] = {
            "markers": (),
            "marker_positions": np.empty((0, 3)),
            "length": LENGTH,
        }
        along = self.long_axis
        limbs = (
            Limb(name="base", parent=None, long_axis=np.array([0.0, 1.0, 0.0]), **nothing),
            Limb(name="limb_01", parent="base", long_axis=along, **nothing),
        )
        joint = Joint(
            name="joint_01",
            parent="base",
            child="limb_01",
            centre_in_parent=np.zeros(3),
            centre_in_child=-LENGTH / 2 * along,
            residual=0.0,
            range_of_motion=np.nan,
            covariance=np.zeros((3, 3)),
            observability="given",
            axes=self.axes,
            rest=self.rest,
            axes_source="given",
        )
        return Skeleton(limbs, (joint,))

    @property
    def motion(self) -> Motion:
        """The joint as a motion of two limbs whose parent stays still."""
        n = len(self.rotations)
        rotations = np.tile(np.eye(3), (n, 2, 1, 1))
        rotations[:, 1] = self.rotations
        origins = np.zeros((n, 2, 3))
        origins[:, 1] = LENGTH / 2 * self.rotations @ self.long_axis
        return Motion(
            skeleton=self.skeleton,
            rotations=rotations,
            origins=origins,
            residuals=np.zeros((n, 2)),
            flags=np.full((n, 2), PoseFlag.MEASURED, dtype=np.uint8),
            rate=RATE,
        )


def make_calibration(
    rng: np.random.Generator, cones: Cones, noise: Noise, *, seconds: float = 60.0
) -> TrueJoint:
    """Stand, then move four times 2 s about the first axis, then about the second.

    Every repetition goes ±45° about the first axis, ±40° about the second; between them the limb
    sways by 0.3°.
    """
    n = round(RATE * seconds)
    t = np.arange(n) / RATE
    angles = np.column_stack([np.deg2rad(SWAY) * wander(rng, n, 2), np.zeros(n)])
    about = np.zeros((n, 2), dtype=bool)
    for i, start in enumerate(np.linspace(2, seconds - 4, 8)):
        during = (t >= start) & (t < start + 2)
        axis = i // 4
        reach = np.deg2rad(AMPLITUDES[axis]) * rng.uniform(1 - JITTER, 1 + JITTER)
        angles[during, axis] += reach * np.sin(np.pi * (t[during] - start))
        about[during, axis] = True
    return joint_of(rng, cones, noise, angles, about)


def make_free_motion(
    rng: np.random.Generator,
    cones: Cones,
    noise: Noise,
    *,
    amplitudes: tuple[float, float] = AMPLITUDES,
    twist: float = 0.0,
    seconds: float = 20.0,
    rhythm: bool = True,
) -> TrueJoint:
    """Move about both axes at once, and twist by up to ``twist`` deg."""
    n = round(RATE * seconds)
    play = swing if rhythm else drift
    angles = np.column_stack([np.deg2rad(reach) * play(rng, n) for reach in (*amplitudes, twist)])
    return joint_of(rng, cones, noise, angles)


def poses(axes: Array, rest: Array, long_axis: Array, angles: Array) -> Array:
    """Return ``R(a2, θ2) R(a1, θ1) R(rest · long_axis, τ) rest``, (n, 3) rad → (n, 3, 3)."""
    turned: Array = (
        rotation_about(axes[1], angles[:, 1])
        @ rotation_about(axes[0], angles[:, 0])
        @ rotation_about(rest @ long_axis, angles[:, 2])
        @ rest
    )
    return turned


def wander(rng: np.random.Generator, n: int, width: int, memory: float = MEMORY) -> Array:
    """Return an Ornstein–Uhlenbeck process of deviation 1 and so many s memory, (n, width)."""
    keep = np.exp(-1 / (RATE * memory))
    kicks = rng.normal(size=(n, width)) * np.sqrt(1 - keep**2)
    kicks[0] = rng.normal(size=width)
    return np.asarray(lfilter([1.0], [1.0, -keep], kicks, axis=0))


def swing(rng: np.random.Generator, n: int) -> Array:
    """Return a smooth play of three frequencies between 0.15 and 0.7 Hz that reaches ±1, (n,)."""
    t = np.arange(n) / RATE
    frequencies, phases = draw_rhythm(rng)
    play = np.sin(2 * np.pi * np.outer(t, frequencies) + phases).sum(axis=1)
    return np.asarray(play / np.abs(play).max())


def draw_rhythm(rng: np.random.Generator) -> tuple[Array, Array]:
    """Draw three frequencies, Hz, and three phases, rad."""
    return rng.uniform(*BAND, 3), rng.uniform(0, 2 * np.pi, 3)


def drift(rng: np.random.Generator, n: int) -> Array:
    """Return noise of the same frequencies that reaches ±1, (n,): no rhythm, nothing returns."""
    whole = 4 * n  # ends need not meet
    frequencies = np.fft.rfftfreq(whole, 1 / RATE)
    waves = rng.normal(size=(len(frequencies), 2)) @ [1, 1j]
    inside = (frequencies > BAND[0]) & (frequencies < BAND[1])
    play = np.fft.irfft(waves * inside, whole)[:n]
    return np.asarray(play / np.abs(play).max())


def draw_axes(rng: np.random.Generator, cones: Cones) -> tuple[Array, Array]:
    """Draw two axes, (2, 3), and the direction of a limb, (3,), that lie as ``cones`` says.

    Triples that do not exist, and limbs at rest within 30° of the plane of their axes, where the
    angles are ill-conditioned from the start, are drawn again.
    """
    while True:
        between = np.deg2rad(rng.uniform(*cones.between))
        c1, c2 = np.cos(np.deg2rad(rng.uniform(*cones.cone, size=2)))
        k = np.cos(between)
        alpha, beta = (c1 - k * c2) / (1 - k * k), (c2 - k * c1) / (1 - k * k)
        height = 1 - alpha**2 - beta**2 - 2 * alpha * beta * k
        if height >= LEAST_OPENING**2:
            break
    axes = np.array([[1.0, 0.0, 0.0], [k, np.sin(between), 0.0]])
    direction = alpha * axes[0] + beta * axes[1] + np.sqrt(height) * np.array([0.0, 0.0, 1.0])
    turn = Rotation.random(rng=rng).as_matrix()
    return axes @ turn.T, turn @ direction


def joint_of(
    rng: np.random.Generator, cones: Cones, noise: Noise, angles: Array, about: Mask | None = None
) -> TrueJoint:
    """Return a joint with axes of its own that moves by some angles, (n, 3) rad, noise put on it.

    Without ``about``, (n, 2), it moves on purpose about both axes all the time.
    """
    if about is None:
        about = np.ones((len(angles), 2), dtype=bool)
    axes, direction = draw_axes(rng, cones)
    rest = np.eye(3)  # normalized frames: the limb is aligned with its parent at rest
    long_axis = direction
    spoiled = spoil(rng, poses(axes, rest, long_axis, angles), angles, noise)
    return TrueJoint(spoiled, long_axis, axes, rest, angles, about)


def spoil(rng: np.random.Generator, rotations: Array, angles: Array, noise: Noise) -> Array:
    """Put noise on rotations, (n, 3, 3); ``angles`` drive the soft tissue."""
    n = len(rotations)
    vectors = np.deg2rad(noise.independent) * rng.normal(size=(n, 3))
    vectors += np.deg2rad(noise.correlated) * wander(rng, n, 3)
    axis = rng.normal(size=3)
    late = np.roll(angles[:, :2].sum(axis=1), round(LAG * RATE))
    vectors += noise.tissue * late[:, None] * axis / np.linalg.norm(axis)
    jumps = rng.random(n) < noise.glitches
    vectors[jumps] += rng.normal(size=(int(jumps.sum()), 3)) * np.deg2rad(60.0) / np.sqrt(3.0)
    return np.asarray(Rotation.from_rotvec(vectors).as_matrix() @ rotations)
