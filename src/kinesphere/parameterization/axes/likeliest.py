"""The axis that leaves least unexplained of a limb's motion."""

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from kinesphere.data import Array
from kinesphere.parameterization.axes.cone_and_twist import ConeAndTwist
from kinesphere.parameterization.axes.cone_kernels import equations

LARGEST_STEP = 0.2  # rad, of one iteration
SETTLED = 1e-6  # rad
FREEDOM = 10.0  # of the t distribution that errors are taken from: its tails forgive bad frames,
# and the sway about other axes, which is no outlier, still counts
TINY = 1e-9


class Likeliest(NamedTuple):
    """An axis, and what was found with it."""

    axis: Array
    """(3,)"""
    cost: float
    """Negative logarithm of its likelihood."""
    coupling: float = 0.0
    """rad of twist for a rad of the angle."""
    deviation: float = 0.0
    """Standard deviation of the coupling."""


@dataclass(frozen=True)
class Cone:
    """What is known about the opening of a cone that all phases share."""

    usual: float
    """rad."""
    deviation: float
    """rad."""


def likeliest_axis(
    errors: ConeAndTwist,
    start: Array,
    rounds: int,
    cone: Cone | None = None,
    freedom: float = FREEDOM,
    coupling: float = 0.0,
) -> Likeliest:
    """Return the axis of which a limb's cone and twist are likeliest.

    Gauss-Newton steps, spreads and weights taken anew each time.

    Parameters
    ----------
    errors
        Of one axis.
    start : (3,)
        Within some 40° of the truth.
    rounds
        How many steps at most.
    cone
        That all phases lie on; None gives every phase its own.
    freedom
        Degrees of freedom of the t distributions: fewer, heavier tails.
    coupling
        Usual size (standard deviation) of the twist that goes with the angle, rad a rad, where the
        limb may twist in proportion to it; 0 where it may not.
    """
    axis = start / np.linalg.norm(start)
    share = errors.effective / len(errors.positions)
    scaled = np.stack([errors.weights, errors.weights])
    cost = np.inf
    coupled = deviation = 0.0
    n_columns = 4 if coupling else 3
    for _ in range(rounds):
        basis, columns, values, spreads, opening = equations(
            axis,
            errors.vectors_beside,
            errors.numbers_beside,
            errors.phase,
            errors.weights,
            scaled,
            share,
            freedom,
            cone is not None,
            coupled,
        )
        normal = (columns @ columns.T)[:n_columns, :n_columns]
        right = (columns @ values)[:n_columns]
        # what is known without any frame
        known = 0.0
        if cone is None:
            normal[2, 2] += 1.0
        else:
            normal[2, 2] += 1 / cone.deviation**2
            right[2] += (opening - cone.usual) / cone.deviation**2
            known += ((opening - cone.usual) / cone.deviation) ** 2
        if coupling:
            normal[3, 3] += 1 / coupling**2
            right[3] += coupled / coupling**2
            known += (coupled / coupling) ** 2
        cost = errors.effective * float(np.log(spreads).sum()) + 0.5 * known
        # phases of a frame or two leave directions open: those stay as they are
        step = -np.linalg.lstsq(normal, right, TINY)[0]
        if coupling:
            coupled += float(step[3])
            deviation = float(np.sqrt(np.linalg.pinv(normal, hermitian=True)[3, 3]))
        step = step[:2]
        size = float(np.linalg.norm(step))
        if size > LARGEST_STEP:
            step *= LARGEST_STEP / size
        axis = axis + step @ basis
        axis = axis / np.linalg.norm(axis)
        if size < SETTLED:
            break
    return Likeliest(np.asarray(axis), cost, coupled, deviation)
