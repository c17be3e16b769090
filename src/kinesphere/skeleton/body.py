"""A limb while it is being measured: its points in its own frame, and its pose in some frames."""

from dataclasses import dataclass, field

import numpy as np

from kinesphere.data import Array
from kinesphere.geometry.pose_errors import pose_covariance
from kinesphere.geometry.rigid import RigidFit, fit_rigid, fit_shape, into_frame, left_by_fit
from kinesphere.geometry.vectors import lengths

NOISE = 0.001
"""m, least noise a point's weight reckons with: no three points take the whole fit."""

STEADY = 0.05
"""Change of a point's noise, as a share of it, below which its weight is settled."""


@dataclass
class Body:
    """A limb's markers, joint centre and axes in its own provisional frame."""

    name: str
    parent: str | None
    labels: tuple[str, ...]
    shape: Array
    """(n_markers, 3) m."""
    noise: Array
    """(n_markers,) m, rms distance of each marker from where the poses put it."""
    centre: Array | None = None
    """(3,) m, the joint towards the parent."""
    centre_noise: float = 0.0
    """m, rms disagreement of parent and child about that joint."""
    rotations: Array = field(default_factory=lambda: np.empty((0, 3, 3)))
    """(n_sample, 3, 3) ``world_from_limb`` in the sampled frames; NaN where unknown."""
    shifts: Array = field(default_factory=lambda: np.empty((0, 3)))
    """(n_sample, 3) m."""
    rest: Array = field(default_factory=lambda: np.eye(3))
    """(3, 3) usual ``parent_from_child``."""
    right: Array | None = None
    """(3,) unit vector towards the body's right, seen from the limb."""
    up: Array | None = None
    """(3,) unit vector, the body's up or the limb's proximal direction, seen from the limb."""
    own_pose: bool = False
    """True where its markers alone tell its pose."""
    linked: bool = False
    """True where limbs on either side were fitted along with it, and tell its pose."""
    twist_open: bool = False
    """True where markers and joint lie on one line: nothing of the limb's own tells its twist."""
    borrow: Array | None = None
    """(3,) unit vector in the limb, the normal of the plane it makes with the next limb; only where
    the twist is open and the joint between them bends."""

    @property
    def points(self) -> Array:
        """(n, 3) m, markers and, if there is one, the joint centre as the last."""
        return self.shape if self.centre is None else np.vstack([self.shape, self.centre])

    @property
    def weights(self) -> Array:
        """(n,) 1/m², how much each of `points` counts for the pose."""
        noise = self.noise if self.centre is None else np.append(self.noise, self.centre_noise)
        weights: Array = 1 / (noise**2 + NOISE**2)
        return weights

    @property
    def pose_covariance(self) -> Array:
        """(6, 6) uncertainty of the limb's pose, rad and m, from the noise of its points."""
        return pose_covariance(self.points, 1 / np.sqrt(self.weights))


def measure_shape(
    points: Array, outlier: float, min_spread: float, noise: Array | None = None
) -> tuple[Array, Array, RigidFit] | None:
    """Return a limb's shape, the noise of each point, and its pose, from points in the world.

    Points that wander (an acromion on the trunk) lose weight by their own residual.

    Parameters
    ----------
    points : (n_frames, n_points, 3) m
    outlier, min_spread
        m, as `kinesphere.geometry.rigid.fit_shape` takes them.
    noise : (n_points,) m, optional
        Of each point, in each direction, where it is known; found from the residuals otherwise.

    Returns
    -------
    shape : (n_points, 3) m
    noise : (n_points,) m
    fit : RigidFit
        Or None instead of all three where no frame shows a shape.
    """
    n = points.shape[1]
    known = np.zeros(n) if noise is None else noise
    shape = None
    for _ in range(4 if noise is None else 1):
        weights = 1 / (known**2 + NOISE**2)
        shape = fit_shape(points, weights, outlier=outlier, min_spread=min_spread, start=shape)
        if shape is None or not np.isfinite(shape).all():
            return None
        fit = fit_rigid(shape, points, weights, min_spread=min_spread)
        residual = lengths(into_frame(fit.rotations, fit.shifts, points) - shape)
        if noise is None:
            last, known = known, robust_rms(residual) * left_by_fit(np.isfinite(residual))
            if (np.abs(known - last) < STEADY * np.hypot(known, NOISE)).all():
                break
    assert shape is not None  # every round has found one
    return shape, known, fit


def robust_rms(residuals: Array) -> Array:
    """Return the rms in each direction of lengths in space, (n, m) m → (m,) m.

    The longest 5 % are left out.
    """
    rms = np.zeros(residuals.shape[1])
    for i, column in enumerate(residuals.T):
        known = np.sort(column[np.isfinite(column)])
        if len(known):
            rms[i] = np.sqrt(np.mean(known[: max(1, int(0.95 * len(known) + 0.5))] ** 2) / 3)
    return rms
