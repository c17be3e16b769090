"""Measures of a bound surface: triangles turned over, cross-sections, distances to points."""

import numpy as np
from numpy.typing import NDArray

from kinesphere.data import Array, Surface, TwistJoints
from kinesphere.geometry.rotations import rotation_about
from kinesphere.geometry.skinning import dual_quaternion_blend, linear_blend

SECTIONS = 40
BLENDS = {"linear": linear_blend, "dual-quaternion": dual_quaternion_blend}
TWIST_JOINTS = "twist-joints"


def twisted_forearm(surface: Surface, side: str, degrees: float, blend: str) -> tuple[float, float]:
    """Return what is left of a forearm that is twisted about its long axis at the elbow.

    Returns
    -------
    volume, section
        Both over that without twist: the volume between elbow and wrist, and the smallest
        of the cross-sections in between.
    """
    upper, *moved = (
        surface.limbs.index(f"{side}_{name}")
        for name in ("upper_arm", "forearm", "hand")
        if f"{side}_{name}" in surface.limbs
    )
    elbow = surface.joint_centres[moved[0]]
    along = surface.ends[moved[0]] - elbow
    turn = rotation_about(along / np.linalg.norm(along), np.array(np.radians(degrees)))
    rotations = np.tile(np.eye(3), (1, len(surface.limbs), 1, 1))
    shifts = np.zeros((1, len(surface.limbs), 3))
    rotations[0, moved], shifts[0, moved] = turn, elbow - turn @ elbow
    if blend == TWIST_JOINTS:
        joints = TwistJoints(surface)
        twisted = linear_blend(surface.vertices, *joints.weights, *joints.maps(rotations, shifts))
    else:
        shares = surface.weight_limbs, surface.weight_shares
        twisted = BLENDS[blend](surface.vertices, *shares, rotations, shifts)
    twisted = twisted[0]
    arm = surface.weights[:, [upper, *moved]].sum(axis=1) > 0.5
    faces = surface.faces[arm[surface.faces].all(axis=1)]
    levels = np.linspace(elbow[1], surface.ends[moved[0], 1], SECTIONS)
    before, after = (
        np.array([cross_section(v, faces, y) for y in levels]) for v in (surface.vertices, twisted)
    )
    return float(after.sum() / before.sum()), float((after / before).min())


def cross_section(vertices: Array, faces: NDArray[np.intp], level: float) -> float:
    """Return the area that a closed tube has at a height, m², by Green's theorem."""
    corners = vertices[faces]
    above = corners[..., 1] > level
    area = 0.0
    for k in range(3):  # the corner that is alone on its side
        a, b, c = (np.roll(np.arange(3), -k)[i] for i in range(3))
        alone = (above[:, a] != above[:, b]) & (above[:, b] == above[:, c])
        p, q, r = (corners[alone, i] for i in (a, b, c))
        one = p + ((level - p[:, 1]) / (q[:, 1] - p[:, 1]))[:, None] * (q - p)
        two = p + ((level - p[:, 1]) / (r[:, 1] - p[:, 1]))[:, None] * (r - p)
        sense = np.where(above[alone, a], 1.0, -1.0)
        area += float((sense * (one[:, 2] * two[:, 0] - one[:, 0] * two[:, 2])).sum()) / 2
    return abs(area)


def distances(points: Array, vertices: Array, faces: NDArray[np.intp]) -> Array:
    """Return how far points are from a surface, (n,) m; negative inside (by the nearest face).

    Ericson (2005), Real-Time Collision Detection, section 5.1.5: the nearest point of a triangle
    lies within it, or on one of its three sides.
    """
    a, b, c = vertices[faces.T]
    normal = np.cross(b - a, c - a)
    normal /= np.maximum(np.linalg.norm(normal, axis=1), 1e-15)[:, None]
    found = np.empty(len(points))
    for i, p in enumerate(points):
        height = np.einsum("fi,fi->f", p - a, normal)
        inside = np.ones(len(faces), dtype=bool)
        square = np.full(len(faces), np.inf)
        for u, v in ((a, b), (b, c), (c, a)):
            side, way = v - u, p - u
            inside &= np.einsum("fi,fi->f", np.cross(side, way), normal) >= 0
            along = np.einsum("fi,fi->f", side, way) / np.einsum("fi,fi->f", side, side)
            off = way - np.clip(along, 0, 1)[:, None] * side
            square = np.minimum(square, np.einsum("fi,fi->f", off, off))
        square = np.where(inside, height**2, square)
        nearest = int(square.argmin())
        found[i] = np.sqrt(square[nearest]) * (1.0 if height[nearest] >= 0 else -1.0)
    return found


def naive_blend(
    vertices: Array, limbs: NDArray[np.intp], shares: Array, rotations: Array, shifts: Array
) -> Array:
    """Return what `linear_blend` returns, in NumPy as one would write it down."""
    moved = np.einsum("fvkij,vj->fvki", rotations[:, limbs], vertices) + shifts[:, limbs]
    return np.asarray(np.einsum("vk,fvki->fvi", shares, moved))
