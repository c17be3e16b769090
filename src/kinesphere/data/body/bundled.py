"""Load the bundled body: a neutral adult in A-pose, closed, mirror-symmetric."""

from functools import cache
from importlib.resources import files

import numpy as np

from kinesphere.data.history import Step
from kinesphere.data.surface import Surface

STEP = 2e-5
"""m, what one unit of the stored shape directions is."""


@cache
def bundled_body() -> Surface:
    """Return the bundled body: 15 limbs, 4001 vertices, 1.66 m tall, arms half hanging.

    Its ``shapes`` are ``height``, ``weight``, ``muscle``, ``sex`` (male at +1, female at −1) and
    ``proportions``; −1 and +1 stand near the extremes of adults, 0 is the mean.

    >>> bundled_body().shaped({"height": 0.3, "sex": 1.0}).limbs[:3]
    ('pelvis', 'trunk', 'head')

    References
    ----------
    MakeHuman's base mesh, targets, rig and weights, released as CC0; see ``LICENSE.md`` beside the
    file.
    """
    with files(__package__).joinpath("body.npz").open("rb") as file, np.load(file) as stored:
        limbs = tuple(str(name) for name in stored["limbs"])
        weights = np.zeros((len(stored["vertices"]), len(limbs)))
        rows = np.arange(len(weights))
        for limb, share in zip(stored["weight_limbs"].T, stored["weight_shares"].T, strict=True):
            weights[rows, limb] += share
        return Surface(
            vertices=stored["vertices"],
            faces=stored["faces"],
            limbs=limbs,
            parents=stored["parents"],
            joint_centres=stored["joint_centres"],
            ends=stored["ends"],
            weights=weights / 255,
            shapes=tuple(str(name) for name in stored["shapes"]),
            shape_vertices=stored["shape_vertices"] * STEP,
            shape_joint_centres=stored["shape_joint_centres"] * STEP,
            shape_ends=stored["shape_ends"] * STEP,
            history=(Step("read", {"source": "the bundled body"}),),
        )
