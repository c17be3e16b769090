"""A surface bound to the normalized skeleton in its default position."""

from dataclasses import replace

import numpy as np

from kinesphere.data import Array, Motion, Step, Surface, bundled_body, settings_as_json
from kinesphere.editing.mesh.girths import fit_girths
from kinesphere.editing.mesh.merging import on_limbs_of
from kinesphere.editing.mesh.proportions import begins_of, fit_limbs
from kinesphere.editing.mesh.rigging import rigged, righted
from kinesphere.editing.mesh.settings import SurfaceSettings
from kinesphere.editing.mesh.shape import as_large_as, fit_shape
from kinesphere.editing.mesh.standing import ankle_heights, ups_while_standing
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
        The bundled one by default; or any that stands, arms anywhere between out and hanging, as
        `read` gives it. One without limbs of its own gets them first (`rigged`).
    settings

    Raises
    ------
    BadSurface
        If the skeleton's limbs are not known by name, or the mesh is no person.
    """
    settings = settings or SurfaceSettings()
    skeleton = motion.skeleton
    body = bundled_body() if body is None else prepared_surface(body, settings)
    body = on_limbs_of(body, skeleton)
    steps = fit_shape(body, begins_of(skeleton))
    body = body.shaped(steps) if steps else as_large_as(body, begins_of(skeleton))
    maps = fit_limbs(body, skeleton, ups_while_standing(motion), ankle_heights(motion))
    if settings.fit_girths:
        maps = fit_girths(body, skeleton, maps, settings.marker_height / 1e3)
    matrices, shifts = maps.matrices()
    finer = max(1.0, body.n_vertices / bundled_body().n_vertices)  # rounds reach as far, in m
    for rounds in _SOFTENING:
        vertices = _carried_softly(body, matrices, shifts, round(rounds * finer))
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
            "tall_m": round(float(np.ptp(vertices[:, 1])), 3),
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


def prepared_surface(body: Surface, settings: SurfaceSettings) -> Surface:
    """Return a body that stands as ours does, with limbs; as it is where it does already."""
    if body.shapes or any(step.name == "rigging" for step in body.history):
        return body
    return righted(body, settings) if body.has_limbs else rigged(body, settings)


def _carried_softly(body: Surface, matrices: Array, shifts: Array, rounds: int) -> Array:
    weights = softened(body.weights, body.faces, rounds)
    moved = np.einsum("vl,lij,vj->vi", weights, matrices, body.vertices, optimize=True)
    return np.asarray(moved + weights @ shifts)


def _carried(matrices: Array, shifts: Array, points: Array) -> Array:
    moved: Array = np.einsum("lij,lj->li", matrices, points) + shifts
    return moved
