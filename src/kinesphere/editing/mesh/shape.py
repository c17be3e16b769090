"""How tall, broad and long-limbed a body is: the shape whose joints lie as the skeleton's do."""

from collections.abc import Callable
from dataclasses import replace

import numpy as np
from scipy.optimize import least_squares

from kinesphere.data import Array, Surface

SPREAD = {"height": 0.4, "proportions": 0.5}
"""Steps that people differ by, about: what is likely where little is measured. Lengths of bones
tell nothing of weight and muscle; centres of hips and shoulders are too unsure to tell the sex."""
_MEASURED = 0.015  # m; centres of joints on skin markers are no better
_SPANS = (
    ("upper_arm", "forearm"),
    ("forearm", "hand"),
    ("thigh", "shank"),
    ("shank", "foot"),
)


def fit_shape(body: Surface, begins: Array) -> dict[str, float]:
    """Return the steps along the body's shapes that best give the distances between joints.

    Parameters
    ----------
    body
        With the skeleton's limbs.
    begins : (n_limbs, 3) m
        Where the skeleton's limbs begin, in the default position; NaN where unknown.
    """
    names = [name for name in SPREAD if name in body.shapes]
    wanted = _distances(body, begins)
    known = np.isfinite(wanted)
    if not names or not known.any():
        return {}
    at = [body.shapes.index(name) for name in names]
    spread = np.array([SPREAD[name] for name in names])

    def residuals(steps: Array) -> Array:
        centres = body.joint_centres + np.tensordot(steps, body.shape_joint_centres[at], 1)
        off = (_distances(body, centres) - wanted)[known] / _MEASURED
        return np.concatenate([off, steps / spread])

    found = least_squares(residuals, np.zeros(len(at)))
    return dict(zip(names, map(float, found.x), strict=True))


def as_large_as(body: Surface, begins: Array) -> Surface:
    """Return a body without shapes in the size whose distances between joints suit best.

    Parameters
    ----------
    body, begins
        As of `fit_shape`.
    """
    ratios = _distances(body, begins) / np.maximum(_distances(body, body.joint_centres), 1e-9)
    if not np.isfinite(ratios).any():
        return body
    size = float(np.nanmedian(ratios))
    return replace(
        body,
        vertices=body.vertices * size,
        joint_centres=body.joint_centres * size,
        ends=body.ends * size,
    )


def _distances(body: Surface, begins: Array) -> Array:
    """Return lengths of limbs, widths between left and right, and the height of the trunk."""

    def place(name: str) -> Array:
        return begins[body.limbs.index(name)] if name in body.limbs else np.full(3, np.nan)

    def apart(one: str, other: str) -> float:
        return float(np.linalg.norm(place(one) - place(other)))

    def middle(of: Callable[[str], str]) -> Array:
        return np.asarray((place(of("left")) + place(of("right"))) / 2)

    shoulders = middle("{}_upper_arm".format)
    hips = middle("{}_thigh".format)
    return np.array(
        [apart(f"{side}_{a}", f"{side}_{b}") for side in ("left", "right") for a, b in _SPANS]
        + [apart(f"left_{limb}", f"right_{limb}") for limb in ("upper_arm", "thigh")]
        + [float(np.linalg.norm(shoulders - hips))]
    )
