"""A body with joints of its own, turned as ours are: front along x, up along y."""

from dataclasses import replace

import numpy as np

from kinesphere.data import Array, Step, Surface
from kinesphere.editing.mesh.rigging.starts import pose_of
from kinesphere.editing.mesh.rigging.units import unit_of
from kinesphere.editing.mesh.rigging.upright import body_axes, name_of_axis, snapped, ways_as_said
from kinesphere.editing.mesh.settings import SurfaceSettings
from kinesphere.errors import BadSurface


def righted(body: Surface, settings: SurfaceSettings | None = None) -> Surface:
    """Return a rigged body in m, y up, looking along x, its lowest vertex at y = 0.

    From the hips to the shoulders is up, from left to right joints is right.

    Raises
    ------
    BadSurface
        If it has no two thighs and upper arms, or they lie on one point.
    """
    settings = settings or SurfaceSettings()
    way = ways_as_said(settings.up, settings.facing)
    way = _way_of_joints(body) if way is None else way
    tall = float(np.ptp(body.vertices @ way[1]))
    unit, metres = unit_of(tall)
    turn = metres * way
    low = np.array([0.0, (body.vertices @ turn[1]).min(), 0.0])
    read = body.history[-1].findings if body.history else {}
    found = {
        "up": name_of_axis(way[1]),
        "facing": name_of_axis(way[0]),
        "unit": unit,
        "pose": pose_of(body.limbs, body.ends - body.joint_centres, way[1]),
        "weights": f"its own, joints told by {read.get('limbs_from', 'their names')}",
    }
    return replace(
        body,
        vertices=body.vertices @ turn.T - low,
        joint_centres=body.joint_centres @ turn.T - low,
        ends=body.ends @ turn.T - low,
        history=(*body.history, Step("rigging", {}, found)),
    )


def _way_of_joints(body: Surface) -> Array:
    def pair(limb: str) -> Array:
        names = [f"{side}_{limb}" for side in ("left", "right")]
        if missing := [name for name in names if name not in body.limbs]:
            raise BadSurface(f"the mesh has no {missing[0]}; thighs and upper arms are needed")
        return body.joint_centres[[body.limbs.index(name) for name in names]]

    hips, shoulders = pair("thigh"), pair("upper_arm")
    up = shoulders.mean(axis=0) - hips.mean(axis=0)
    across = hips[1] - hips[0] + shoulders[1] - shoulders[0]
    across = across - (across @ up) * up / max(float(up @ up), 1e-15)
    sizes = np.linalg.norm([up, across], axis=1)
    if not (sizes > 1e-6 * np.ptp(body.vertices, axis=0).max()).all():
        raise BadSurface("hips and shoulders of the mesh lie on one point")
    right, tall = snapped(across / sizes[1], up / sizes[0])
    return body_axes(np.cross(tall, right), tall)
