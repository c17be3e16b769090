"""Limbs, joints and weights of a mesh that has none."""

from dataclasses import replace

import numpy as np
from scipy.spatial import KDTree

from kinesphere.data import Array, Step, Surface, bundled_body
from kinesphere.editing.mesh.rigging.puppet import Puppet
from kinesphere.editing.mesh.rigging.starts import ARMS, Fit, fit_from, pose_of
from kinesphere.editing.mesh.rigging.transfer import at_most_four, transferred
from kinesphere.editing.mesh.rigging.units import unit_of
from kinesphere.editing.mesh.rigging.upright import name_of_axis, ways_to_stand
from kinesphere.editing.mesh.settings import SurfaceSettings
from kinesphere.errors import BadSurface
from kinesphere.geometry.samples import surface_samples

_SAMPLES = 6000
_NEAR = 0.05  # m, of a body of 1.66 m
_COVERED = 0.8
"""Share of either surface that must lie near the other. People: over 0.99; a capsule: 0.69."""
_PLAIN = 1.15  # how much worse every other way to stand must fit; people: 2 and more
_SMOOTHING = 2  # rounds


def rigged(mesh: Surface, settings: SurfaceSettings | None = None) -> Surface:
    """Return a mesh with the bundled body's limbs, their joints, and weights.

    The bundled body is laid onto the mesh, posed and proportioned (`fit_from`), and what it knows
    is carried over.

    Parameters
    ----------
    mesh
        A person alone, near standing, arms anywhere between T-pose and hanging; in any unit.
    settings
        What is known of how it stands.

    Returns
    -------
    Surface
        In m, y up, looking along x.

    Raises
    ------
    BadSurface
        If it is no person in such a pose, or nothing tells which way it looks.
    """
    settings = settings or SurfaceSettings()
    points, normals, _ = surface_samples(mesh.vertices, mesh.faces, _SAMPLES)
    ways = ways_to_stand(points, normals, settings.up, settings.facing)
    puppet = Puppet(bundled_body())
    poses = tuple(ARMS) if settings.pose == "auto" else (settings.pose,)
    fit, plain = fit_from(puppet, points, normals, ways, poses)
    mine, whole, off = _covered(puppet, fit, points, normals)
    if min(mine, whole) < _COVERED:
        raise BadSurface(
            f"the mesh is no person standing alone that could be told: {mine:.0%} of it lie on a "
            f"body, and {whole:.0%} of a body on it ({_COVERED:.0%} are needed); arms must be out, "
            "half down or down; surface.up, surface.facing and surface.pose state what is known"
        )
    if plain < _PLAIN:
        raise BadSurface(
            "the mesh looks nearly the same from front and behind, or upside down; state "
            "surface.facing and surface.up, such as +z and +y"
        )
    return _carried_over(mesh, puppet, fit, off)


def _covered(puppet: Puppet, fit: Fit, points: Array, normals: Array) -> tuple[float, float, float]:
    """Return which share of the mesh is near the body, of the body near the mesh, and how near.

    The last is the median distance across the surface, m.
    """
    target = points @ fit.body_from_mesh.T * fit.scale
    placed = puppet.vertices(fit.vector)
    there, _ = KDTree(placed).query(target)
    back, near = KDTree(target).query(placed)
    across = np.einsum("vi,vi->v", placed - target[near], normals[near] @ fit.body_from_mesh.T)
    shares = float(np.mean(there < _NEAR)), float(np.mean(back < _NEAR))
    return *shares, float(np.median(np.abs(across)))


def _carried_over(mesh: Surface, puppet: Puppet, fit: Fit, off: float) -> Surface:
    body = puppet.body
    vertices = mesh.vertices @ fit.body_from_mesh.T * fit.scale
    placed = puppet.vertices(fit.vector)
    given = replace(mesh, vertices=vertices)
    weights = transferred(vertices, given.normals(), placed, body.normals(placed), body.weights)
    matrices, shifts, centres = puppet.maps(fit.vector[None])
    shaped = body.shaped(dict(zip(body.shapes, fit.vector[puppet.parts["shapes"]], strict=True)))
    ends = (matrices[0] @ shaped.ends[:, :, None])[..., 0] + shifts[0]
    unit, metres = unit_of(float(np.ptp(vertices[:, 1])) / fit.scale)
    ground = np.array([0.0, vertices[:, 1].min(), 0.0])
    size = metres / fit.scale
    step = Step(
        "rigging",
        {},
        {
            "up": name_of_axis(fit.body_from_mesh[1]),
            "facing": name_of_axis(fit.body_from_mesh[0]),
            "unit": unit,
            "pose": pose_of(body.limbs, ends - centres[0], np.array([0.0, 1.0, 0.0])),
            "weights": "found",
            "off_mm": round(1e3 * off * size, 1),
        },
    )
    return Surface(
        vertices=(vertices - ground) * size,
        faces=mesh.faces,
        limbs=body.limbs,
        parents=body.parents,
        joint_centres=(centres[0] - ground) * size,
        ends=(ends - ground) * size,
        weights=at_most_four(weights, mesh.faces, _SMOOTHING),
        history=(*mesh.history, step),
    )
