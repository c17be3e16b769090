"""How much free motion without rhythm holds for somebody who knows what its noise is like."""

from functools import partial

import numpy as np
from scipy.linalg import cho_factor, cho_solve
from scipy.optimize import minimize

from benchmarks.axes.estimators import SEEDS
from benchmarks.axes.free_motion import MOTIONS, make
from benchmarks.axes.generator import BAND, MEMORY, NOISES, RATE, Array, TrueJoint
from benchmarks.axes.held import NOISE
from benchmarks.axes.measures import line_angles
from kinesphere.geometry.rotations import tangent_basis
from kinesphere.parameterization.axes.joint_kernels import angles_and_loads

THINNED = 5  # every fifth frame: 10 Hz, where the band ends at 0.7 and errors keep 0.4 s
FLATTEST = 0.02  # least determinant of the angles' Jacobian
REACH = 0.02  # rad, deviation of a limb out of reach
FLOOR = 1e-8  # rad², of an angle: a band alone has no inverse
STEP = 2e-3  # rad, of second differences
TASKS = [
    (motion, 3000 + seed)
    for motion, free in MOTIONS.items()
    if not free.rhythm
    for seed in range(SEEDS)
]


def run(motion: str, seed: int) -> tuple[list[float], list[float]]:
    """Return the errors of both axes in deg, and the Cramér–Rao bounds of those.

    Each angle is Gaussian noise of a flat band whose edges and size are known, errors of poses are
    the generator's; axes alone are sought, from the truth. The likelihood is that of all frames'
    angles at once, as `kinesphere.parameterization.axes.processes` has it; the information is the
    observed one at the truth.
    """
    joint = make(motion, NOISE, seed)
    cost = partial(_cost, joint, _angles_covariance(joint), _moves(joint))
    known = np.linalg.inv(_curvature(cost))
    options = {"hess_inv0": (known + known.T) / 2, "eps": 1e-5, "gtol": 0.5, "maxiter": 12}
    found = minimize(cost, np.zeros(4), method="BFGS", options=options)
    axes = _moved(joint, found.x)
    spread = np.sqrt(np.diag(known).reshape(2, 2).sum(axis=1))
    errors = [float(line_angles(a, b)) for a, b in zip(axes, joint.axes, strict=True)]
    return errors, [float(bound) for bound in np.rad2deg(spread)]


def _moves(joint: TrueJoint) -> Array:
    """Return by how much each frame's time differs from each other's, (n, n) s."""
    times = np.arange(len(joint.rotations[::THINNED])) * THINNED / RATE
    return np.abs(times[:, None] - times)


def _angles_covariance(joint: TrueJoint) -> Array:
    """Return the covariance of each angle over time, (3, n, n) rad²."""
    apart = _moves(joint)
    low, high = BAND
    shape = (high * np.sinc(2 * high * apart) - low * np.sinc(2 * low * apart)) / (high - low)
    return np.asarray(joint.angles.var(axis=0)[:, None, None] * shape)


def _moved(joint: TrueJoint, by: Array) -> Array:
    """Return the true axes moved along their tangent planes, (4,) rad."""
    steps = [
        move @ tangent_basis(axis) for axis, move in zip(joint.axes, by.reshape(2, 2), strict=True)
    ]
    moved = joint.axes + np.stack(steps)
    return np.asarray(moved / np.linalg.norm(moved, axis=1)[:, None])


def _cost(joint: TrueJoint, own: Array, apart: Array, by: Array) -> float:
    """Return the negative logarithm of the likelihood of moved axes, less a constant."""
    axes = _moved(joint, by)
    angles, loads, excess, unit = angles_and_loads(
        joint.rotations[::THINNED], axes[0], axes[1], joint.rest, joint.long_axis, FLATTEST
    )
    n = len(angles)
    error = np.deg2rad(NOISES[NOISE].correlated) ** 2 * np.exp(-apart / MEMORY)
    covariance = np.einsum("aki,bli,ab->akbl", loads, loads, error, optimize=True)
    for k in range(3):
        covariance[:, k, :, k] += own[k]
    whole = covariance.reshape(3 * n, 3 * n) + FLOOR * np.eye(3 * n)
    factor = cho_factor(whole, lower=True, overwrite_a=True, check_finite=False)
    seen = angles.ravel()
    told = 0.5 * seen @ cho_solve(factor, seen) + np.log(np.diag(factor[0])).sum()
    return float(told + unit + 0.5 * ((excess / REACH) ** 2).sum())


def _curvature(cost: partial[float]) -> Array:
    """Return the second differences of the cost at the truth, (4, 4)."""
    steps = STEP * np.eye(4)
    middle = cost(np.zeros(4))
    ahead, behind = (np.array([cost(sign * step) for step in steps]) for sign in (1, -1))
    bent = np.diag(ahead + behind - 2 * middle)
    for i in range(4):
        for j in range(i):
            both = cost(steps[i] + steps[j]) + cost(-steps[i] - steps[j])
            bent[i, j] = bent[j, i] = (
                both - ahead[[i, j]].sum() - behind[[i, j]].sum() + 2 * middle
            ) / 2
    return np.asarray(bent / STEP**2)
