"""A surface bound to the normalized skeleton in its default position."""

from dataclasses import replace

import numpy as np

from kinesphere.data import Array, Motion, Step, Surface, bundled_body, settings_as_json
from kinesphere.editing.mesh.girths import fit_girths
from kinesphere.editing.mesh.merging import on_limbs_of
from kinesphere.editing.mesh.proportions import begins_of, fit_limbs
from kinesphere.editing.mesh.settings import SurfaceSettings
from kinesphere.editing.mesh.shape import fit_shape
from kinesphere.editing.mesh.standing import ups_while_standing
from kinesphere.editing.mesh.untangle import inverted_faces, softened, untangled

_SOFTENING = (16, 64, 256)
"""Rounds of softening, until no triangle is turned over: the first do for most people."""


def attach_surface(
    motion: Motion, body: Surface | None = None, settings: SurfaceSettings | None = None
) -> Surface:
    """Return a body's surface, fitted to a skeleton and bound to it in its default position.

    Shape first: height and proportions whose joints lie as the skeleton's do. Then every limb is
    turned, stretched and widened onto its own (`fit_limbs`, `fit_girths`), and the vertices follow
    by their weights. The person of figure 5 in Sar Dessai et al. 2006, without hand work.

    Parameters
    ----------
    motion
        Normalized; its standing feet tell how shoes lie in their frames.
    body
        In any pose near standing, arms to the sides; the bundled one by default.
    settings

    Raises
    ------
    BadSurface
        If the skeleton's limbs are not known by name.
    """
    settings = settings or SurfaceSettings()
    skeleton = motion.skeleton
    body = on_limbs_of(bundled_body() if body is None else body, skeleton)
    steps = fit_shape(body, begins_of(skeleton))
    body = body.shaped(steps)
    maps = fit_limbs(body, skeleton, ups_while_standing(motion))
    if settings.fit_girths:
        maps = fit_girths(body, skeleton, maps, settings.marker_height / 1e3)
    matrices, shifts = maps.matrices()
    for rounds in _SOFTENING:
        vertices = _carried_softly(body, matrices, shifts, rounds)
        vertices = untangled(vertices, body.faces, body.weights, body.vertices, maps.turns)
        turned = inverted_faces(vertices, body.faces, body.weights, body.vertices, maps.turns)
        if not turned.any():
            break
    step = Step(
        "surface",
        settings_as_json(settings),
        {
            "shape": dict(steps),
            "thickness": {
                name: [round(float(s), 3) for s in scale]
                for name, scale in zip(body.limbs, maps.scales, strict=True)
            },
            "inverted_triangles": int(turned.sum()),
        },
    )
    return replace(
        body,
        vertices=vertices,
        joint_centres=begins_of(skeleton),
        ends=_carried(matrices, shifts, body.ends),
        shapes=(),
        history=(*body.history, step),
    )


def _carried_softly(body: Surface, matrices: Array, shifts: Array, rounds: int) -> Array:
    weights = softened(body.weights, body.faces, rounds)
    moved = np.einsum("vl,lij,vj->vi", weights, matrices, body.vertices, optimize=True)
    return np.asarray(moved + weights @ shifts)


def _carried(matrices: Array, shifts: Array, points: Array) -> Array:
    moved: Array = np.einsum("lij,lj->li", matrices, points) + shifts
    return moved
