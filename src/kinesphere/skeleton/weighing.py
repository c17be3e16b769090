"""A joint's centre by its motion and by anatomy, each as sure as it is.

A fit weighs looks as careful as skin asks for, and an expectation in the same scale would count for
more than it knows: where hips move well, one of 9 mm made centres a fifth worse. So the motion
tells its centre by itself, held loosely, and by what is told of both the two are weighed.
"""

from dataclasses import replace

import numpy as np

from kinesphere.data import Array
from kinesphere.geometry.centres import CentreFit

LOOSELY = 6.0
"""Times its spread to which an expectation holds the fit that it will be weighed with: it counts
once, and a joint that hardly moves does not run away meanwhile."""
UNLIKE = 3.0
"""Times its spread that it may be off somebody who is said to be unlike other people."""


def weighed(fit: CentreFit, expected: Array, spread: float) -> CentreFit:
    """Return the likeliest centre by the motion and an expectation, by normal regression.

    Parameters
    ----------
    fit
        By the motion, held by the expectation `LOOSELY` if at all. What the motion alone knows
        stays as it is, and so does the verdict on it.
    expected : (3,) m
    spread
        m, standard deviation of the true centre about it in each direction.
    """
    sure = spread**2 * np.eye(3)
    both = fit.data_covariance + sure
    off = expected - fit.centre
    covariance = sure - sure @ np.linalg.solve(both, sure)
    return replace(
        fit,
        # from the expectation backwards: where motion is silent its variance is beyond measure
        centre=expected - sure @ np.linalg.solve(both, off),
        covariance=(covariance + covariance.T) / 2,
    )
