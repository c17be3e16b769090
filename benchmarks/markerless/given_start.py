"""A first pose that is known but for a little: where an automatic start is not what is measured."""

from dataclasses import replace

import numpy as np
from scipy.spatial.transform import Rotation

from kinesphere.data import Surface
from kinesphere.geometry.rotations import rotation_log
from kinesphere.markerless.anatomy import full_body
from kinesphere.markerless.first_pose import FirstPose
from kinesphere.markerless.pose import Pose, bind_pose, limited, posed
from kinesphere.markerless.shape import FACTORS
from kinesphere.synthetic.film import Film

TURN, SHIFT = np.radians(2.0), 0.008
"""rad and m, by which every joint and the pelvis of a given start are off (standard deviation)."""


def disturbed_start(film: Film, surface: Surface, seed: int) -> FirstPose:
    """Return the film's first pose on the unfitted body, disturbed by ``TURN`` and ``SHIFT``."""
    rng = np.random.default_rng([seed, 5])
    chain = full_body(surface).chain
    truth = film.motion
    at = {name: i for i, name in enumerate(truth.surface.limbs)}
    out = bind_pose(chain)
    balls, angles = out.balls.copy(), out.angles.copy()
    for i, link in enumerate(chain.links):
        if link.name not in at:
            continue
        now = posed(chain, replace(out, balls=balls, angles=angles))
        parent = chain.parents[i]
        above = now.rotations[parent] if parent >= 0 else np.eye(3)
        off = Rotation.from_rotvec(rng.normal(scale=TURN, size=3)).as_matrix()
        wanted = above.T @ truth.turns[0, at[link.name]] @ off
        if link.kind == "axes":
            dofs = np.flatnonzero(chain.dof_limbs == i)
            angles[dofs] = link.axes @ rotation_log(wanted)
        else:
            balls[i] = wanted
    position = truth.root[0] + rng.normal(scale=SHIFT, size=3)
    pose = limited(chain, Pose(position, balls, angles))
    return FirstPose(pose, np.zeros(len(FACTORS)), float("nan"), "given")
